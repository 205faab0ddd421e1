// SPDX-License-Identifier: MIT
#include <rosin/calibrate/end_search.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"
#include "support/plucked_ends.hpp"

TEST_CASE("the first guess is the mode that is there, at its end and about as heavy") {
  const test::moving_end_rig rig{test::steel_e, {std::vector<test::end_mode>{}, std::vector<test::end_mode>{{3100, 18, 0.05}}}};
  const auto takes = test::pluck_at(rig, {0.3}, 0.1, 1e-5);
  const rosin::end_model m{rosin::pluck_layout(takes, {}), {}, {}, {}};
  const Eigen::VectorXd v = m.layout.initial(takes, {.inharmonicity = test::steel_e.inharmonicity()},
                                             test::steel_e.fundamental_Hz, {0.008 - 0.5 / 320e3}, {0.3});
  rosin::end_problem problem(takes, {0.006}, 440, 12e3);
  problem.set_noise({1e-5, 1e-5});
  const auto eq = problem.linearise(m, v);
  const Eigen::MatrixXd hessian = eq.hessian + 1e-3 * Eigen::MatrixXd::Identity(m.size(), m.size());
  const auto found = rosin::search_modes(problem, m, v, hessian, eq.gradient, {true, true}, 150, 11e3);
  const auto at = std::find_if(found.begin(), found.end(), [](const auto& c) { return c.end == 1; });
  CHECK(at->mode.frequency_Hz == test::approx(3100).epsilon(0.04));
  CHECK(at->mode.q > 5);
  CHECK(test::steel_e.impedance_Ns_m() / at->mode.per_mass_per_s == test::approx(0.05).epsilon(0.5));
  CHECK(at->gain > 1000);
  CHECK(std::is_sorted(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; }));
  const auto near_only = rosin::search_modes(problem, m, v, hessian, eq.gradient, {true, false}, 150, 11e3);
  CHECK(std::all_of(near_only.begin(), near_only.end(), [](const auto& c) { return c.end == 0; }));
  const auto elsewhere = rosin::search_modes(problem, m, v, hessian, eq.gradient, {false, true}, 5e3, 11e3);
  CHECK(elsewhere.front().gain < 0.5 * at->gain);
}
