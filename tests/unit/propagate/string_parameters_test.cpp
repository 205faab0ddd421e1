// SPDX-License-Identifier: MIT
#include <rosin/propagate/string_parameters.hpp>

#include <doctest/doctest.h>

#include <complex>
#include <numbers>

#include "support/approx.hpp"

namespace propagate_string_parameters {

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

TEST_CASE("a loss that is uneven: relaxations whose times lie apart are one, and disperse as it says") {
  // ladders without ends, ratio exp(2 pi / m): of the orders m and 2 m; 3 m is below 4e-4 of 1/Q
  constexpr double quality = 500, reference = 200, pi = std::numbers::pi;
  for (const int m : {2, 3, 4}) {
    CAPTURE(m);
    const double spacing = 2 * pi / m;
    const auto ladder = [&](double u) {
      std::complex<double> sum = 0;
      for (int k = -60; k <= 60; ++k) {
        const double x = std::exp(u - 0.3 - k * spacing);
        sum += std::complex<double>(k > 0 ? x * x / (1 + x * x) : -1 / (1 + x * x), x / (1 + x * x));  // converges
      }
      return sum * (2 * spacing / (pi * quality));
    };
    rosin::loss_law loss{.quality = quality, .causality = 1, .reference_Hz = reference};
    for (const int order : {m, 2 * m})
      if (order <= rosin::loss_unevenness::orders) {
        const double much = 2 / std::cosh(pi * order / 2);
        const auto i = static_cast<std::size_t>(order - 1);
        loss.uneven.cosine[i] = much * std::cos(0.3 * order), loss.uneven.sine[i] = much * std::sin(0.3 * order);
      }
    for (const double u : {-1.2, 0.0, 0.4, 1.5, 3.7, 5.0}) {
      const double f = reference * std::exp(u);
      CHECK(std::abs(quality * (loss.inverse_q(f) - ladder(u).imag())) < 4e-4);
      CHECK(std::abs(quality * (loss.quickening(f) - (ladder(u) - ladder(0)).real() / 2)) < 4e-4);
      const double step = 1e-4;
      CHECK(
          loss.dispersion(f) ==
          test::approx((loss.quickening(f * std::exp(step)) - loss.quickening(f * std::exp(-step))) / (2 * step)).epsilon(1e-6));
    }
  }
}

TEST_CASE("a string half of whose loss relaxes disperses by half as much, evenly and unevenly") {
  rosin::loss_law all{.quality = 300, .causality = 1, .reference_Hz = 200}, half = all;
  all.uneven.cosine = {0.02, -0.01, 0.03, 0.01}, all.uneven.sine = {0.01, 0.02, -0.02, 0.005};
  half.causality = 0.5;
  for (std::size_t i = 0; i < rosin::loss_unevenness::orders; ++i)  // half of the loss is even
    half.uneven.cosine[i] = all.uneven.cosine[i] / 2, half.uneven.sine[i] = all.uneven.sine[i] / 2;
  for (const double f : {150.0, 230.0, 900.0, 7000.0}) {
    CHECK(half.inverse_q(f) == test::approx((all.inverse_q(f) + 1.0 / 300) / 2));
    CHECK(half.quickening(f) == test::approx(all.quickening(f) / 2));
    CHECK(half.dispersion(f) == test::approx(all.dispersion(f) / 2));
  }
}

TEST_CASE("without causality no loss disperses") {
  const rosin::loss_law loss{.quality = 300, .air_sqrt_Hz = 0.01, .reference_Hz = 200};
  CHECK(loss.quickening(5000) == 0);
  CHECK(loss.lead(5000) == 0);
  rosin::loss_law uneven{.quality = 300, .reference_Hz = 200};
  uneven.uneven.sine[1] = 0.1;
  CHECK(uneven.quickening(5000) == 0);
  CHECK(uneven.dispersion(5000) == 0);
  CHECK(uneven.inverse_q(200 * std::exp(std::numbers::pi / 4)) == test::approx(1.1 / 300));
  CHECK(rosin::loss_law{.quality = 300, .causality = 1, .reference_Hz = 200}.quickening(0) == 0);
}

}  // namespace propagate_string_parameters
