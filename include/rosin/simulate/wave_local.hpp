// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a force does to a stiff string at its own place before any echo is back: the near part of the driving-point
// mobility,
//
//     Y(w) = (1 - i k / kappa) / (2 Z_f),      Z_f = Z (1 + 2K) / sqrt(1 + K),
//
// a wave to either side and the bend that stays near the force (docs/explain/theory.md). The simulated force runs straight
// between its values at the steps, so the velocity at the steps is the discrete response to triangles of force,
//
//     y[n] = 1 / (2 pi) int Y(w) sinc^2(w h / 2) e^(i w n h) h dw,
//
// causal because Y is, and positive real because the sum of Y sinc^2 over all aliases is: no step creates energy. An ideal
// string has one tap, 1 / (2 Z). Loss, a turn of 1 / (2 Q) in phase, is left out here.
//
#pragma once

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include <rosin/propagate/dispersion.hpp>
#include <rosin/propagate/string_parameters.hpp>

namespace rosin {

/// Mobility at the contact of a string without ends, m/s per N.
[[nodiscard]] inline std::complex<double> local_mobility(const string_parameters& string, double omega) noexcept {
  const double eps = string.stiffness_s2(), w = std::abs(omega);
  const double forward = slowness_ratio(w, eps) / (2 * string.impedance_Ns_m());
  return {forward, -forward * std::copysign(near_field_ratio(w, eps), omega)};
}

/// Amplitude of the wave that 1 N sends to either side, m/s: 1 / (2 Z_f).
[[nodiscard]] inline double wave_mobility(const string_parameters& string, double omega) noexcept {
  return slowness_ratio(std::abs(omega), string.stiffness_s2()) / (2 * string.impedance_Ns_m());
}

/// The weight of a frequency in a line drawn straight between samples.
[[nodiscard]] inline double straight_line_weight(double omega, double step_s) noexcept {
  const double x = omega * step_s / 2;
  const double sinc = std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x;
  return sinc * sinc;
}

namespace detail {

/// The sampled mobility at one frequency: all aliases within reach; what lies beyond is added as an integral of w^(-5/2).
[[nodiscard]] inline std::complex<double> folded_mobility(const string_parameters& string, double omega, double step_s) {
  constexpr int reach = 100;
  const double turn = 2 * std::numbers::pi / step_s;
  std::complex<double> sum = 0;
  for (int m = -reach; m <= reach; ++m)
    sum += local_mobility(string, omega + m * turn) * straight_line_weight(omega + m * turn, step_s);
  const double edge = (reach + 0.5) * turn, sine = std::sin(omega * step_s / 2);
  const double beyond = local_mobility(string, edge).real() * sine * sine * 4 / (step_s * step_s * edge * edge);
  return sum + 2 * beyond * (reach + 0.5) / 1.5;
}

}  // namespace detail

/// The taps y[0], y[1], ... until they have died to `rest` of the first.
[[nodiscard]] inline std::vector<double> local_response(const string_parameters& string, double step_s, double rest = 1e-7) {
  if (!(string.bending_stiffness_Nm2 > 0)) return {1 / (2 * string.impedance_Ns_m())};
  constexpr std::size_t grid = 1024;
  std::vector<std::complex<double>> bins(grid / 2 + 1);
  for (std::size_t i = 0; i < bins.size(); ++i)
    bins[i] = detail::folded_mobility(string, 2 * std::numbers::pi * static_cast<double>(i) / (step_s * grid), step_s);
  std::vector<double> taps;
  std::size_t last = 0;
  for (std::size_t n = 0; n < grid / 4; ++n) {
    double sum = (bins.front().real() + (n % 2 == 0 ? 1 : -1) * bins.back().real()) / 2;
    for (std::size_t i = 1; i + 1 < bins.size(); ++i)
      sum += (bins[i] * std::polar(1.0, 2 * std::numbers::pi * static_cast<double>(i * n % grid) / grid)).real();
    taps.push_back(2 * sum / grid);
    if (std::abs(taps.back()) > rest * taps.front()) last = n;
  }
  taps.resize(last + 1);
  return taps;
}

}  // namespace rosin
