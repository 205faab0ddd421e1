// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pluck_score.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <rosin/diagnose/pluck_effects.hpp>

#include <doctest/doctest.h>

TEST_CASE("the score foretells strength and gain of a weak effect, and nothing of one that is not there") {
  const rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const auto layout = test::two_plucks({.internal_loss = false});
  const std::vector<rosin::pluck_effect> skewed{rosin::skew_effect(facts)};
  const Eigen::VectorXd truth = test::values_of(layout, {40e-9});
  std::vector<rosin::pluck_take> takes;
  for (std::size_t t = 0; t < 2; ++t) takes.push_back(test::scene_pluck(layout, skewed, truth, t, 3e-4, 7 + t));
  const rosin::pluck_guess guess{.fundamental_Hz = 659.69};
  const rosin::pluck_options options{.internal_loss = false};
  const rosin::line_problem<rosin::scene_plucks> problem(takes, {layout, {0, 0}, {}}, options, guess, test::values_of(layout),
                                                         160, 1e9, true, {3e-4, 3e-4});
  const rosin::pluck_score score(problem, test::values_of(layout));
  const auto skew = score({layout, {0, 0}, skewed}, {1e-9});
  CHECK(skew.mix == test::approx(40).epsilon(0.15));  // times the starting strength of 1 ns
  CHECK(skew.gain > 50);
  const auto crosstalk = score({layout, {0, 0}, {rosin::crosstalk_effect(facts)}}, {1e-5});
  CHECK(crosstalk.gain < 0.2 * skew.gain);
}
