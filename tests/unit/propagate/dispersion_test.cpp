// SPDX-License-Identifier: MIT
#include <rosin/propagate/dispersion.hpp>

#include <rosin/propagate/complex_dispersion.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "support/approx.hpp"

namespace propagate_dispersion {

namespace {

// The paper's string: m w^2 = T k^2 + B k^4.
constexpr double T = 72.5, B = 4.7e-5, L = 0.314, c = 2 * L * 659.69, m = T / (c * c), epsilon = B * m / (T * T);

/// The positive root of the PDE by bisection: shares nothing with the closed form.
double wavenumber(double w) {
  double low = 0, high = w / c;
  for (int i = 0; i < 200; ++i) {
    const double k = (low + high) / 2;
    (T * k * k + B * k * k * k * k < m * w * w ? low : high) = k;
  }
  return low;
}

}  // namespace

TEST_CASE("the phase rate is the root of the dispersion relation, at any frequency") {
  for (const double f : {1.0, 660.0, 5e3, 20e3, 64e3, 1e6}) {
    const double w = 2 * std::numbers::pi * f, k = wavenumber(w);
    CHECK(rosin::phase_rate(w, epsilon) == test::approx(c * k).epsilon(1e-13));
    CHECK(rosin::stiffness_ratio(w, epsilon) == test::approx(B * k * k / T).epsilon(1e-12));
    CHECK(rosin::near_field_ratio(w, epsilon) == test::approx(k / std::sqrt(k * k + T / B)).epsilon(1e-12));
    CHECK(rosin::phase_rate(-w, epsilon) == -rosin::phase_rate(w, epsilon));
    const double h = 1e-4 * w;
    const double group_delay = (wavenumber(w + h) - wavenumber(w - h)) / (2 * h);  // 1 / c_g
    CHECK(rosin::slowness_ratio(w, epsilon) == test::approx(c * group_delay).epsilon(1e-7));
  }
}

TEST_CASE("values of the paper's string at 20 and 40 kHz") {
  const double at20 = 2 * std::numbers::pi * 20e3, at40 = 2 * at20;
  CHECK(rosin::stiffness_ratio(at20, epsilon) == test::approx(0.05646).epsilon(1e-3));
  CHECK(1 / rosin::slowness_ratio(at40, epsilon) == test::approx(1.2767).epsilon(1e-4));
  CHECK(rosin::force_factor(at40, epsilon) == test::approx(1.1660).epsilon(1e-4));
  CHECK(rosin::wave_impedance_ratio(at20, epsilon) == test::approx(std::sqrt(1.05646)).epsilon(1e-4));
}

TEST_CASE("an ideal string disperses nothing; float is as good as float can be; complex frequencies are analytic") {
  CHECK(rosin::phase_rate(1234.5, 0.0) == 1234.5);
  CHECK(rosin::slowness_ratio(1e5, 0.0) == 1);
  CHECK(rosin::force_factor(1e5, 0.0) == 1);
  CHECK(static_cast<double>(rosin::phase_rate(1e5F, static_cast<float>(epsilon))) ==
        test::approx(rosin::phase_rate(1e5, epsilon)).epsilon(1e-6));
  const std::complex<double> w(1e5, 300), q = rosin::phase_rate(w, epsilon);
  CHECK(std::abs(q * q * (1.0 + epsilon * q * q) - w * w) < 1e-12 * std::abs(w * w));
}

}  // namespace propagate_dispersion
