// SPDX-License-Identifier: MIT
#include <rosin/diagnose/tension_drift.hpp>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("a tension that rose by one per cent between plucks and stroke is found in the stroke") {
  rosin::string_parameters string{
      .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 659.69, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 1000}};
  rosin::calibration plucked;
  plucked.at = rosin::contact_at(string, 0.3);
  plucked.position = 0.3;
  plucked.noise_N = {1e-4, 1e-4};
  rosin::waveform_vector sd;
  sd << 1e-9, 1e-9, 1e-17, 1e-7, 1e-11, 3e-5;
  plucked.covariance = sd.cwiseAbs2().asDiagonal();
  string.tension_N *= 1.01, string.fundamental_Hz *= std::sqrt(1.01);
  const auto bowed = rosin::simulate_stroke({.string = string}, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                                            rosin::steady_rod{.speed_m_s = 0.2, .normal_force_N = 0.3},
                                            {.position = 0.3, .duration_s = 0.06}, {.oversampling = 4});
  REQUIRE(bowed);
  const auto found =
      rosin::find_tension_drift({{bowed->force_near_N, bowed->force_far_N, plucked}}, {20e3, 40e3}, bowed->sample_rate_Hz);
  CHECK(found.relative == test::approx(0.01).epsilon(0.002));
  CHECK(found.delta_after < 0.2 * found.delta_before);
  CHECK(found.delta_after < 0.5 * found.delta_moved_contact);
  const auto moved = rosin::at_tension(plucked, 0.01);
  CHECK(moved.at.delay_s[0] / plucked.at.delay_s[0] == test::approx(1 / std::sqrt(1.01)));
  CHECK(moved.at.impedance_Ns_m / plucked.at.impedance_Ns_m == test::approx(std::sqrt(1.01)));
}
