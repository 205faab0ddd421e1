// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pluck_model.hpp>
#include <rosin/propagate/complex_dispersion.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "support/approx.hpp"
#include "support/causal_string.hpp"

namespace {

using complex = std::complex<double>;
const rosin::ringing_string string{659.69, 6.49e-5, {}, 0};
constexpr double position = 0.3;
const rosin::band limits{30e3, 60e3};

/// Force on the near end per newton at the contact, a stiff string between pinned ends, at a complex frequency s: propagating and
/// evanescent wave (from y'' = 0 at both ends and F = T y' - B y''').
complex end_force(complex s, double from_other_end) {
  const double epsilon = string.stiffness_s2(), L = 0.5 / string.fundamental_Hz;
  const complex w = s / complex(0, 1), q = rosin::phase_rate(w, epsilon), K = epsilon * q * q;
  const complex kappa = std::sqrt(q * q + 1 / epsilon), d = from_other_end * L;
  return ((1.0 + K) * std::sin(q * d) / std::sin(q * L) + K * std::exp(kappa * (d - L))) / (1.0 + 2.0 * K);
}

/// The force on an end after the release, by a numerical inverse Laplace transform on a shifted line: nothing modal about it.
/// The deflecting force is 1 before t = 0 and 0 after it: F(t) = F(0) - (response to a step).
double by_transform(double t, double from_other_end, double static_force) {
  const double sigma = 400, df = 20;
  complex sum = 0;
  for (int n = 0; n * df < limits.stop_Hz; ++n) {
    const complex s(sigma, 2 * std::numbers::pi * n * df);
    sum += (n == 0 ? 0.5 : 1.0) * limits(n * df) * end_force(s, from_other_end) / s * std::exp(s * t);
  }
  return static_force - 2 * df * sum.real();
}

double by_lines(double t, std::size_t end) {
  double sum = 0;
  for (const rosin::damped_line& l : rosin::pluck_lines(string, position, t, limits, 1000)) sum += l.residue[end].real();
  return sum;
}

}  // namespace

TEST_CASE("the sum over partials is the inverse transform of the closed form, at both ends") {
  for (double t = 0.4e-3; t < 6e-3; t += 0.0731e-3) {
    CAPTURE(t);
    CHECK(std::abs(by_lines(t, 0) - by_transform(t, 1 - position, 1 - position)) < 2e-3);
    CHECK(std::abs(by_lines(t, 1) - by_transform(t, position, position)) < 2e-3);
  }
}

TEST_CASE("at the release the ends still feel the wire") {
  CHECK(rosin::static_forces(position)[0] == 0.7);
  CHECK(by_lines(0, 0) == test::approx(0.7).epsilon(5e-3));
  CHECK(by_lines(0, 1) == test::approx(0.3).epsilon(5e-3));
}

TEST_CASE("partials of a string whose loss is causal are the inverse transform of its closed form") {
  const test::causal_string causal{.fundamental_Hz = 440, .quality = 400};
  const double rate = 96e3;
  const std::size_t count = 6000;
  const rosin::band below{10e3, 14e3};
  const auto recorded = causal.pluck(0.3, 0, rate, count, below);
  const auto left = [&](double causality, double convention) {
    const rosin::ringing_string model{440, 0, {.quality = 400, .causality = causality, .reference_Hz = 440}, convention};
    const auto lines = rosin::pluck_lines(model, 0.3, 0, below, 1000);
    double off = 0, all = 0;
    for (std::size_t end = 0; end < 2; ++end)
      for (std::size_t i = 100; i < count; ++i) {
        double sum = 0;
        for (const auto& l : lines) sum += (l.residue[end] * std::exp(l.pole * (static_cast<double>(i) / rate))).real();
        off += std::pow(sum - recorded[end][i], 2), all += std::pow(recorded[end][i], 2);
      }
    return std::sqrt(off / all);
  };
  CHECK(left(1, 0) < 5e-4);  // Q is 1 / (pi Q) off, by what it is taken for
  CHECK(left(0, 0) > 0.1);
}

TEST_CASE("partials, their decay and their phase") {
  const rosin::ringing_string lossy{600, 1e-4, {500, 1e-7, 0}, -1};
  const auto lines = rosin::pluck_lines(lossy, 0.2, 0, limits, 7);
  CHECK(lines.size() == 7);
  for (int n = 1; n <= 7; ++n) {
    const double f = n * 600 * std::sqrt(1 + 1e-4 * n * n), half = (1 / 500.0 + 1e-7 * f) / 2;
    const rosin::damped_line& l = lines[static_cast<std::size_t>(n - 1)];
    CHECK(std::abs(l.pole) == test::approx(2 * std::numbers::pi * f));
    CHECK(-l.pole.real() / std::abs(l.pole) == test::approx(half));
    CHECK(l.residue[0].imag() / l.residue[0].real() == test::approx(-half).epsilon(1e-3));
    CHECK(l.residue[1].real() == test::approx((n % 2 ? 1 : -1) * l.residue[0].real()));
  }
  CHECK(lossy.stiffness_s2() == test::approx(1e-4 / std::pow(2 * std::numbers::pi * 600, 2)));
}
