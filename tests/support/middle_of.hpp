// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace test {

/// What a signal of many periods swings about: its mean under a Hann window.
inline double middle_of(std::span<const double> x) {
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double w = 1 - std::cos(6.283185307179586 * (static_cast<double>(i) + 0.5) / static_cast<double>(x.size()));
    sum += w * x[i], weights += w;
  }
  return sum / weights;
}

}  // namespace test
