// tier: hosted
// SPDX-License-Identifier: MIT
//
// Lines in a recording that are no partials of the string: harmonics of the mains, which are steady, and other strings that ring
// along at pitches of their own. They are sought in what the string's own lines leave over. A line counts where its power is far
// above the median of its surroundings (partial_search.hpp); one at a multiple of 50 or 60 Hz counts as hum where it is as strong
// in the second half as in the first.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pickup_ringing.hpp>
#include <rosin/math/spectrum_line.hpp>

#include <functional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct stray_line {
  double frequency_Hz = 0, amplitude = 0;  ///< peak, in the channel's unit
  double over_floor = 0;                   ///< power against the noise around
  double change = 1;                       ///< amplitude in the second half / in the first
};

struct stray_lines {
  double mains_Hz = 0;  ///< 0: no hum
  std::vector<stray_line> hum, others;
  double resolution_Hz = 0;
};

namespace detail {

inline stray_line seen_at(std::span<const double> x, double rate_Hz, const peak_finder& peaks, const peak_finder::peak& p) {
  const auto amplitude = [&](std::span<const double> of) { return amplitude_at(hann_windowed(of), p.frequency_Hz, rate_Hz); };
  const std::size_t half = x.size() / 2;
  const double first = amplitude(x.first(half)), second = amplitude(x.subspan(half));
  return {p.frequency_Hz, amplitude(x), p.power / peaks.floor_at(p.frequency_Hz), second / std::max(first, 1e-300)};
}

/// The mains' harmonics that stand out and are steady.
inline void find_hum(std::span<const double> x, double rate_Hz, const peak_finder& peaks, const std::function<bool(double)>& free,
                     stray_lines& out) {
  double most = 60;
  for (const double base : {50.0, 60.0}) {
    std::vector<stray_line> found;
    double sum = 0, pitch = 0;
    for (int h = 1; h <= 12; ++h) {
      const double reach = 0.003 * base * h + peaks.bin_Hz();
      const auto p = peaks.strongest(base * h - reach, base * h + reach);
      if (!p || !free(p->frequency_Hz)) continue;
      const stray_line line = seen_at(x, rate_Hz, peaks, *p);
      if (line.change < 0.6 || line.change > 1.6) continue;
      found.push_back(line);
      sum += line.over_floor, pitch += line.over_floor * line.frequency_Hz / h;
    }
    if (sum > most) most = sum, out.mains_Hz = pitch / sum, out.hum = found;
  }
}

}  // namespace detail

/// `own`: frequencies of the string's partials, each with `near_Hz` around it out of bounds. Precondition: a second of sound or
/// so.
template <class = void>
[[nodiscard]] stray_lines find_strays(std::span<const double> residual, double rate_Hz, const std::vector<double>& own,
                                      double near_Hz, double highest_Hz) {
  const detail::peak_finder peaks{residual, rate_Hz, 60};
  stray_lines out;
  out.resolution_Hz = 4 * peaks.bin_Hz();
  const auto off = [&](double f, double by_Hz) {
    return std::none_of(own.begin(), own.end(), [&](double g) { return std::abs(f - g) < std::max(by_Hz, out.resolution_Hz); });
  };
  const auto free = [&](double f) { return off(f, near_Hz); };
  detail::find_hum(
      residual, rate_Hz, peaks, [&](double f) { return off(f, near_Hz / 3); }, out);  // as its frequencies are known
  for (double f = 30; f < highest_Hz; f += 4) {
    const auto p = peaks.strongest(f, f + 4);
    if (!p || !free(p->frequency_Hz) || p->power < 60 * peaks.floor_at(p->frequency_Hz)) continue;
    if (out.mains_Hz > 0 &&
        std::abs(p->frequency_Hz - out.mains_Hz * std::round(p->frequency_Hz / out.mains_Hz)) < out.resolution_Hz)
      continue;
    if (!out.others.empty() && std::abs(out.others.back().frequency_Hz - p->frequency_Hz) < out.resolution_Hz) continue;
    const stray_line line = detail::seen_at(residual, rate_Hz, peaks, *p);
    if (line.change > 0.02 && line.change < 5) out.others.push_back(line);
  }
  std::sort(out.others.begin(), out.others.end(), [](const auto& a, const auto& b) { return a.over_floor > b.over_floor; });
  if (out.others.size() > 12) out.others.resize(12);
  return out;
}
ROSIN_INSTANTIATE(stray_lines find_strays(std::span<const double>, double, const std::vector<double>&, double, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
