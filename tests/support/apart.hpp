// SPDX-License-Identifier: MIT
//
// How far two signals are from one another.
//
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace test {

/// Rms of the difference over rms of the second, less a level.
inline double apart(std::span<const double> a, std::span<const double> b, double level = 0) {
  double difference = 0, power = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    difference += (a[i] - b[i]) * (a[i] - b[i]);
    power += (b[i] - level) * (b[i] - level);
  }
  return std::sqrt(difference / power);
}

/// Of Eq. (12): the level is the second's mean.
inline double delta(std::span<const double> a, std::span<const double> b) {
  double mean = 0;
  for (const double x : b) mean += x / static_cast<double>(b.size());
  return apart(a, b, mean);
}

}  // namespace test
