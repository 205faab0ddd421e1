// tier: hosted
// SPDX-License-Identifier: MIT
//
// The force's missing DC level behind AC-coupled sensors, as the paper guesses it (section III A): the friction coefficient in
// a slip runs from about 0.4 to 0.9 for rosin, so the loop's middle lies at 0.65 times the normal force. That is an estimate
// from other people's rosin, good to perhaps a fifth, and is reported as such; a fitted friction law does better.
//
#pragma once

#include <rosin/core/finite_math.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace rosin {

/// To be added to the force; 0 and infinitely uncertain where nothing slips or the normal force is unknown.
struct dc_estimate {
  double level_N = 0, sd_N = 0;
  bool available = false;
};

/// Force and velocity of a take (NaN where unknown), rod speed and normal force. Sliding: slower than half the rod's speed.
[[nodiscard]] inline dc_estimate estimate_dc_level(std::span<const double> force_N, std::span<const double> velocity_m_s,
                                                   double rod_speed_m_s, double normal_force_N) {
  constexpr double middle = 0.65, doubt = 0.15;  // of the friction coefficient while slipping
  std::vector<double> sliding;
  for (std::size_t i = 0; i < force_N.size() && i < velocity_m_s.size(); ++i)
    if (std::isfinite(force_N[i]) && std::isfinite(velocity_m_s[i]) &&
        velocity_m_s[i] * rod_speed_m_s < 0.5 * rod_speed_m_s * rod_speed_m_s)
      sliding.push_back(force_N[i]);
  if (sliding.size() < 20 || !(normal_force_N > 0)) return {};
  const auto quantile = [&](double q) {
    const auto at = sliding.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(sliding.size() - 1));
    std::nth_element(sliding.begin(), at, sliding.end());
    return *at;
  };
  const double low = quantile(0.02), high = quantile(0.98), sign = rod_speed_m_s < 0 ? -1.0 : 1.0;
  return {sign * middle * normal_force_N - (low + high) / 2, doubt * normal_force_N, true};
}

}  // namespace rosin
