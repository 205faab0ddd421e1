// tier: hosted
// SPDX-License-Identifier: MIT
//
// Stretches of samples that no sensor delivers: not a number, held at the rail of a converter or amplifier, or frozen in
// the middle of a motion. `step` is one step of the converter in the unit of the samples, 0 for floating point.
//
// A smooth maximum is flat for some samples too (within one step), but it is entered and left slowly; a rail is hit at
// speed. A frozen stretch counts only if so many equal samples in a row are improbable in this signal, if the signal moves
// before and after, and if it is entered and left at speed or by a jump.
//
#pragma once

#include <rosin/core/finite_math.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct sample_span {
  std::size_t first = 0, count = 0;
  [[nodiscard]] std::size_t end() const noexcept { return first + count; }
};

/// Stretches in which test(index) holds.
template <class Test>
[[nodiscard]] std::vector<sample_span> spans_where(std::size_t size, Test test) {
  std::vector<sample_span> out;
  for (std::size_t i = 0; i < size; ++i) {
    if (!test(i)) continue;
    if (!out.empty() && out.back().end() == i) ++out.back().count;
    else out.push_back({i, 1});
  }
  return out;
}

[[nodiscard]] inline std::vector<sample_span> not_finite(const std::vector<double>& x) {
  return spans_where(x.size(), [&](std::size_t i) { return !std::isfinite(x[i]); });
}

namespace detail {

/// How far the sample beside the span lies from its value: before and after; 0 at the ends of the record.
[[nodiscard]] inline std::pair<double, double> edge_jumps(const std::vector<double>& x, const sample_span& s) noexcept {
  const double before = s.first > 0 ? std::abs(x[s.first] - x[s.first - 1]) : 0.0;
  const double after = s.end() < x.size() ? std::abs(x[s.end()] - x[s.end() - 1]) : 0.0;
  return {before, after};
}

/// Median of |x[i+1] - x[i]| over [first, last); 0 where it is empty.
[[nodiscard]] inline double median_movement(const std::vector<double>& x, std::size_t first, std::size_t last) {
  std::vector<double> moves;
  for (std::size_t i = first; i + 1 < last; ++i) moves.push_back(std::abs(x[i + 1] - x[i]));
  if (moves.empty()) return 0;
  const auto middle = moves.begin() + static_cast<std::ptrdiff_t>(moves.size() / 2);
  std::nth_element(moves.begin(), middle, moves.end());
  return *middle;
}

/// Rails in one direction: sign +1 or -1.
[[nodiscard]] inline std::vector<sample_span> rails(const std::vector<double>& x, double sign, double step, double full_scale) {
  double top = -1e300;
  for (const double v : x) top = std::max(top, sign * v);
  auto spans = spans_where(x.size(), [&](std::size_t i) { return sign * x[i] >= top - step / 2; });
  const bool at_full_scale = step > 0 && top >= full_scale - 1.5 * step;
  if (at_full_scale) {
    std::size_t samples = 0;
    for (const auto& s : spans) samples += s.count;
    return samples >= 3 ? spans : std::vector<sample_span>{};
  }
  std::erase_if(spans, [&](const sample_span& s) {
    const auto [before, after] = edge_jumps(x, s);
    return s.count < 3 || std::min(before, after) <= 6 * step;
  });
  return spans.size() >= 3 ? spans : std::vector<sample_span>{};
}

}  // namespace detail

/// Standard deviation of white noise in the first `count` samples, from their differences: a level, hum or drift under
/// it does not count.
[[nodiscard]] inline double noise_in(const std::vector<double>& x, std::size_t count) noexcept {
  double square = 0;
  const std::size_t last = std::min(count, x.size());
  for (std::size_t i = 1; i < last; ++i) square += (x[i] - x[i - 1]) * (x[i] - x[i - 1]);
  return last > 1 ? std::sqrt(square / (2 * static_cast<double>(last - 1))) : 0.0;
}

/// Where the signal is cut off at its largest or smallest value, at full scale or below it.
[[nodiscard]] inline std::vector<sample_span> clipped(const std::vector<double>& x, double step, double full_scale) {
  auto out = detail::rails(x, 1, step, full_scale);
  const auto low = detail::rails(x, -1, step, full_scale);
  out.insert(out.end(), low.begin(), low.end());
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return out;
}

namespace detail {

/// The share of samples that equal their predecessor, long runs left out: how often a repeat happens by chance.
[[nodiscard]] inline double chance_of_repeat(const std::vector<double>& x, const std::vector<sample_span>& runs) noexcept {
  double repeats = 0, samples = static_cast<double>(x.size());
  for (const auto& r : runs) {
    if (r.count < 4) repeats += static_cast<double>(r.count);
    else samples -= static_cast<double>(r.count);
  }
  return samples > 0 ? repeats / samples : 1.0;
}

/// The span is entered and left in a way that the motion around it does not explain.
[[nodiscard]] inline bool is_frozen(const std::vector<double>& x, const sample_span& s, double step, double chance) {
  constexpr std::size_t around = 64;
  constexpr double repeat_share = 0.27;  // normal differences of median size m: so many m-ths of a step are rounded to none
  if (s.first == 0 || s.end() >= x.size()) return false;
  const double before = median_movement(x, s.first > around ? s.first - around : 0, s.first);
  const double after = median_movement(x, s.end(), std::min(x.size(), s.end() + around));
  const double least = std::min(before, after), most = std::max(before, after);
  if (least <= 0 || least < 2 * step) return false;
  const auto [in, out] = edge_jumps(x, s);
  const bool zeroed = x[s.first] == 0.0 && s.count >= 2 && std::min(in, out) >= 8 * most;
  const double chance_here = std::max(chance, repeat_share * step / least);
  const double by_chance = static_cast<double>(x.size()) * std::pow(chance_here, static_cast<double>(s.count - 1));
  const bool jumps = s.count >= 4 && std::max(in, out) >= std::max(3 * most, 6 * step);
  const bool cut_short = s.count >= 8 && std::min(in, out) >= std::max(0.3 * least, 6 * step);
  return zeroed || (by_chance < 1e-3 && (jumps || cut_short));
}

}  // namespace detail

/// Where samples were lost: the last value held, or zeros put in their place. What was cut off is held by that.
[[nodiscard]] inline std::vector<sample_span> dropouts(const std::vector<double>& x, double step,
                                                       const std::vector<sample_span>& cut = {}) {
  auto repeats = spans_where(x.size(), [&](std::size_t i) { return i > 0 && x[i] == x[i - 1]; });
  const double chance = detail::chance_of_repeat(x, repeats);
  if (chance > 0.2) return {};  // a signal without noise repeats itself anyway
  for (auto& r : repeats) r = {r.first - 1, r.count + 1};
  std::erase_if(repeats, [&](const sample_span& s) {
    return !detail::is_frozen(x, s, step, chance) ||
           std::any_of(cut.begin(), cut.end(), [&](const sample_span& c) { return c.first < s.end() && s.first < c.end(); });
  });
  return repeats;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
