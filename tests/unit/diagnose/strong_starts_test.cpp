// SPDX-License-Identifier: MIT
#include <rosin/diagnose/strong_starts.hpp>

#include "plucked.hpp"

#include <rosin/diagnose/pluck_effects.hpp>

#include <doctest/doctest.h>

TEST_CASE("a bead of a ninth of the string's mass is begun with where it is") {
  const rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const rosin::pluck_options options{.internal_loss = false};
  const auto layout = test::two_plucks(options);
  const std::vector<rosin::pluck_effect> catalogue{rosin::point_mass_effect(facts)};
  const double mass = 0.175 / (2 * 659.69) / 9, place = 0.61;
  const Eigen::VectorXd truth = test::values_of(layout, {place, mass, 0, 0});
  rosin::scene_data data{{}, {.fundamental_Hz = 663}, options, layout};
  for (std::size_t t = 0; t < 2; ++t) data.takes.push_back(test::scene_pluck(layout, catalogue, truth, t, 3e-4, 3 + t));
  rosin::scene_fit declared;
  rosin::detail::known_starts none;
  declared.quality.residual_ratio = {0.2, 0.2};
  CHECK(rosin::detail::strong_starts(data, declared, catalogue, {1e-3, 1e-3}, none).empty());  // the ordinary way will do
  declared.quality.residual_ratio = {0.6, 0.5};
  const auto starts = rosin::detail::strong_starts(data, declared, catalogue, {1e-3, 1e-3}, none);
  REQUIRE_FALSE(starts.empty());
  const auto near = [&](const auto& s) {
    return std::abs(s.value[layout.size()] - place) < 0.03 && std::abs(std::log(s.value[layout.size() + 1] / mass)) < 0.75;
  };
  CHECK(std::any_of(starts.begin(), starts.end(), near));
}
