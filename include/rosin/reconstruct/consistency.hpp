// tier: hosted
// SPDX-License-Identifier: MIT
//
// How far two waveforms differ, Eq. (12) of Woodhouse, Schumacher & Garoff (2000):
//
//     Delta = sqrt( sum (a - b)^2 / (sum a^2 + sum b^2) ),    means taken out first.
//
// 0 for equal, 1 for uncorrelated waveforms of any relative size.
//
#pragma once

#include <rosin/core/finite_math.hpp>

#include <cmath>
#include <cstddef>
#include <span>

namespace rosin {

/// Delta over the samples at which both are finite; 0 where there are none or nothing moves.
[[nodiscard]] inline double consistency_delta(std::span<const double> a, std::span<const double> b) noexcept {
  const std::size_t n = a.size() < b.size() ? a.size() : b.size();
  double mean_a = 0, mean_b = 0, count = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (std::isfinite(a[i]) && std::isfinite(b[i])) mean_a += a[i], mean_b += b[i], ++count;
  if (count == 0) return 0;
  mean_a /= count;
  mean_b /= count;
  double difference = 0, power = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    const double x = a[i] - mean_a, y = b[i] - mean_b;
    difference += (x - y) * (x - y);
    power += x * x + y * y;
  }
  return power > 0 ? std::sqrt(difference / power) : 0.0;
}

}  // namespace rosin
