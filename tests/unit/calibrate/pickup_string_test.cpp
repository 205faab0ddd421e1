// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pickup_string.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/approx.hpp"

TEST_CASE("a plain wire's diameter and bending stiffness from what is heard") {
  const double E = 205e9, rho = 7850, d = 0.254e-3, L = 0.6477, f0 = 329.6, pi = std::numbers::pi;
  const double m = rho * pi * d * d / 4, T = m * std::pow(2 * L * f0, 2), B = pi * E * std::pow(d, 4) / 64;
  const double b = pi * pi * B / (T * L * L);
  const rosin::string_in_SI s = rosin::string_from({.length_m = {{L, 0}},
                                                    .tension_N = {},
                                                    .linear_density_kg_m = {},
                                                    .diameter_m = {{d, 1e-6}},
                                                    .density_kg_m3 = {{rho, 0}},
                                                    .youngs_modulus_Pa = {{E, 0}}},
                                                   {f0, 0.01}, {b, 0.01 * b});
  REQUIRE(s.tension_N);
  CHECK(s.tension_N->value == test::approx(T));
  REQUIRE(s.bending_stiffness_Nm2);
  CHECK(s.bending_stiffness_Nm2->value == test::approx(B));
  REQUIRE(s.diameter_from_sound_m);
  CHECK(s.diameter_from_sound_m->value == test::approx(d));
  CHECK(s.diameter_from_sound_m->sd == test::approx(0.005 * d).epsilon(0.05));  // b goes with d^2
  CHECK_FALSE(rosin::string_from({}, {f0, 0}, {b, 0}).bending_stiffness_Nm2);
}
