// tier: hosted
// SPDX-License-Identifier: MIT
//
// Where the string sticks to the rod and where it slips, from the motion alone. While it sticks, the velocity of its surface
// relative to the rod stays at one level: 0, but for errors of the scale. A slip leads it to one side only, against the way of
// the rod. So the level is the median of what lies near it; what lies beyond it on the side to which nothing slips is the
// fluctuation that sticking has here (noise, the ringing of a band limit, torsion that was not taken into account); and a few
// times that, within bounds set by the rod's speed, tells the two apart. Hysteresis keeps one slip in one piece.
//
// A band limit smears a slip into its neighbourhood; interior() leaves out what its kernel can reach.
//
#pragma once

#include <rosin/core/finite_math.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace rosin {

/// Samples begin .. end - 1.
struct sample_interval {
  std::size_t begin = 0, end = 0;
  [[nodiscard]] std::size_t size() const noexcept { return end - begin; }
};

struct contact_phases {
  std::vector<sample_interval> sticks, slips;  ///< alternate; together with what is unknown they cover the record
  double level_m_s = 0;                        ///< relative velocity while sticking: what the scales' errors leave of zero
  double fluctuation_m_s = 0;                  ///< standard deviation of sticking about that level, robust
  double threshold_m_s = 0;                    ///< beyond this distance from the level it slips
  std::size_t known = 0;                       ///< samples that are numbers

  /// Share of the known samples that stick.
  [[nodiscard]] double sticking() const noexcept {
    std::size_t sum = 0;
    for (const auto& s : sticks) sum += s.size();
    return known > 0 ? static_cast<double>(sum) / static_cast<double>(known) : 0.0;
  }
};

/// Bounds of the threshold relative to the rod's speed, and how many fluctuations it stands off.
struct phase_options {
  double least = 0.05, most = 0.6, fluctuations = 4;
};

namespace detail {

/// What stands off by the threshold or less has the level for its median; from 0 in a few passes.
inline void find_level(std::vector<double> values, double way, double speed, const phase_options& options, contact_phases& p) {
  for (double& v : values) v *= way;
  std::sort(values.begin(), values.end());
  const auto first_above = [&](double x) {
    return static_cast<std::size_t>(std::upper_bound(values.begin(), values.end(), x) - values.begin());
  };
  double level = 0;
  for (int pass = 0; pass < 6; ++pass) {
    const std::size_t above = first_above(level), count = values.size() - above;
    p.fluctuation_m_s = count > 0 ? 1.4826 * (values[above + count / 2] - level) : 0.0;
    p.threshold_m_s = std::clamp(options.fluctuations * p.fluctuation_m_s, options.least * speed, options.most * speed);
    const std::size_t low = first_above(level - p.threshold_m_s), high = first_above(level + p.threshold_m_s);
    if (high > low) level = values[(low + high) / 2];
  }
  p.level_m_s = way * level;
}

}  // namespace detail

/// From the surface's velocity less the rod's (NaN: unknown). The rod's speed is that of the steady stroke, with its sign.
[[nodiscard]] inline contact_phases find_phases(std::span<const double> relative_m_s, double rod_speed_m_s,
                                                const phase_options& options = {}) {
  contact_phases p;
  const double way = rod_speed_m_s < 0 ? -1.0 : 1.0, speed = std::abs(rod_speed_m_s);
  std::vector<double> known;
  for (const double v : relative_m_s)
    if (std::isfinite(v) && std::abs(v) < 1.5 * speed) known.push_back(v);
  if (!known.empty()) detail::find_level(std::move(known), way, speed, options, p);
  int state = -1;  // of the sample before: -1 unknown, 0 sticking, 1 slipping
  for (std::size_t i = 0; i < relative_m_s.size(); ++i) {
    const double v = relative_m_s[i], off = std::abs(v - p.level_m_s);
    const int now = !std::isfinite(v) ? -1 : off > p.threshold_m_s ? 1 : state == 1 && off > p.threshold_m_s / 2 ? 1 : 0;
    p.known += now >= 0 ? 1U : 0U;
    auto& list = now == 1 ? p.slips : p.sticks;
    if (now >= 0 && now != state) list.push_back({i, i});
    if (now >= 0) list.back().end = i + 1;
    state = now;
  }
  return p;
}

/// 1 for each sample that lies at least `margin` samples inside one of the intervals.
[[nodiscard]] inline std::vector<char> interior(const std::vector<sample_interval>& intervals, std::size_t samples,
                                                std::size_t margin) {
  std::vector<char> inside(samples, 0);
  for (const auto& s : intervals)
    for (std::size_t i = s.begin + margin; i + margin < s.end; ++i) inside[i] = 1;
  return inside;
}

}  // namespace rosin
