// tier: hosted
// SPDX-License-Identifier: MIT
//
// A rod whose speed, normal force and place on the string follow break points: straight between them, constant before the first
// and after the last. Whichever has no points is that of a steady stroke. Times count from the first sample of the take.
//
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include <rosin/simulate/modal_stroke.hpp>

namespace rosin {

struct profiled_rod {
  using break_points = std::vector<std::pair<double, double>>;  ///< time in s, value; times ascend

  steady_rod steady{};
  break_points speed_m_s{}, normal_force_N{};
  break_points place{};  ///< distance from the near end / length; without points the rod stays where it is

  [[nodiscard]] rod_state operator()(double t) const noexcept {
    const rod_state usual = steady(t);
    return {speed_m_s.empty() ? usual.velocity_m_s : value_at(speed_m_s, t),
            normal_force_N.empty() ? usual.normal_force_N : value_at(normal_force_N, t)};
  }

  [[nodiscard]] bool travels() const noexcept { return !place.empty(); }
  /// Precondition: travels().
  [[nodiscard]] double position(double t) const noexcept { return value_at(place, t); }

  /// Precondition: there is at least one point.
  [[nodiscard]] static double value_at(const break_points& points, double t) noexcept {
    const auto after = std::upper_bound(points.begin(), points.end(), t, [](double x, const auto& p) { return x < p.first; });
    if (after == points.begin()) return points.front().second;
    if (after == points.end()) return points.back().second;
    const auto& [t0, y0] = *(after - 1);
    return y0 + (after->second - y0) * (t - t0) / (after->first - t0);
  }
};

static_assert(TravellingRod<profiled_rod>);

}  // namespace rosin
