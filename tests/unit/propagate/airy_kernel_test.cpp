// SPDX-License-Identifier: MIT
#include <rosin/propagate/airy_kernel.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "support/approx.hpp"

namespace propagate_airy_kernel {

namespace {

constexpr double rate_Hz = 128e3;
const rosin::string_parameters paper{0.314, 72.5, 659.69, 4.7e-5, {}};
using complex = std::complex<double>;

/// d(t) = (x/t) (1/2 pi) int exp(i (w(k) t - k x)) dk, along k = u + i a (sqrt(u^2 + d^2) - d): there the integrand dies away on
/// either side. Dimensionless: k sqrt(B/T), t T / sqrt(B m), x sqrt(T/B), w = k sqrt(1 + k^2). In 1/s.
double by_contour(double t_s, double tau_s, double epsilon) {
  const double t = t_s / std::sqrt(epsilon), x = tau_s / std::sqrt(epsilon), a = 0.1, d = 0.05, reach = 3, step = 2e-3;
  complex sum = 0;
  for (double u = -reach; u <= reach; u += step) {
    const double root = std::sqrt(u * u + d * d);
    const complex k(u, a * (root - d)), slope(1, a * u / root);
    sum += slope * std::exp(complex(0, 1) * (k * std::sqrt(1.0 + k * k) * t - k * x)) * step;
  }
  return (x / t) * sum.real() / (2 * std::numbers::pi) / std::sqrt(epsilon);
}

/// Relative rms difference over the pulse: from where its local frequency is 60 kHz to well behind the front.
double rms_error(double beta, rosin::airy_form form) {
  const double tau = beta / (2 * paper.fundamental_Hz), epsilon = paper.stiffness_s2();
  const double begin = tau * rosin::slowness_ratio(2 * std::numbers::pi * 60e3, epsilon), end = 1.12 * tau;
  double difference = 0, power = 0;
  for (int i = 0; i <= 150; ++i) {
    const double t = begin + (end - begin) * i / 150, exact = by_contour(t, tau, epsilon);
    const double d = rosin::airy_transmission(t, tau, epsilon, form);
    difference += (d - exact) * (d - exact);
    power += exact * exact;
  }
  return std::sqrt(difference / power);
}

}  // namespace

TEST_CASE("with the right normalisation the Airy formula is the transmission function") {
  for (const double beta : {0.25, 0.3, 0.7, 0.75}) {
    CAPTURE(beta);
    CHECK(rms_error(beta, rosin::airy_form::transmission) < 5e-4);
    CHECK(rms_error(beta, rosin::airy_form::printed) > 0.05);  // without 1/tau it is not
  }
}

TEST_CASE("oversampled and decimated, its kernel is the exact-phase kernel") {
  const rosin::band limits{20e3, 60e3};
  for (const double beta : {0.25, 0.75}) {
    const rosin::transmission exact{beta / (2 * paper.fundamental_Hz), paper.stiffness_s2(), {}};
    const rosin::fir airy = rosin::airy_kernel(exact.delay_s, exact.stiffness_s2, limits, rate_Hz);
    CHECK(rosin::pass_band_error(airy, exact, limits, rate_Hz) < 5e-4);
    const rosin::fir printed = rosin::airy_kernel(exact.delay_s, exact.stiffness_s2, limits, rate_Hz, rosin::airy_form::printed);
    CHECK(printed.response(0, rate_Hz).real() == test::approx(1).epsilon(1e-3));
    // |D| = c / c_g instead of 1: -0.69 dB at 20 kHz.
    CHECK(std::abs(printed.response(20e3, rate_Hz)) == test::approx(1 / 1.0828).epsilon(2e-3));
  }
}

TEST_CASE("nothing arrives before the pulse has left") {
  CHECK(rosin::airy_transmission(0, 1e-4, paper.stiffness_s2()) == 0);
  CHECK(rosin::airy_transmission(-1e-5, 1e-4, paper.stiffness_s2()) == 0);
}

}  // namespace propagate_airy_kernel
