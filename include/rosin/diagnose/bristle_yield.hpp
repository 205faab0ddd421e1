// tier: hosted
// SPDX-License-Identifier: MIT
//
// Bristles that bend also let go bit by bit, long before the string slips. Of the speed v of the rod relative to the string the
// part 1 - p bends them and p is flow: z' = v (1 - p). With f = s0 z, as it is while they bend slowly, p is known from the force
// alone (elasto_plastic.hpp, with z / z_ss = f / (mu N)):
//
//     LuGre           p = sgn(v z) |f| / (mu N)
//     elasto-plastic  p = alpha |f| / (mu N) where v z > 0 and |f| > elastic mu N, alpha half a sine from there to mu N; else 0
//
// so the surface moves faster than the bristles' spring says, by 1 / (1 - p). The faster it moves, the lower the limit, to first
// order mu / (1 + weakening v); v follows from z' and p.
//
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct bristle_yield {
  double limit = 0;          ///< mu: force / normal force at which nothing bends any more; 0: they only bend
  double elastic = at_once;  ///< share of the limit up to which they only bend; at_once: none, and they flow both ways (LuGre)

  double weakening_s_m = 0;  ///< of the limit, by the speed

  static constexpr double at_once = -1;
  static constexpr double most = 0.8;  ///< p is not followed beyond it: there the string slips

  /// v / z' under a force; `bending_m_s`: z'.
  [[nodiscard]] double faster(double force_N, double normal_force_N, double bending_m_s) const noexcept {
    if (!(limit > 0) || !(normal_force_N > 0)) return 1;
    const double share = std::abs(force_N) / (limit * normal_force_N), speed = weakening_s_m * std::abs(bending_m_s);
    const bool loads = force_N * bending_m_s > 0;
    double out = 1 / (1 - flow(share, loads));
    for (int i = 0; i < (speed > 0 ? 3 : 0); ++i) out = 1 / (1 - flow(share * (1 + speed * out), loads));
    return out;
  }

private:
  [[nodiscard]] double flow(double share, bool loads) const noexcept {
    if (elastic < 0) return loads ? std::min(share, most) : -share;
    if (!loads || share <= elastic) return 0;
    const double alpha = share < 1 ? 0.5 * (1 + std::sin(std::numbers::pi * (share - 0.5 * (1 + elastic)) / (1 - elastic))) : 1.0;
    return std::min(alpha * share, most);
  }
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
