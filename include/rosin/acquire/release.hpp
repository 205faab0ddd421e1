// tier: hosted
// SPDX-License-Identifier: MIT
//
// When a pluck begins. Under a force transducer the release arrives as a step of the whole breaking force, downwards:
// near falls from F (1 - beta) to -F beta, far from F beta to -F (1 - beta). High frequencies run ahead of the step in a
// stiff string, so it is sought between averages over a twentieth of a period on either side. Other sensors show an onset.
//
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct step_arrival {
  std::size_t frame = 0;
  double height = 0;  ///< after minus before
};

namespace detail {

[[nodiscard]] inline std::vector<double> running_sum(const std::vector<double>& x) {
  std::vector<double> sum(x.size() + 1, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) sum[i + 1] = sum[i] + x[i];
  return sum;
}

}  // namespace detail

/// The first step that is at least half as high as the highest. Empty where the record is shorter than a few periods.
[[nodiscard]] inline std::optional<step_arrival> find_release_step(const std::vector<double>& x, double sample_rate_Hz,
                                                                   double fundamental_Hz) {
  const auto half = static_cast<std::size_t>(std::max(2.0, std::round(sample_rate_Hz / (20 * fundamental_Hz))));
  if (x.size() < 8 * half) return std::nullopt;
  const auto sum = detail::running_sum(x);
  const auto height = [&](std::size_t i) { return (sum[i + half] - 2 * sum[i] + sum[i - half]) / static_cast<double>(half); };
  double highest = 0;
  for (std::size_t i = half; i + half < x.size(); ++i) highest = std::max(highest, std::abs(height(i)));
  std::size_t first = half;
  while (first + half < x.size() && std::abs(height(first)) < highest / 2) ++first;
  if (highest <= 0) return std::nullopt;
  std::size_t best = first;
  for (std::size_t i = first; i < first + 2 * half && i + half < x.size(); ++i)
    if (std::abs(height(i)) > std::abs(height(best))) best = i;
  return step_arrival{best, height(best)};
}

/// The first half period whose power about its mean is a tenth of the strongest one's; its first sample.
[[nodiscard]] inline std::optional<std::size_t> first_onset(const std::vector<double>& x, double sample_rate_Hz,
                                                            double fundamental_Hz) {
  const auto block = static_cast<std::size_t>(std::max(4.0, std::round(sample_rate_Hz / (2 * fundamental_Hz))));
  std::vector<double> power;
  for (std::size_t i = 0; i + block <= x.size(); i += block) {
    double mean = 0, square = 0;
    for (std::size_t k = i; k < i + block; ++k) mean += x[k] / static_cast<double>(block);
    for (std::size_t k = i; k < i + block; ++k) square += (x[k] - mean) * (x[k] - mean);
    power.push_back(square);
  }
  if (power.empty()) return std::nullopt;
  const double strongest = *std::max_element(power.begin(), power.end());
  double largest = 0;
  for (const double v : x) largest = std::max(largest, std::abs(v));
  if (strongest <= 1e-20 * largest * largest * static_cast<double>(block)) return std::nullopt;  // rounding
  std::size_t at = 0;
  while (power[at] < strongest / 10) ++at;
  return at * block;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
