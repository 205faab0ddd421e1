// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a bowed string does in the end, and how long it took to get there. Slips are taken from the contact itself: intervals
// in which the string's surface moves against the rod by more than a share of the rod's speed. Over the last periods of the take
//
//     none                      no oscillation: it sticks, or slides all the time
//     one a period, all alike   Helmholtz motion
//     several, all alike        double or multiple slip
//     fewer than one            anomalous low frequency (period twice the string's and more, all alike)
//     else                      raucous
//
// "Alike": the slips' distance is steady. The transient ends where the slips begin to come once a period (or as they do in the
// end) and never leave off. After J. C. Schelleng, J. Acoust. Soc. Am. 53 (1973), 26-41, and K. Guettler, Acta Acustica
// united with Acustica 88 (2002), 970-983.
//
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

enum class bowed_regime { none, helmholtz, multiple_slip, low_frequency, raucous };

inline constexpr std::array<std::string_view, 5> regime_names{"none", "helmholtz", "multiple-slip", "low-frequency", "raucous"};
[[nodiscard]] inline std::string_view name_of(bowed_regime r) noexcept { return regime_names[static_cast<std::size_t>(r)]; }

struct regime_settings {
  double slip_share = 1;        ///< of the rod's speed: more is a slip (in Helmholtz motion it is 1 / beta)
  double shortest_slip = 0.02;  ///< in periods; two slips nearer to each other than this are one
  int periods = 12;             ///< at the end, that decide
  double steady = 0.06;         ///< in periods: onsets may stray by this
};

struct regime_finding {
  bowed_regime regime = bowed_regime::none;
  double transient_periods = 0;  ///< until the final pattern, which stays; whole take if it never settles
  double slips_per_period = 0;   ///< over the last periods
};

/// Onsets of the slips, in samples. `slip` is surface less rod velocity, of the same length as the rod's.
[[nodiscard]] inline std::vector<double> slip_onsets(std::span<const double> slip_m_s, std::span<const double> rod_m_s,
                                                     double period_samples, const regime_settings& s = {}) {
  std::vector<double> onsets;
  const double gap = s.shortest_slip * period_samples;
  double left_off = -1e300;
  bool inside = false;
  for (std::size_t n = 0; n < slip_m_s.size(); ++n) {
    const double share = std::abs(rod_m_s[n]) > 0 ? std::abs(slip_m_s[n] / rod_m_s[n]) : 0;
    if (!inside && share > s.slip_share) {
      if (static_cast<double>(n) - left_off > gap) onsets.push_back(static_cast<double>(n));
      inside = true;
    } else if (inside && share < s.slip_share / 2) {
      inside = false;
      left_off = static_cast<double>(n);
    }
  }
  return onsets;
}

namespace detail {

/// Does slip i come `lag` slips after its like, `periods` periods later?
[[nodiscard]] inline bool recurs(const std::vector<double>& onsets, std::size_t i, std::size_t lag, double periods, double period,
                                 double steady) {
  return i >= lag && std::abs((onsets[i] - onsets[i - lag]) / period - periods) < steady * std::max(1.0, periods);
}

/// Index of the first slip from which on all recur in this way; onsets.size() if the last does not.
[[nodiscard]] inline std::size_t steady_from(const std::vector<double>& onsets, std::size_t lag, double periods, double period,
                                             double steady) {
  std::size_t from = onsets.size();
  while (from > lag && recurs(onsets, from - 1, lag, periods, period, steady)) --from;
  return from;
}

}  // namespace detail

/// `fundamental_Hz` is the string's own.
[[nodiscard]] inline regime_finding classify(std::span<const double> slip_m_s, std::span<const double> rod_m_s,
                                             double sample_rate_Hz, double fundamental_Hz, const regime_settings& s = {}) {
  const double period = sample_rate_Hz / fundamental_Hz, length = static_cast<double>(slip_m_s.size()),
               tail = length - s.periods * period;
  const auto onsets = slip_onsets(slip_m_s, rod_m_s, period, s);
  const auto late = onsets.end() - std::lower_bound(onsets.begin(), onsets.end(), tail);
  regime_finding found{.regime = bowed_regime::none,
                       .transient_periods = length / period,
                       .slips_per_period = static_cast<double>(late) / s.periods};
  if (late == 0) {
    found.transient_periods = onsets.empty() ? 0 : onsets.back() / period;
    return found;
  }
  found.regime = bowed_regime::raucous;
  const auto settle = [&](bowed_regime regime, std::size_t lag, double periods) {
    const auto from = detail::steady_from(onsets, lag, periods, period, s.steady);
    const bool lasts = from < onsets.size() && onsets[from - lag] <= tail + periods * period &&
                       length - onsets.back() < (periods + 0.5) * period;
    if (!lasts) return false;
    found.regime = regime;
    found.transient_periods = onsets[from - lag] / period;
    return true;
  };
  if (settle(bowed_regime::helmholtz, 1, 1)) return found;
  for (std::size_t slips = 2; slips <= 6; ++slips)
    if (settle(bowed_regime::multiple_slip, slips, 1)) return found;
  for (int periods = 2; periods <= 5; ++periods)
    if (settle(bowed_regime::low_frequency, 1, periods)) return found;
  return found;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
