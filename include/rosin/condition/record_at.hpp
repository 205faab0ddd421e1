// tier: hosted
// SPDX-License-Identifier: MIT
//
// A record read between its samples, at any instants. For instants that lie a sample apart, condition/record_delay.hpp is faster.
//
#pragma once

#include <rosin/condition/fractional_delay_design.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// x at the instants at(0) .. at(size - 1), in samples, by windowed sincs of 48 samples; what lies outside is taken to be like the
/// nearest sample. Good to 1e-5 up to 0.85 of half the sampling rate.
template <class Instant>
[[nodiscard]] std::vector<double> record_at(const std::vector<double>& x, const Instant& at_sample) {
  constexpr int taps = 48, fractions = 512;
  using window = Eigen::Vector<double, taps>;
  static const std::vector<window> table = [] {  // an instant at `fraction` behind a sample, the oldest of its neighbours first
    std::vector<window> out(fractions + 1);
    const double beta = kaiser_beta(kaiser_attenuation_dB(taps, 0.85));
    std::array<double, taps> weights;
    for (std::size_t f = 0; f <= fractions; ++f) {
      kaiser_weights(1 - static_cast<double>(f) / fractions, beta, weights);
      out[f] = Eigen::Map<const window>(weights.data()).reverse();
    }
    return out;
  }();
  std::vector<double> out(x.size());
  const auto count = static_cast<std::ptrdiff_t>(x.size());
  window at_edge;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double at = std::clamp<double>(at_sample(i), -taps, static_cast<double>(count + taps)), whole = std::floor(at),
                 fine = (at - whole) * fractions;
    const auto f = std::min<std::size_t>(fractions - 1, static_cast<std::size_t>(fine));
    const double mix = fine - static_cast<double>(f);
    const std::ptrdiff_t oldest = static_cast<std::ptrdiff_t>(whole) - taps / 2 + 1;
    const bool inside = oldest >= 0 && oldest + taps <= count;
    for (int j = 0; j < taps && !inside; ++j)
      at_edge[j] = x[static_cast<std::size_t>(std::clamp(oldest + j, std::ptrdiff_t{0}, count - 1))];
    const Eigen::Map<const window> seen(inside ? &x[static_cast<std::size_t>(oldest)] : at_edge.data());
    out[i] = (1 - mix) * table[f].dot(seen) + mix * table[f + 1].dot(seen);
  }
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
