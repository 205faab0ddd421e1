// SPDX-License-Identifier: MIT
// On a modal string, which shares nothing with the model that is fitted; noise by a first-order recursion, far beyond the white
// noise below 150 Hz.
#include <rosin/diagnose/slow_noise.hpp>

#include <rosin/diagnose/pluck_diagnosis.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

#include <random>

namespace {

/// In both channels of a take; returns what was added to the near one.
std::vector<double> add_slow_noise(rosin::pluck_take& take, double rms_N, unsigned seed) {
  constexpr double corner_Hz = 150;
  std::mt19937 source(seed);
  std::normal_distribution<double> normal;
  const double keep = std::exp(-2 * std::numbers::pi * corner_Hz / take.rate_Hz);
  std::vector<double> added;
  for (auto& channel : take.force_N) {
    double now = rms_N * normal(source);
    for (double& x : channel) {
      now = keep * now + rms_N * std::sqrt(1 - keep * keep) * normal(source);
      x += now;
      if (&channel == &take.force_N[0]) added.push_back(now);
    }
  }
  return added;
}

rosin::outcome<rosin::pluck_diagnosis> look(const std::vector<rosin::pluck_take>& takes,
                                            const std::vector<rosin::pluck_take>& held) {
  return rosin::diagnose_plucks(
      takes, held, {.fundamental_Hz = 660}, {.internal_loss = false}, [&](const rosin::pluck_fit_result& fit) {
        const rosin::string_facts facts{fit.value[0], takes[0].rate_Hz, fit.limits.stop_Hz, 0.175, 0.314, takes.size()};
        return std::vector<rosin::pluck_effect>{rosin::slow_release_effect(facts), rosin::ac_coupling_effect(facts)};
      });
}

double rms(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v * v;
  return std::sqrt(sum / static_cast<double>(x.size()));
}

}  // namespace

TEST_CASE("slow noise: below the pitch it goes, white noise stays as it is" * doctest::test_suite("long")) {
  const rosin::pluck_take quiet = test::modal_pluck(0.75, 3);
  std::vector<rosin::pluck_take> white{test::modal_pluck(1, 1), test::modal_pluck(0.5, 2)}, takes = white;
  std::vector<rosin::pluck_take> held{quiet};
  const auto plain = look(white, {quiet});
  REQUIRE_MESSAGE(plain, plain.error());
  CHECK_FALSE(rosin::without_slow_noise(*plain, {quiet}));
  const std::vector<double> added = add_slow_noise(takes[0], 3e-4, 7);
  add_slow_noise(takes[1], 3e-4, 8), add_slow_noise(held[0], 3e-4, 9);
  auto noisy = *plain;
  noisy.data.takes = takes;
  const auto cleaned = rosin::without_slow_noise(noisy, held);
  REQUIRE(cleaned);
  CHECK(cleaned->over > 5);
  std::vector<double> left, taken;
  for (std::size_t i = 0; i < added.size(); ++i) {
    taken.push_back(takes[0].force_N[0][i] - cleaned->takes[0].force_N[0][i]);
    left.push_back(added[i] - taken.back());
  }
  CHECK(rms(left) < 0.6 * rms(added));
  CHECK(rms(taken) > 0.6 * rms(added));
  // What a fit leaves of one take alone is not the sensors'.
  noisy.data.takes[0] = white[0];
  CHECK_FALSE(rosin::without_slow_noise(noisy, held));
  // Nor is what a wrong pitch leaves at the partials and at their feet.
  auto sharp = *plain;
  sharp.best.value[0] *= 1.0005;
  CHECK_FALSE(rosin::without_slow_noise(sharp, {}));
}

TEST_CASE("slow noise: a string as declared is left alone in it, and a wire that lets go slowly named all the same" *
          doctest::test_suite("long")) {
  for (const double slow_s : {0.0, 40e-6}) {
    CAPTURE(slow_s);
    std::vector<rosin::pluck_take> takes{test::modal_pluck(1, 1, slow_s), test::modal_pluck(0.5, 2, slow_s)},
        held{test::modal_pluck(0.75, 3, slow_s)};
    add_slow_noise(takes[0], 3e-4, 11), add_slow_noise(takes[1], 3e-4, 12), add_slow_noise(held[0], 3e-4, 13);
    const auto d = look(takes, held);
    REQUIRE_MESSAGE(d, d.error());
    CHECK(d->explained);
    CHECK(d->mismatched == (slow_s > 0));
    REQUIRE(d->best.effects.size() == (slow_s > 0 ? 1 : 0));
    if (slow_s > 0) CHECK(d->best.values_of(0)[0] == test::approx(slow_s).epsilon(0.02));
  }
}

TEST_CASE("slow noise: what dies away after each release is none, nor what grows with the pluck") {
  const auto plain = look({test::modal_pluck(1, 1), test::modal_pluck(0.5, 2)}, {test::modal_pluck(0.75, 3)});
  REQUIRE_MESSAGE(plain, plain.error());
  for (const bool dies : {true, false}) {
    CAPTURE(dies);
    auto d = *plain;
    unsigned seed = 20;
    for (rosin::pluck_take& take : d.data.takes) {
      auto other = take;
      for (auto& c : other.force_N) std::fill(c.begin(), c.end(), 0.0);
      add_slow_noise(other, dies ? 1e-3 : 1e-3 * take.strength_N * take.strength_N, ++seed);
      for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t i = 0; i < take.force_N[c].size(); ++i)
          take.force_N[c][i] +=
              other.force_N[c][i] *
              (dies ? std::exp(-static_cast<double>(i) / (0.1 * static_cast<double>(take.force_N[c].size()))) : 1);
    }
    CHECK_FALSE(rosin::without_slow_noise(d, {}));
  }
}
