// SPDX-License-Identifier: MIT
#include <rosin/diagnose/stroke_place.hpp>

#include "support/approx.hpp"

#include <rosin/diagnose/tension_drift.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <doctest/doctest.h>

namespace {

constexpr double wire_at = 0.3;
const rosin::band rod_band{20e3, 40e3};

rosin::string_parameters string_of_tension(double tension) {
  return {.length_m = 0.314,
          .tension_N = 72.5 * tension,
          .fundamental_Hz = 659.69 * std::sqrt(tension),
          .bending_stiffness_Nm2 = 4.7e-5,
          .loss = {.quality = 1000}};
}

/// Eq. (12) of a stroke, by the place at which it is reconstructed with the string of the plucks.
auto parting_of_stroke(double position, double tension) {
  const auto bowed =
      rosin::simulate_stroke({.string = string_of_tension(tension)}, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                             rosin::steady_rod{.speed_m_s = 0.2, .normal_force_N = 0.3},
                             {.position = position, .duration_s = 0.06}, {.oversampling = 4});
  REQUIRE(bowed);
  rosin::calibration plucked;
  plucked.at = rosin::contact_at(string_of_tension(1), wire_at), plucked.position = wire_at;
  return [=, stroke = *bowed](double place) {
    const auto m = rosin::reconstructor<double>(rosin::at_place(plucked, place).at, rod_band, stroke.sample_rate_Hz)(
        stroke.force_near_N, stroke.force_far_N);
    return rosin::consistency_delta(m.force_near_N, m.force_far_N);
  };
}

}  // namespace

TEST_CASE("stroke place: a rod beside the wire is found where it was, as far as was searched") {
  const auto delta = parting_of_stroke(0.304, 1);
  const auto found = rosin::search_stroke_place(delta, wire_at, 0.01);
  CHECK(found.position == test::approx(0.304).epsilon(1e-4));
  CHECK(found.delta < 0.05 * delta(wire_at));
  CHECK(rosin::search_stroke_place(delta, wire_at, 0.003).delta == 1);
}

TEST_CASE("stroke place: where the plucks were, it stays there; another tension is no other place") {
  CHECK(rosin::search_stroke_place(parting_of_stroke(wire_at, 1), wire_at, 0.01).position == test::approx(wire_at).epsilon(1e-4));
  const auto tighter = parting_of_stroke(wire_at, 1.01);
  CHECK(rosin::search_stroke_place(tighter, wire_at, 0.01).delta > 0.5 * tighter(wire_at));
}

TEST_CASE("stroke place: a calibration that is moved keeps its string") {
  rosin::calibration c;
  c.at = rosin::contact_at(string_of_tension(1), wire_at);
  const auto moved = rosin::at_place(c, 0.25);
  CHECK(moved.at.delay_s[0] + moved.at.delay_s[1] == test::approx(c.at.delay_s[0] + c.at.delay_s[1]));
  CHECK(moved.at.delay_s[0] / moved.at.delay_s[1] == test::approx(1.0 / 3));
  CHECK(moved.position == 0.25);
}
