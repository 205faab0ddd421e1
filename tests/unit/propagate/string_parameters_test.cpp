// SPDX-License-Identifier: MIT
#include <rosin/propagate/string_parameters.hpp>

#include <doctest/doctest.h>

#include <complex>
#include <numbers>

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
  const rosin::loss_law loss{.quality = 800, .internal_s = 2e-7, .air_sqrt_Hz = 0.01, .drag_Hz = 0.3};
  CHECK(loss.inverse_q(4900) == test::approx(1 / 800.0 + 2e-7 * 4900 + 0.01 / 70 + 0.3 / 4900));
  CHECK(loss.inverse_q(0) == 1 / 800.0);
  CHECK(loss.inverse_q(-4900) == loss.inverse_q(4900));
  CHECK(rosin::loss_law{}.inverse_q(1000) == 0);
}

TEST_CASE("causal loss disperses: against moduli that are analytic in the lower half plane of w") {
  constexpr double quality = 300, reference = 200, pi = std::numbers::pi, g = 1 / (pi * quality);
  using complex = std::complex<double>;
  const auto agrees = [&](const rosin::loss_law& loss, auto&& slowness, double second_order) {
    const complex at_reference = slowness(complex(0, 1));
    for (const double f : {20.0, 200.0, 900.0, 15e3}) {
      const complex n = slowness(complex(0, f / reference));
      CHECK(std::abs(n.real() / at_reference.real() - 1 - loss.lead(f)) < second_order);
      CHECK(std::abs(-2 * n.imag() / n.real() / loss.inverse_q(f) - 1) < 1e3 * second_order);
    }
  };
  agrees(
      {.quality = quality, .causality = 1, .reference_Hz = reference}, [&](complex s) { return std::pow(s, -g); }, 1e-5);
  // relaxations without end, equal and equally dense: a modulus that grows as the logarithm
  agrees(
      {.quality = quality, .causality = 1, .reference_Hz = reference},
      [&](complex s) { return 1.0 / std::sqrt(1.0 + 2 * g * std::log(s)); }, 3e-5);
  // a boundary layer drags as the square root, and weighs as much
  const double air = 1e-3;
  agrees(
      {.air_sqrt_Hz = air * std::sqrt(2 * reference), .causality = 1, .reference_Hz = reference},
      [&](complex s) { return 1.0 + air / std::sqrt(s); }, 5e-6);
}

TEST_CASE("without causality no loss disperses") {
  const rosin::loss_law loss{.quality = 300, .air_sqrt_Hz = 0.01, .reference_Hz = 200};
  CHECK(loss.quickening(5000) == 0);
  CHECK(loss.lead(5000) == 0);
  CHECK(rosin::loss_law{.quality = 300, .causality = 1, .reference_Hz = 200}.quickening(0) == 0);
}
