// tier: hosted
// SPDX-License-Identifier: MIT
//
// The scale that the ends of a string cannot tell each other: while the string sticks, its surface moves as the rod does, and the rod's
// speed was measured. So what was reconstructed from forces F in nominal newtons and a nominal impedance Z,
//
//     v = F_j (1/D_j - D_j) / (2 Z_w) + near field + torsion,
//
// has to be multiplied by the one factor that makes it the rod's speed: that of F / Z. In each take it is the inverse of the median of
// v / v_rod over what sticks, inside of it: a slip leaves to one side and would draw a mean along. Which samples stick depends on the
// factor, so both are found in turn. What the takes scatter by says how sure it is.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/friction/slip_phases.hpp>
#include <rosin/math/median.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One take: velocity of the string's surface under the rod, as reconstructed, and the rod's, measured. Equally long.
struct moving_surface {
  std::span<const double> surface_m_s, rod_m_s;
  double rate_Hz = 0, edge_Hz = 0;  ///< edge of the band: what it smears a slip by
};

struct sticking_scale {
  double factor = 1;             ///< of F / Z
  double sd = 0;                 ///< of the factor
  std::vector<double> per_take;  ///< not a number where the string hardly sticks
  std::vector<double> sticking;  ///< share of each take's steady part
};

namespace detail {

/// Factor and share of one take; none where less than a tenth of the steady part sticks.
struct sticking_take {
  std::optional<double> factor;
  double share = 0;
};
[[nodiscard]] inline sticking_take scale_of_take(const moving_surface& take) {
  double top = 0;
  for (const double v : take.rod_m_s)
    if (std::isfinite(v)) top = std::abs(v) > std::abs(top) ? v : top;
  std::vector<double> steady;
  for (const double v : take.rod_m_s)
    if (std::isfinite(v) && v * top > 0.5 * top * top) steady.push_back(v);
  if (steady.empty()) return {};
  const double speed = median_of(steady);
  const auto margin = static_cast<std::size_t>(std::ceil(0.7 * take.rate_Hz / take.edge_Hz));
  const std::size_t n = std::min(take.surface_m_s.size(), take.rod_m_s.size());
  std::vector<double> relative(n);
  sticking_take found;
  double factor = 1;
  for (int pass = 0; pass < 6; ++pass) {
    for (std::size_t i = 0; i < n; ++i) {
      const bool at_speed = std::abs(take.rod_m_s[i] / speed - 1) < 0.1;
      relative[i] =
          at_speed ? factor * take.surface_m_s[i] / take.rod_m_s[i] * speed - speed : std::numeric_limits<double>::quiet_NaN();
    }
    const contact_phases phases = find_phases(relative, speed, {.least = 0.05, .most = 0.3});
    const std::vector<char> inside = interior(phases.sticks, n, margin);
    std::vector<double> ratio;
    for (std::size_t i = 0; i < n; ++i)
      if (inside[i]) ratio.push_back(take.surface_m_s[i] / take.rod_m_s[i]);
    found.share = phases.sticking();
    if (ratio.size() < 50 || 10 * ratio.size() < phases.known) return {std::nullopt, found.share};
    factor = 1 / median_of(ratio);
  }
  found.factor = factor;
  return found;
}

}  // namespace detail

/// Fails where no take sticks.
[[nodiscard]] inline outcome<sticking_scale> scale_from_sticking(const std::vector<moving_surface>& takes) {
  sticking_scale out;
  std::vector<double> found;
  for (const moving_surface& take : takes) {
    const detail::sticking_take one = detail::scale_of_take(take);
    out.per_take.push_back(one.factor.value_or(std::numeric_limits<double>::quiet_NaN()));
    out.sticking.push_back(one.share);
    if (one.factor) found.push_back(*one.factor);
  }
  if (found.empty())
    return failure{"the string sticks in none of the strokes: the scale of the force over the impedance cannot be had"};
  out.factor = median_of(found);
  std::vector<double> off;
  for (const double f : found) off.push_back(std::abs(f / out.factor - 1));
  // of a median; a single take is taken at its word to half a per cent
  out.sd = out.factor * (found.size() < 3 ? 5e-3 : 1.25 * 1.4826 * median_of(off) / std::sqrt(static_cast<double>(found.size())));
  return out;
}

/// Impedance from length, tension and pitch, which is all that tells it: Z = T / (2 L f0). Relative standard deviation beside it.
struct told_impedance {
  double value_Ns_m = 0, relative_sd = 0;
};
[[nodiscard]] inline told_impedance impedance_of(double length_m, double length_relative_sd, double tension_N,
                                                 double tension_relative_sd, double fundamental_Hz,
                                                 double fundamental_relative_sd) noexcept {
  return {tension_N / (2 * length_m * fundamental_Hz),
          std::hypot(std::hypot(length_relative_sd, tension_relative_sd), fundamental_relative_sd)};
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
