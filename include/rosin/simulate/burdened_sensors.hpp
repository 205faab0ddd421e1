// tier: hosted
// SPDX-License-Identifier: MIT
//
// What faulty sensors make of the forces on the two ends, step by step, before a converter samples them:
//
//     quadratic share -> the sensor's own resonance -> leakage between the channels -> the far channel comes late, or has a clock of its own
//
// (the first two the other way about where it rings first).
// The resonance w0^2 / (s^2 + s w0/q + w0^2) is stepped exactly for a force that is straight within a step; what comes late is
// read from a cubic through four steps. Gain, AC coupling, hum, noise and rounding are the converter's (converter.hpp).
//
#pragma once

#include <rosin/simulate/mode_step.hpp>

#include <algorithm>
#include <array>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct sensor_faults {
  std::array<double, 2> quadratic_per_N{}, resonance_Hz{}, resonance_q{10, 10};  ///< near, far; resonance 0: none
  std::array<bool, 2> rings_first{};  ///< and bends what rings; else the other way about
  double crosstalk = 0;               ///< share of each channel in the other
  double skew_s = 0;                  ///< the far channel comes late by this
  double clock_drift = 0;             ///< its clock is fast by this, relative
};

namespace detail {

inline void ring_along(std::vector<double>& x, double frequency_Hz, double q, double step_s) {
  const double w = 2 * 3.14159265358979323846 * frequency_Hz;
  driven_mode sensor({1, w, 1 / q, 1 / (w * w), 0}, step_s);  // on a spring of 1 N/m: its displacement is what it says
  if (!x.empty()) sensor.rest_at(x.front(), x.front());
  for (double& sample : x) sample = sensor.advance(sample).displacement;
}

/// x at n slope + offset, n = 0, 1, ...; the ends are held.
[[nodiscard]] inline std::vector<double> read_along(const std::vector<double>& x, double slope, double offset) {
  std::vector<double> out(x.size());
  const auto at = [&](double n) { return x[static_cast<std::size_t>(std::clamp(n, 0.0, static_cast<double>(x.size() - 1)))]; };
  for (std::size_t n = 0; n < x.size(); ++n) {
    const double place = static_cast<double>(n) * slope + offset, i = std::floor(place), u = place - i, a = at(i - 1), b = at(i),
                 c = at(i + 1), d = at(i + 2);
    out[n] = -u * (u - 1) * (u - 2) / 6 * a + (u + 1) * (u - 1) * (u - 2) / 2 * b - (u + 1) * u * (u - 2) / 2 * c +
             (u + 1) * u * (u - 1) / 6 * d;
  }
  return out;
}

}  // namespace detail

/// begin_s: where the take begins, and both clocks show the same.
inline void disturb(std::array<std::vector<double>, 2>& end_N, const sensor_faults& faults, double step_s, double begin_s = 0) {
  for (std::size_t c = 0; c < 2; ++c) {
    const auto bend = [&, a = faults.quadratic_per_N[c]] {
      if (a == 0) return;
      for (double& f : end_N[c]) f += a * f * f;
    };
    if (!faults.rings_first[c]) bend();
    if (faults.resonance_Hz[c] > 0) detail::ring_along(end_N[c], faults.resonance_Hz[c], faults.resonance_q[c], step_s);
    if (faults.rings_first[c]) bend();
  }
  if (faults.crosstalk != 0)
    for (std::size_t n = 0; n < end_N[0].size(); ++n) {
      const double near = end_N[0][n];
      end_N[0][n] += faults.crosstalk * end_N[1][n];
      end_N[1][n] += faults.crosstalk * near;
    }
  if (faults.skew_s != 0) end_N[1] = detail::read_along(end_N[1], 1, -faults.skew_s / step_s);
  if (const double slope = 1 / (1 + faults.clock_drift); slope != 1)
    end_N[1] = detail::read_along(end_N[1], slope, (1 - slope) * begin_s / step_s);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
