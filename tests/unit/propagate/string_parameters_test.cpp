// SPDX-License-Identifier: MIT
#include <rosin/propagate/string_parameters.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("what follows from a string's length, tension and pitch") {
  const rosin::string_parameters s{0.314, 72.5, 659.69, 4.7e-5, {}};
  CHECK(s.wave_speed_m_s() == test::approx(414.286).epsilon(1e-5));
  CHECK(s.impedance_Ns_m() == test::approx(0.175).epsilon(1e-4));
  CHECK(s.linear_density_kg_m() == test::approx(4.2241e-4).epsilon(1e-4));
  CHECK(s.tension_N * s.linear_density_kg_m() == test::approx(s.impedance_Ns_m() * s.impedance_Ns_m()));
  CHECK(s.inharmonicity() == test::approx(6.49e-5).epsilon(1e-3));
  // epsilon = B m / T^2, from the other two numbers
  CHECK(s.stiffness_s2() == test::approx(4.7e-5 * s.linear_density_kg_m() / (72.5 * 72.5)));
}

TEST_CASE("loss adds up over its causes") {
  const rosin::loss_law loss{800, 2e-7, 0.01};
  CHECK(loss.inverse_q(4900) == test::approx(1 / 800.0 + 2e-7 * 4900 + 0.01 / 70));
  CHECK(loss.inverse_q(-4900) == loss.inverse_q(4900));
  CHECK(rosin::loss_law{}.inverse_q(1000) == 0);
}
