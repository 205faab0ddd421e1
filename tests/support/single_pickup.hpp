// SPDX-License-Identifier: MIT
//
// What one pickup hears of a plucked string: damped partials, noise, and a pitch that glides down.
//
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace test {

inline constexpr double pickup_rate_Hz = 44100;

/// A plucked string on one pickup; glide: relative sharpness at the start, gone at 5 per second.
inline std::vector<double> plucked(double f0, double b, double noise, unsigned seed, double glide = 0) {
  std::mt19937_64 random{seed};
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> phase{0, 6.28};
  std::vector<double> x(66150), offset(41);
  for (double& o : offset) o = phase(random);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = static_cast<double>(i) / pickup_rate_Hz - 0.1;
    x[i] = noise * gauss(random);
    if (t < 0) continue;
    const double warped = t + glide * (1 - std::exp(-5 * t)) / 5;
    for (int n = 1; n <= 25; ++n) {
      const double f = n * f0 * std::sqrt(1 + b * n * n);
      x[i] += std::exp(-std::numbers::pi * f * (1 / 1200.0 + 2e-7 * f) * t) / n *
              std::cos(2 * std::numbers::pi * f * warped + offset[static_cast<std::size_t>(n)]);
    }
  }
  return x;
}

}  // namespace test
