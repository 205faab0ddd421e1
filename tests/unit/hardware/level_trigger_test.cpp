// SPDX-License-Identifier: MIT
#include <rosin/hardware/level_trigger.hpp>

#include "support/approx.hpp"

#include <doctest/doctest.h>

#include <random>

TEST_CASE("a wire that breaks under a slowly growing force: the take begins so long before, whatever the blocks") {
  for (const std::size_t block : {1U, 7U, 64U, 480U, 5000U}) {
    CAPTURE(block);
    rosin::level_trigger trigger{{48000, 2, 16}, {.threshold = 0.1, .before_s = 0.02}};
    std::vector<double> all, taken;
    for (int i = 0; i < 96000; ++i) {
      const bool held = i < 60000;
      all.push_back(held ? 0.6 * i / 60000 : 0.0);  // grows to well above the threshold, then lets go
      all.push_back(0.2);
    }
    for (std::size_t at = 0; at < all.size(); at += 2 * block) {
      const auto part = trigger.push(std::span{all}.subspan(at, std::min(2 * block, all.size() - at)));
      taken.insert(taken.end(), part.begin(), part.end());
    }
    REQUIRE(trigger.fired());
    CHECK(trigger.lead() == 960);
    REQUIRE(taken.size() == 2 * (96000 - 60000 + 960));
    CHECK(taken[0] == all[2 * (60000 - 960)]);
    CHECK(taken[2 * 960] == 0);
    CHECK(taken[2 * 960 - 2] == all[2 * 59999]);
  }
}

TEST_CASE("an offset and noise below the threshold do not set it off; with no threshold all is taken") {
  rosin::level_trigger trigger{{48000, 1, 16}, {.threshold = 0.05}};
  std::mt19937 random{1};
  std::uniform_real_distribution<double> noise{-0.04, 0.04};
  std::vector<double> frames(48000);
  for (auto& x : frames) x = 0.7 + noise(random) / 2;
  CHECK(trigger.push(frames).empty());
  CHECK_FALSE(trigger.fired());
  rosin::level_trigger open{{48000, 1, 16}, {}};
  CHECK(open.push(frames).size() == frames.size());
}

TEST_CASE("it is armed at rest only: neither the ringing of the take before nor its beats set it off, the next release does") {
  rosin::level_trigger trigger{{48000, 1, 16}, {.threshold = 0.05, .before_s = 0.01}};
  std::vector<double> frames(5 * 48000);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double t = static_cast<double>(i) / 48000, since = t - 4;
    const double beats = 0.6 + 0.4 * std::cos(2 * 3.14159265 * 3 * t);
    frames[i] = 0.4 * beats * std::exp(-t / 0.5) * std::sin(2 * 3.14159265 * 110 * t);
    frames[i] += since < 0 ? 0.3 : 0.3 * std::cos(2 * 3.14159265 * 110 * since);
  }
  const std::size_t before = 48000;
  CHECK(trigger.push(std::span{frames}.first(before)).empty());
  CHECK_FALSE(trigger.armed());
  CHECK(trigger.unrest() > 0.025);
  const auto taken = trigger.push(std::span{frames}.subspan(before));
  REQUIRE(trigger.fired());
  CHECK(trigger.lead() == 480);
  CHECK(static_cast<double>(taken.size()) == test::approx(48000 + 480).epsilon(0.002));
}
