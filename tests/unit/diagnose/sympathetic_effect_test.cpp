// SPDX-License-Identifier: MIT
// On a stepped modal string with a second, stiff string under one of its ends.
#include <rosin/diagnose/sympathetic_effect.hpp>

#include <rosin/diagnose/pluck_candidates.hpp>
#include <rosin/simulate/burdened_signals.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

namespace {

constexpr double pitch_Hz = 246.94, q = 900, per_mass_per_s = 0.03, inharmonicity = 3e-5;
constexpr int modes = 40;  // up to 10.1 kHz

rosin::pluck_take pluck(double force_N, std::uint64_t seed, std::size_t end) {
  rosin::rig_burden burden;
  for (int n = 1; n <= modes; ++n)
    burden.string.ends[end].modes.push_back({n * pitch_Hz * std::sqrt(1 + inharmonicity * n * n), q, per_mass_per_s * n * n});
  const auto made = rosin::simulate_pluck(test::plucked_rig, burden,
                                          {.position = 0.3, .force_N = force_N, .release_s = 0.004, .duration_s = 0.25});
  rosin::pluck_take take;
  take.name = "pluck-" + std::to_string(seed);
  take.rate_Hz = made->sample_rate_Hz, take.strength_N = force_N, take.position = 0.302;
  const rosin::converter sensor{.gain = 1, .newtons_per_full_scale = 3, .noise_N = 0.3e-3, .bits = 16};
  take.force_N = {rosin::convert(made->force_near_N, take.rate_Hz, sensor, 2 * seed).newtons(),
                  rosin::convert(made->force_far_N, take.rate_Hz, sensor, 2 * seed + 1).newtons()};
  return take;
}

}  // namespace

TEST_CASE("sympathetic string: sought in what is left over, found under its end with its pitch, loss and stiffness" *
          doctest::test_suite("long")) {
  const std::vector<rosin::pluck_take> takes{pluck(1, 1, 1), pluck(0.6, 2, 1)};
  const rosin::pluck_guess guess{.fundamental_Hz = 660};
  const auto declared = rosin::fit_plucks(takes, guess, {}, 0.95);
  REQUIRE_MESSAGE(declared, declared.error());
  const rosin::scene_data data{takes, guess, {}, declared->layout};
  const rosin::scene_fit plain = rosin::fit_scene(data, {}, declared->value, {{}}, declared->noise_N);
  const rosin::string_facts facts{declared->value[0], takes[0].rate_Hz, 10.25e3, 0.175, 0.314, takes.size()};
  const std::vector<rosin::pluck_effect> catalogue{rosin::sympathetic_string_effect(facts, 0),
                                                   rosin::sympathetic_string_effect(facts, 1)};
  const auto begin = rosin::detail::find_beginnings(data, plain, catalogue, false, declared->noise_N);
  REQUIRE_FALSE(begin.starts[1].empty());
  const auto from = rosin::detail::extended(data.layout, plain.value, catalogue[1], begin.starts[1][0].values);
  const rosin::scene_fit fit =
      rosin::fit_scene(data, {catalogue[1]}, from, {{1000, 24, true}, {1000, 80, true}, {}}, declared->noise_N);
  const auto at = data.layout.size();
  CHECK(std::exp(fit.value[at]) == test::approx(pitch_Hz * std::sqrt(1 + inharmonicity)).epsilon(2e-4));
  CHECK(std::exp(fit.value[at + 1]) == test::approx(q).epsilon(0.03));
  CHECK(fit.value[at + 2] == test::approx(per_mass_per_s / 0.175).epsilon(0.03));
  CHECK(fit.value[at + 3] == test::approx(2).epsilon(0.01));
  CHECK(fit.value[at + 4] == test::approx(inharmonicity).epsilon(0.05));
  CHECK(fit.quality.residual_ratio[0] < 0.05 * plain.quality.residual_ratio[0]);
}

TEST_CASE("sympathetic string: a comb is read off its peaks, stiff strings' and every other line's as well") {
  const std::vector<double> own{660, 1320, 1980, 2640, 3300};
  rosin::detail::foreign_peaks found{{}, 25, 2};
  for (const int n : {1, 2, 3, 5, 6, 7, 9}) found.peaks.push_back({n * 196.1 * std::sqrt(1 + 8e-5 * n * n), 1});
  const auto combs = rosin::detail::foreign_combs(found, own);
  REQUIRE_FALSE(combs.empty());
  CHECK(combs[0].pitch_Hz == test::approx(196.1).epsilon(1e-4));
  CHECK(combs[0].inharmonicity == test::approx(8e-5).epsilon(0.01));
  CHECK_FALSE(rosin::detail::is_new(combs, 98.05));
}

TEST_CASE("sympathetic string: peaks of no common pitch, and too few, are no comb") {
  const std::vector<double> own{660, 1320, 1980, 2640};
  CHECK(rosin::detail::foreign_combs({{{210.3, 1}, {997.1, 1}, {1741.9, 1}}, 25, 2}, own).empty());
  CHECK(rosin::detail::foreign_combs({{{300, 1}, {600, 1}}, 25, 2}, own).empty());
  CHECK(rosin::detail::foreign_combs({{}, 25, 2}, own).empty());
}
