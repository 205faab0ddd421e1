// SPDX-License-Identifier: MIT
// On a modal string, which shares nothing with the model that is fitted.
#include <rosin/diagnose/odd_pluck.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

namespace {

std::optional<rosin::odd_pluck> odd_of(const std::vector<rosin::pluck_take>& takes, const std::vector<rosin::pluck_take>& held) {
  return rosin::find_odd_pluck(takes, held, {.fundamental_Hz = 660}, {.internal_loss = false},
                               [](const rosin::pluck_fit_result&) { return std::vector<rosin::pluck_effect>{}; });
}

/// Three short plucks, two to fit and one held out.
struct three {
  std::vector<rosin::pluck_take> takes, held;
};
three sound_plucks() {
  three out{{test::modal_pluck(1, 1), test::modal_pluck(0.5, 2)}, {test::modal_pluck(0.75, 3)}};
  out.takes[0].name = "hard", out.takes[1].name = "soft", out.held[0].name = "kept";
  for (auto* take : {&out.takes[0], &out.takes[1], &out.held[0]})
    for (auto& channel : take->force_N) channel.resize(5000);
  return out;
}

}  // namespace

TEST_CASE("odd pluck: three plucks of one string contradict nothing, and of two none can be told to be it") {
  const three sound = sound_plucks();
  CHECK_FALSE(odd_of(sound.takes, sound.held));
  CHECK_FALSE(odd_of(sound.takes, {}));
}

TEST_CASE("odd pluck: samples that a recorder lost are found, with their number and where, in a take that was held out as well" *
          doctest::test_suite("long")) {
  three p = sound_plucks();
  constexpr std::size_t at = 3600, count = 7;
  for (auto& channel : p.held[0].force_N) channel.erase(channel.begin() + at, channel.begin() + at + count);
  const auto odd = odd_of(p.takes, p.held);
  REQUIRE(odd);
  CHECK(odd->take.name == "kept");
  CHECK_FALSE(odd->strongest);
  CHECK(odd->before > 20 * odd->floor);
  CHECK(odd->time_s[0] * odd->take.rate_Hz == test::approx(at).epsilon(0.05));
  REQUIRE(odd->lost);
  CHECK(odd->lost->count == count);
  CHECK(std::abs(odd->lost->time_s * odd->take.rate_Hz - at) < 2.5 * odd->lost->sd_s * odd->take.rate_Hz);
  CHECK(odd->after < 1.1 * odd->floor);
  CHECK(odd->others.best.effects.empty());
}

TEST_CASE("odd pluck: made elsewhere than declared" * doctest::test_suite("long")) {
  three p = sound_plucks();
  p.takes[1] = test::modal_pluck(0.5, 7, 0, 0.343);
  p.takes[1].name = "moved";
  for (auto& channel : p.takes[1].force_N) channel.resize(5000);
  const auto odd = odd_of(p.takes, p.held);
  REQUIRE(odd);
  CHECK(odd->take.name == "moved");
  CHECK_FALSE(odd->lost);
  REQUIRE(odd->moved);
  CHECK(std::abs(odd->moved->position - 0.343) < 4 * odd->moved->sd);
  CHECK(odd->moved->sd < 1e-3);
  CHECK(odd->after < 1.1 * odd->floor);
  CHECK(odd->elsewhere.model[0].size() == odd->ringing.model[0].size());
}

TEST_CASE("odd pluck: samples lost so early that they would bend the release" * doctest::test_suite("long")) {
  three p = sound_plucks();
  constexpr std::size_t at = 780, count = 7;  // 1.4 periods after the release
  for (auto& channel : p.takes[0].force_N) channel.erase(channel.begin() + at, channel.begin() + at + count);
  const auto odd = odd_of(p.takes, p.held);
  REQUIRE(odd);
  CHECK(odd->take.name == "hard");
  REQUIRE(odd->lost);
  CHECK(odd->lost->count == count);
  CHECK(std::abs(odd->lost->time_s * odd->take.rate_Hz - at) < 2.5 * odd->lost->sd_s * odd->take.rate_Hz);
}

TEST_CASE("odd pluck: of three at places of their own the one that was made elsewhere" * doctest::test_suite("long")) {
  three p = sound_plucks();
  p.takes[0].position = 0.303;  // of 0.3: as notebooks are
  p.takes[1] = test::modal_pluck(0.5, 8, 0, 0.2), p.takes[1].position = 0.2022, p.takes[1].name = "soft";
  p.held[0] = test::modal_pluck(0.75, 9, 0, 0.4), p.held[0].position = 0.452, p.held[0].name = "kept";
  for (auto* take : {&p.takes[1], &p.held[0]})
    for (auto& channel : take->force_N) channel.resize(5000);
  const auto odd = odd_of(p.takes, p.held);
  REQUIRE(odd);
  CHECK(odd->take.name == "kept");
  REQUIRE(odd->moved);
  CHECK(odd->moved->position == test::approx(0.4).epsilon(1e-3));
  p.held[0].position = 0.4025;
  CHECK_FALSE(odd_of(p.takes, p.held));
}

TEST_CASE("odd pluck: the strongest rings a thousandth higher" * doctest::test_suite("long")) {
  three p = sound_plucks();
  for (auto& channel : p.takes[0].force_N) channel = rosin::resampled(channel, 1e-3);
  const auto odd = odd_of(p.takes, p.held);
  REQUIRE(odd);
  CHECK(odd->take.name == "hard");
  CHECK(odd->strongest);
  CHECK_FALSE(odd->lost);
  CHECK_FALSE(odd->moved);
  CHECK(odd->own_fundamental_Hz / odd->others.best.value[0] - 1 == test::approx(1e-3).epsilon(0.01));
}
