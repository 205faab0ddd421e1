// tier: hosted
// SPDX-License-Identifier: MIT
//
// What one slip draws into the plane of force and velocity, and the track that slips and sticks leave along the rod.
//
// The plane has the velocity of the string against the rod to the right and the force of the rod on the string upwards, both
// counted the way the rod moves: the string sticks at 0 and slips to the left of it, as in Figs. 3(d) and 6(d) of Woodhouse,
// Schumacher & Garoff (2000). Signed area of the closed polygon of a slip's samples, x to the right, y upwards:
//
//     area = 1/2 sum (x_i y_i+1 - x_i+1 y_i)        > 0: counter-clockwise,  < 0: clockwise
//
// Counter-clockwise means a force that is higher while the slip gathers speed than while it loses it: the contact warms up and
// cools down late. A force that depends on velocity alone goes back the way it came; yet its loops are not empty, because string
// and rod come apart along one load line and stick again along another, where the force is lower, and a band limit rounds both
// jumps off. Far from sticking there is no jump. So the sense is judged by the part of the loop beyond three quarters of its
// greatest speed: divided by the width of that part it is the mean split of the force between there and back, in newtons.
//
// Along the rod the contact moves by int (rod - string) dt, their Fig. 8(b): steep where it slips, level where it sticks, and
// slightly rising where it creeps.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/friction/slip_phases.hpp>

#include <limits>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One slip, its flanks included; forces and velocities counted the way the rod moves.
struct slip_loop {
  sample_interval at;  ///< from the last sample before to the first after, where it all but sticks
  double begin_s = 0, end_s = 0;
  double from_m = 0, to_m = 0;  ///< places on the rod; to_m < from_m: the string overtook the rod
  double fastest_m_s = 0;       ///< rod less string
  double onset_N = 0;           ///< largest force until the slip has half its speed
  double recapture_N = 0;       ///< force at the last sample
  double range_N = 0;           ///< largest less smallest force
  double area_W = 0;            ///< of the whole loop, signed, see above; N m/s
  double fast_area_W = 0;       ///< of its part beyond three quarters of fastest_m_s
  double dissipated_J = 0;
  double stuck_s = 0, crept_m = 0;  ///< since the slip before; from the first known sample for the first

  [[nodiscard]] double duration_s() const noexcept { return end_s - begin_s; }
  [[nodiscard]] double distance_m() const noexcept { return to_m - from_m; }
  /// Force while it gathers speed less force while it loses it, mean over the fastest quarter of speeds.
  [[nodiscard]] double split_N() const noexcept { return fast_area_W / (0.25 * std::abs(fastest_m_s)); }
};

enum class loop_sense { none, counter_clockwise, clockwise };

/// The loops of a take together, fast slips counting more.
struct loop_verdict {
  std::size_t loops = 0;         ///< that were counted
  double split_N = 0, sd_N = 0;  ///< mean split and its standard error, from how the loops differ
  double range_N = 0;            ///< mean range of the force
  loop_sense sense = loop_sense::none;
};

/// Place of the contact on the rod, m: 0 at the first known sample, NaN where the relative velocity is unknown.
[[nodiscard]] inline std::vector<double> track_along(std::span<const double> relative_m_s, double rate_Hz) {
  std::vector<double> place(relative_m_s.size(), std::numeric_limits<double>::quiet_NaN());
  double at = 0, before = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < place.size(); ++i) {
    const double v = relative_m_s[i];
    if (std::isfinite(v) && std::isfinite(before)) at -= (before + v) / (2 * rate_Hz);
    if (std::isfinite(v)) place[i] = at;
    before = v;
  }
  return place;
}

namespace detail {

/// A slip with its flanks: outwards as long as its speed above the level falls and stays above nothing.
[[nodiscard]] inline sample_interval with_flanks(const sample_interval& core, std::span<const double> relative_m_s,
                                                 double level) {
  double mean = 0;
  for (std::size_t i = core.begin; i < core.end; ++i) mean += relative_m_s[i] - level;
  const double side = mean < 0 ? -1.0 : 1.0;
  const auto height = [&](std::size_t i) { return side * (relative_m_s[i] - level); };
  sample_interval wide = core;
  const auto falls = [&](std::size_t from, std::size_t to) {
    return std::isfinite(relative_m_s[to]) && height(from) > 0 && height(to) < height(from);
  };
  while (wide.begin > 0 && falls(wide.begin, wide.begin - 1)) --wide.begin;
  while (wide.end < relative_m_s.size() && falls(wide.end - 1, wide.end)) ++wide.end;
  return wide;
}

/// Where on the rod each slip lies, and what was before it: `free` is the sample from which it has stuck.
inline void place_loops(std::vector<slip_loop>& loops, const std::vector<double>& track, double way, std::size_t free,
                        double rate_Hz) {
  const auto seconds = [&](std::size_t i) { return static_cast<double>(i) / rate_Hz; };
  for (auto& s : loops) {
    const std::size_t last = s.at.end - 1, since = std::min(free, s.at.begin);
    s.begin_s = seconds(s.at.begin), s.end_s = seconds(last);
    s.from_m = way * track[s.at.begin], s.to_m = way * track[last];
    s.stuck_s = s.begin_s - seconds(since), s.crept_m = s.from_m - way * track[since];
    free = last;
  }
}

/// Signed area of the polygon of points (x, y), closed, as far as it lies at x >= from.
[[nodiscard]] inline double area_beyond(std::span<const double> x, std::span<const double> y, double from) {
  double area = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::size_t next = i + 1 < x.size() ? i + 1 : 0;
    double x0 = x[i] - from, x1 = x[next] - from, y0 = y[i], y1 = y[next];
    if (x0 < 0 && x1 < 0) continue;
    const double crossing = x0 < 0 || x1 < 0 ? y0 + (y1 - y0) * x0 / (x0 - x1) : 0.0;
    if (x0 < 0) x0 = 0, y0 = crossing;
    if (x1 < 0) x1 = 0, y1 = crossing;
    area += (x0 * y1 - x1 * y0) / 2;  // what runs along x = from adds nothing
  }
  return area;
}

/// Everything about one slip but its places on the rod. way: the sign of the rod's speed.
inline void measure_loop(slip_loop& s, std::span<const double> force_N, std::span<const double> relative_m_s, double way,
                         double rate_Hz) {
  std::vector<double> behind, force;
  for (std::size_t i = s.at.begin; i < s.at.end; ++i) behind.push_back(-way * relative_m_s[i]), force.push_back(way * force_N[i]);
  const auto [low, high] = std::minmax_element(behind.begin(), behind.end());
  s.fastest_m_s = -*low > *high ? *low : *high;
  const double side = s.fastest_m_s < 0 ? -1.0 : 1.0;  // of the abscissa: x = -behind
  for (double& b : behind) b *= side;
  s.area_W = -side * area_beyond(behind, force, *std::min_element(behind.begin(), behind.end()));
  s.fast_area_W = -side * area_beyond(behind, force, 0.75 * side * s.fastest_m_s);
  const auto [least, most] = std::minmax_element(force.begin(), force.end());
  s.range_N = *most - *least;
  s.onset_N = force.front();
  for (std::size_t k = 0; k < force.size() && behind[k] <= 0.5 * side * s.fastest_m_s; ++k)
    s.onset_N = std::max(s.onset_N, force[k]);
  s.recapture_N = force.back();
  for (std::size_t k = 0; k + 1 < force.size(); ++k)
    s.dissipated_J += side * (force[k] * behind[k] + force[k + 1] * behind[k + 1]) / (2 * rate_Hz);
}

}  // namespace detail

/// Force on the string, surface (or centre) less rod, and their phases, all of one record. Left out: slips that reach into what
/// is unknown, for they have no onset or no end, and what stays below `least_share` of the fastest slip: a band limit makes a
/// slip ring before and after itself.
[[nodiscard]] inline std::vector<slip_loop> slip_loops(std::span<const double> force_N, std::span<const double> relative_m_s,
                                                       const contact_phases& phases, double rod_speed_m_s, double rate_Hz,
                                                       double least_share = 0.05) {
  const double way = rod_speed_m_s < 0 ? -1.0 : 1.0;
  const auto known = [&](std::size_t i) {
    return i < relative_m_s.size() && std::isfinite(relative_m_s[i]) && std::isfinite(force_N[i]);
  };
  std::vector<slip_loop> out;
  double fastest = 0;
  for (const auto& core : phases.slips) {
    if (core.begin == 0 || !known(core.begin - 1) || !known(core.end)) continue;
    slip_loop s;
    s.at = detail::with_flanks(core, relative_m_s, phases.level_m_s);
    detail::measure_loop(s, force_N, relative_m_s, way, rate_Hz);
    fastest = std::max(fastest, std::abs(s.fastest_m_s));
    out.push_back(s);
  }
  std::erase_if(out, [&](const slip_loop& s) { return !(std::abs(s.fastest_m_s) > least_share * fastest); });
  detail::place_loops(out, track_along(relative_m_s, rate_Hz), way, phases.sticks.empty() ? 0 : phases.sticks.front().begin,
                      rate_Hz);
  return out;
}

/// Over the slips against the rod's way that last for `shortest_s` (of the shorter ones a band limit draws the shape: five
/// periods of its end are enough) and are at least 0.3 times as fast as the fastest; what is slower may be the string's rolling.
/// A sense is called where the split is more than chance (three standard errors) and more than `least` of the force's range: of
/// 120 strokes on 60 rigs drawn at random (random_rig.hpp) those with a velocity curve split by up to 0.04 of it, those with
/// thermal friction by 0.13 and more.
[[nodiscard]] inline loop_verdict judge_loops(std::vector<slip_loop> loops, double shortest_s = 0, double least = 0.08) {
  double fastest = 0, area = 0, width = 0, spread = 0;
  for (const auto& s : loops) fastest = std::max(fastest, s.fastest_m_s);
  std::erase_if(loops, [&](const slip_loop& s) {
    return !(s.fastest_m_s > 0 && s.fastest_m_s >= 0.3 * fastest && s.duration_s() >= shortest_s);
  });
  loop_verdict v{.loops = loops.size()};
  const auto n = static_cast<double>(loops.size());
  for (const auto& s : loops) area += s.fast_area_W, width += 0.25 * s.fastest_m_s, v.range_N += s.range_N / n;
  if (loops.empty()) return v;
  v.split_N = area / width;
  for (const auto& s : loops) spread += std::pow(s.fast_area_W - v.split_N * 0.25 * s.fastest_m_s, 2);
  v.sd_N = n > 1 ? std::sqrt(spread * n / (n - 1)) / width : std::numeric_limits<double>::infinity();
  if (std::abs(v.split_N) > std::max(least * v.range_N, 3 * v.sd_N))
    v.sense = v.split_N > 0 ? loop_sense::counter_clockwise : loop_sense::clockwise;
  return v;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
