// tier: hosted
// SPDX-License-Identifier: MIT
//
// Whether what was reconstructed of a stroke can be one: a rod that drags a string along holds it at the rod's own speed most of the
// time, lets it slip, and can pull no harder than friction allows. What contradicts that is mostly a value in another unit, a scale
// of a channel, or an amplifier that drifts; where a power of ten would put it right, the value that goes with it is said.
//
//     velocity while it sticks = rod,   |force| <= 1.5 N,   mean force of a period constant while rod and N are
//
// A friction coefficient of rosin is 0.2 to 1.3 (Smith & Woodhouse, J. Mech. Phys. Solids 48, 2000).
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/number_text.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rosin {

/// One take, from when the rod moves to when it is lifted.
struct stroke_view {
  std::span<const double> force_N, velocity_m_s, rod_m_s;  ///< of the string's surface, where that is known
  std::optional<double> normal_force_N;
  double period_samples = 0;
  std::size_t slips = 0;
  bool level_known = true;    ///< false: the sensors are AC coupled
  bool normal_steady = true;  ///< false: it is known to change
};

struct stroke_doubt {
  std::string kind;  ///< "no-slip", "speed-contradicts", "force-contradicts", "drifting-level"
  std::string what;
};

namespace detail {

/// The value below which this share lies; values that are no numbers do not count.
[[nodiscard]] inline double share_below(std::vector<double> values, double share) {
  std::erase_if(values, [](double x) { return !std::isfinite(x); });
  if (values.empty()) return std::nan("");
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

[[nodiscard]] inline std::string doubt_digits(double x) { return number_text(x, "%.3g"); }

/// "; with `key` = value it would be ...", where a power of ten brings the ratio to `low` ... `high`.
[[nodiscard]] inline std::string likely_power(const std::string& key, double value, double ratio, double low, double high) {
  const double power = std::round(std::log10(ratio / std::sqrt(low * high))), mended = ratio / std::pow(10.0, power);
  if (power == 0 || mended < low || mended > high) return {};
  return "; with " + key + " = " + doubt_digits(value * std::pow(10.0, power)) + " it would be " + doubt_digits(mended);
}

inline void doubt_speed(const stroke_view& s, std::vector<stroke_doubt>& out) {
  std::vector<double> ratio;
  double rod = 0;
  for (std::size_t i = 0; i < s.rod_m_s.size(); ++i) {
    if (std::abs(s.rod_m_s[i]) > 0) ratio.push_back(s.velocity_m_s[i] / s.rod_m_s[i]);
    if (std::abs(s.rod_m_s[i]) > std::abs(rod)) rod = s.rod_m_s[i];
  }
  if (rod == 0) return;
  const double sticking = share_below(ratio, 0.75);  // it sticks for longer than it slips
  const bool contradicts = !(sticking > 1.0 / 3 && sticking < 3);
  if (contradicts)
    out.push_back({"speed-contradicts", "for a quarter of the time the string runs at " + doubt_digits(sticking) +
                                            " times the speed of the rod, " + doubt_digits(rod) +
                                            " m/s, or more; a string that sticks runs at that speed" +
                                            (sticking > 0 ? likely_power("a speed", rod, sticking, 0.5, 2) : std::string{})});
  if (s.slips == 0)
    out.push_back(
        {"no-slip", std::string{"no slip was found: the string "} +
                        (contradicts ? "never reaches the rod's speed, or never leaves it" : "follows the rod all the time") +
                        "; check speed, normal force, contact and gains"});
}

inline void doubt_force(const stroke_view& s, std::vector<stroke_doubt>& out) {
  if (!s.normal_force_N || !(*s.normal_force_N > 0)) return;
  constexpr double most = 1.5, least = 0.12;
  std::vector<double> size{s.force_N.begin(), s.force_N.end()};
  if (s.level_known)
    for (double& f : size) f = std::abs(f);
  const double strongest = share_below(size, 0.995) - (s.level_known ? 0.0 : share_below(size, 0.005)),
               ratio = strongest / *s.normal_force_N;
  const bool too_much = ratio > (s.level_known ? most : 2 * most), too_little = s.level_known && ratio < least;
  if (!too_much && !too_little) return;
  out.push_back({"force-contradicts", std::string{s.level_known ? "the force reaches " : "the force varies by "} +
                                          doubt_digits(strongest) + " N, with a normal force of " +
                                          doubt_digits(*s.normal_force_N) + " N: " + doubt_digits(ratio) +
                                          " of it, where friction of rosin allows 0.2 to 1.3" +
                                          likely_power("a normal force", *s.normal_force_N, ratio, 0.2, 1.5) +
                                          "; check normal_force_N, force_N of the plucks, and newtons_per_full_scale"});
}

/// The straight line through the mean of each period, over the last three fifths: what heats up or is set on has settled by then.
inline void doubt_level(const stroke_view& s, std::vector<stroke_doubt>& out) {
  constexpr std::size_t least_periods = 24;
  if (!s.normal_steady || !(s.period_samples >= 2)) return;
  std::vector<double> means;
  const auto n = static_cast<double>(s.force_N.size()), from = 0.4 * n;
  for (double at = from; at + s.period_samples <= n; at += s.period_samples) {
    const auto begin = static_cast<std::size_t>(at), end = static_cast<std::size_t>(at + s.period_samples);
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += s.force_N[i] / static_cast<double>(end - begin);
    if (std::isfinite(sum)) means.push_back(sum);
  }
  if (means.size() < least_periods) return;
  const auto count = static_cast<double>(means.size());
  double mean = 0, slope = 0, rest = 0, squares = 0;
  for (const double m : means) mean += m / count;
  for (std::size_t j = 0; j < means.size(); ++j) {
    const double t = static_cast<double>(j) - (count - 1) / 2;
    slope += t * (means[j] - mean), squares += t * t;
  }
  slope /= squares;
  for (std::size_t j = 0; j < means.size(); ++j)
    rest += std::pow(means[j] - mean - slope * (static_cast<double>(j) - (count - 1) / 2), 2) / count;
  std::vector<double> size{s.force_N.begin() + static_cast<std::ptrdiff_t>(from), s.force_N.end()};
  const double range = share_below(size, 0.995) - share_below(size, 0.005), change = slope * count,
               doubt = std::sqrt(rest * 12 / count);
  const double scale = s.normal_force_N.value_or(range);
  if (std::abs(change) < 0.15 * scale || std::abs(change) < 6 * doubt) return;
  out.push_back({"drifting-level", "the mean of the force drifts by " + doubt_digits(change) + " N, from " +
                                       doubt_digits(mean - change / 2) + " to " + doubt_digits(mean + change / 2) + " N over " +
                                       doubt_digits(count) +
                                       " periods, while speed and normal force are declared as constant: an amplifier that "
                                       "drifts, or a normal force that changes"});
}

}  // namespace detail

/// What cannot be so, most telling first.
[[nodiscard]] inline std::vector<stroke_doubt> doubts_of_stroke(const stroke_view& s) {
  std::vector<stroke_doubt> out;
  detail::doubt_speed(s, out);
  detail::doubt_force(s, out);
  detail::doubt_level(s, out);
  return out;
}

}  // namespace rosin
