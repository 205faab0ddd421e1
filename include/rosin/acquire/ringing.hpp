// tier: hosted
// SPDX-License-Identifier: MIT
//
// Does the string ring, at which pitch and for how long? The pitch is the comb n f0 sqrt(1 + B n^2) that explains the
// strongest lines best: the share of their amplitude that falls on a tooth, times the square root of the share of the
// teeth (up to the highest line) that are there. Half the pitch leaves teeth empty, twice the pitch leaves lines
// unexplained. The declared pitch is kept wherever it does nearly as well as the best.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/math/spectrum_line.hpp>

#include <limits>
#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct ringing {
  double pitch_Hz = 0;     ///< of the comb, without stiffness
  double score = 0;        ///< 0 ... 1: how well the comb explains the lines
  double at_declared = 0;  ///< the same for a comb at the declared pitch
};

namespace detail {

struct partial_comb {
  std::span<const spectrum_line> lines;
  double inharmonicity;
  double tolerance;  ///< relative
  double floor_Hz;   ///< absolute, the width of a bin

  [[nodiscard]] double tooth(double pitch, int n) const noexcept { return pitch * n * std::sqrt(1 + inharmonicity * n * n); }
  [[nodiscard]] bool on_tooth(double f, double pitch, int n) const noexcept {
    return n >= 1 && std::abs(f - tooth(pitch, n)) < std::min(std::max(tolerance * f, floor_Hz), 0.25 * pitch);
  }
  [[nodiscard]] double score(double pitch) const {
    double all = 0, explained = 0, highest = 0;
    std::vector<bool> found;
    for (const auto& line : lines) {
      const int n = static_cast<int>(std::lround(line.frequency_Hz / pitch));
      all += line.amplitude;
      if (!on_tooth(line.frequency_Hz, pitch, n)) continue;
      explained += line.amplitude;
      highest = std::max(highest, line.frequency_Hz);
      if (found.size() < static_cast<std::size_t>(n)) found.resize(static_cast<std::size_t>(n), false);
      found[static_cast<std::size_t>(n - 1)] = true;
    }
    const auto teeth = static_cast<double>(std::count(found.begin(), found.end(), true));
    return found.empty() ? 0.0 : explained / all * std::sqrt(teeth / static_cast<double>(found.size()));
  }
  /// Median pitch of the lines that lie on the comb, weak ones left out.
  [[nodiscard]] double refined(double pitch) const {
    std::vector<double> votes;
    for (const auto& line : lines) {
      const int n = static_cast<int>(std::lround(line.frequency_Hz / pitch));
      if (on_tooth(line.frequency_Hz, pitch, n)) votes.push_back(line.frequency_Hz / tooth(1, n));
    }
    if (votes.empty()) return pitch;
    std::sort(votes.begin(), votes.end());
    return votes[votes.size() / 2];
  }
};

}  // namespace detail

/// Empty where the stretch is shorter than eight periods of the declared pitch or holds no lines.
template <class = void>
[[nodiscard]] std::optional<ringing> find_ringing(std::span<const double> x, double sample_rate_Hz, double declared_Hz,
                                                  double inharmonicity) {
  if (static_cast<double>(x.size()) * declared_Hz < 8 * sample_rate_Hz) return std::nullopt;
  const auto lines =
      strongest_lines(x, sample_rate_Hz, declared_Hz / 3.5, std::min(0.45 * sample_rate_Hz, 9.5 * declared_Hz), 16);
  if (lines.empty()) return std::nullopt;
  const detail::partial_comb comb{lines, inharmonicity, 0.012, 1.5 * sample_rate_Hz / static_cast<double>(x.size())};
  ringing best{};
  for (const double step : {-0.02, -0.01, 0.0, 0.01, 0.02}) {
    const double score = comb.score(declared_Hz * (1 + step));
    if (score > best.at_declared) best = {declared_Hz * (1 + step), score, score};
  }
  for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 8); ++i)
    for (int n = 1; n <= 6; ++n) {
      const double pitch = lines[i].frequency_Hz / comb.tooth(1, n), score = comb.score(pitch);
      if (pitch > declared_Hz / 3.5 && score > std::max(best.score, 1.25 * best.at_declared))
        best = {pitch, score, best.at_declared};
    }
  best.pitch_Hz = comb.refined(best.pitch_Hz);
  return best;
}
ROSIN_INSTANTIATE(std::optional<ringing> find_ringing(std::span<const double>, double, double, double))

/// Q of the ringing's power as a whole at the given pitch, from a straight line through the logarithm of the power of
/// stretches of a few periods each, down to 1 % of the strongest. Infinity where it does not decay; empty if too short.
[[nodiscard]] inline std::optional<double> find_quality(std::span<const double> x, double sample_rate_Hz, double pitch_Hz) {
  const double periods = static_cast<double>(x.size()) * pitch_Hz / sample_rate_Hz;
  const auto block = static_cast<std::size_t>(std::round(sample_rate_Hz / pitch_Hz * std::max(1.0, std::floor(periods / 64))));
  std::vector<double> level;
  double strongest = 0;
  for (std::size_t i = 0; block > 1 && i + block <= x.size(); i += block) {
    double mean = 0, power = 0;
    for (std::size_t k = i; k < i + block; ++k) mean += x[k] / static_cast<double>(block);
    for (std::size_t k = i; k < i + block; ++k) power += (x[k] - mean) * (x[k] - mean) / static_cast<double>(block);
    strongest = std::max(strongest, power);
    if (power < 0.01 * strongest) break;
    level.push_back(std::log(power));
  }
  if (level.size() < 2) return strongest > 0 && periods > 3 ? std::optional{3.0} : std::nullopt;
  const double n = static_cast<double>(level.size());
  double slope = 0;
  for (std::size_t i = 0; i < level.size(); ++i) slope += (static_cast<double>(i) - (n - 1) / 2) * level[i];
  slope *= 12 / (n * (n * n - 1));  // per block
  const double per_period = slope * sample_rate_Hz / (pitch_Hz * static_cast<double>(block));
  return per_period < 0 ? -6.28318530717958647692 / per_period : std::numeric_limits<double>::infinity();
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
