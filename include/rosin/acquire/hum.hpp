// tier: hosted
// SPDX-License-Identifier: MIT
//
// Mains hum: a line at 50 or 60 Hz (or at two of their harmonics) that stands out of what lies beside it. Each line is the
// least-squares sinusoid under a Hann window; the lines are many bins apart, so that they do not disturb each other.
// Harmonics that coincide with a partial of the string are left out.
//
#pragma once

#include <rosin/math/spectrum_line.hpp>

#include <array>
#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct hum_estimate {
  double frequency_Hz = 0;  ///< 50 or 60
  double amplitude = 0;     ///< of the fundamental
  std::vector<spectrum_line> lines;
};

namespace detail {

/// A local maximum of the amplitude within the mains' tolerance, clear of its neighbourhood.
[[nodiscard]] inline std::optional<spectrum_line> mains_line(const std::vector<double>& windowed, double rate, double nominal) {
  const double bin = rate / static_cast<double>(windowed.size());
  const auto at = [&](double f) { return amplitude_at(windowed, f, rate); };
  const double reach = std::max(0.01 * nominal, 0.6 * bin);
  spectrum_line best{};
  for (int i = -8; i <= 8; ++i) {
    const double f = nominal + reach * i / 8;
    if (const double a = at(f); a > best.amplitude) best = {f, a};
  }
  if (std::abs(best.frequency_Hz - nominal) > 0.9 * reach) return std::nullopt;
  std::array<double, 4> beside{at(nominal - 3.3 * bin), at(nominal - 2.6 * bin), at(nominal + 2.6 * bin),
                               at(nominal + 3.3 * bin)};
  std::sort(beside.begin(), beside.end());
  if (best.amplitude < 5 * beside[2]) return std::nullopt;
  return best;
}

[[nodiscard]] inline hum_estimate hum_at(const std::vector<double>& windowed, double rate, double mains, double string_Hz) {
  const double bin = rate / static_cast<double>(windowed.size());
  hum_estimate out{mains, 0, {}};
  for (int k = 1; k <= 5; ++k) {
    const double f = mains * k, nearest = std::max(1.0, std::round(f / string_Hz)) * string_Hz;
    if (std::abs(f - nearest) < std::max(6 * bin, 0.03 * f) || f > rate / 4) continue;
    const auto line = mains_line(windowed, rate, f);
    if (!line) continue;
    out.lines.push_back(*line);
    if (k == 1) out.amplitude = line->amplitude;
  }
  return out;
}

}  // namespace detail

/// What the mains add, if it shows. Needs five periods of it; string_Hz: the string's fundamental, if it sounds.
[[nodiscard]] inline std::optional<hum_estimate> find_hum(std::span<const double> x, double sample_rate_Hz, double string_Hz) {
  if (static_cast<double>(x.size()) < sample_rate_Hz / 10) return std::nullopt;
  const auto windowed = detail::hann_windowed(x);
  std::optional<hum_estimate> best;
  double strongest = 0;
  for (const double mains : {50.0, 60.0}) {
    auto found = detail::hum_at(windowed, sample_rate_Hz, mains, string_Hz);
    if (found.amplitude <= 0 && found.lines.size() < 2) continue;
    double sum = 0;
    for (const auto& line : found.lines) sum += line.amplitude;
    if (sum > strongest) best = std::move(found);
    strongest = std::max(strongest, sum);
  }
  return best;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
