// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a force, or time, does to the surface that sticks, as columns of the equation in contact_stick.hpp: bristles that bend, a
// rod that gives way along its motion, a rod whose speed ripples; and the sensors' noise in columns of their two forces.
//
#pragma once

#include <rosin/torsion/stick_data.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What bristles of a micrometre a newton bend by: a spring with a delay of its own.
[[nodiscard]] inline std::complex<double> bristle_bending(double f, double delay_s) {
  const std::complex<double> s(0, 2 * std::numbers::pi * f);
  return -1e-6 * s / (1.0 + s * delay_s);
}

/// A resonator of some mass under the string, with the sign that it has in the equation: -Y, Y = (s / m) / (s^2 + s w0 / q + w0^2).
struct rod_mobility {
  double frequency_Hz = 0, q = 1, mass_kg = 1;

  [[nodiscard]] std::complex<double> operator()(double f) const noexcept {
    return -std::complex<double>(0, f / (2 * std::numbers::pi * mass_kg)) /
           std::complex<double>(frequency_Hz * frequency_Hz - f * f, f * frequency_Hz / q);
  }
  /// How long it rings, to a thousandth.
  [[nodiscard]] double memory_s() const noexcept { return std::log(1e3) * q / (std::numbers::pi * frequency_Hz); }
};

/// A tone of the rod's speed at all samples of a record.
[[nodiscard]] inline std::vector<double> rod_wave(const stick_record& record, double frequency_Hz, double phase) {
  const stick_take& take = record.take();
  std::vector<double> wave(record.size());
  for (std::size_t i = 0; i < wave.size(); ++i)
    wave[i] = take.rod_speed_m_s * std::sin(2 * std::numbers::pi * frequency_Hz * static_cast<double>(i) / take.rate_Hz + phase);
  return wave;
}

/// How forces make what sticks creep, for a speed of 1 m/s under a force as large as the normal force.
[[nodiscard]] inline std::vector<double> creep_column(std::vector<double> force_N, double normal_force_N, double sharpness) {
  for (double& f : force_N) f = -std::copysign(std::exp(std::min(4.0, (std::abs(f) / normal_force_N - 1) / sharpness)), f);
  return force_N;
}

namespace detail {

/// What the sensors' noise is in a row of columns F_1, F_2 (asked by frequency), rms, through a window.
template <class Row>
[[nodiscard]] double noise_of_ends(const Row& row, const std::array<double, 2>& noise_N, double rate_Hz,
                                   const smooth_window& window) {
  constexpr int steps = 400;
  double power = 0;
  for (int k = 0; k < steps; ++k) {
    const double f = window.edge_Hz * (k + 0.5) / steps;
    const std::array<std::complex<double>, 2> columns = row(f);
    for (const std::size_t side : {0U, 1U}) power += std::pow(window(f) * noise_N[side], 2) * std::norm(columns[side]);
  }
  return std::sqrt(power * 2 * window.edge_Hz / (rate_Hz * steps));
}

}  // namespace detail

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
