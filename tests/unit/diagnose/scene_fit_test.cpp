// SPDX-License-Identifier: MIT
#include <rosin/diagnose/scene_fit.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <rosin/diagnose/pluck_effects.hpp>

#include <doctest/doctest.h>

TEST_CASE("place and weight of a bead come back within their errors") {
  const rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const rosin::pluck_options options{.internal_loss = false};
  const auto layout = test::two_plucks(options);
  const std::vector<rosin::pluck_effect> bead{rosin::point_mass_effect(facts)};
  const Eigen::VectorXd truth = test::values_of(layout, {0.42, 1e-7, 0, 0});
  rosin::scene_data data{{}, {.fundamental_Hz = 659.69}, options, layout};
  for (std::size_t t = 0; t < 2; ++t) data.takes.push_back(test::scene_pluck(layout, bead, truth, t, 3e-4, 11 + t));
  constexpr auto free = rosin::freedom::no_corrections;
  const std::vector<rosin::fit_stage> stages{{6, 5, false, free},    {12, 8, false, free},   {24, 12, false, free},
                                             {1000, 12, true, free}, {1000, 40, true, free}, {1000, 1e9, true, free}};
  const auto fit = rosin::fit_scene(data, bead, test::values_of(layout, {0.424, 8e-8, 0, 0}), stages, {3e-4, 3e-4});
  CHECK(fit.converged);
  CHECK(std::abs(fit.value[layout.size()] - 0.42) < 4 * fit.sd[layout.size()]);
  CHECK(std::abs(fit.value[layout.size() + 1] - 1e-7) < 4 * fit.sd[layout.size() + 1]);
  CHECK(fit.sd[layout.size()] < 1e-3);
  CHECK(fit.sd[layout.size() + 1] < 2e-9);
  CHECK(fit.quality.noise[0] == test::approx(3e-4).epsilon(0.05));
  CHECK(fit.quality.misfit < 1.4);
}
