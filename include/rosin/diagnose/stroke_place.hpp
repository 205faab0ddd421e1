// tier: hosted
// SPDX-License-Identifier: MIT
//
// Was a stroke made where the plucks were? A rod seldom touches exactly where the wire was. What comes from one end and what comes
// from the other tell the same motion only if both delays are those of the place of contact, so that the two versions of the
// force (Eq. (3) of the paper) part least there. A change of tension stretches both delays alike, another place takes from one
// what it gives to the other: neither stands for the other.
//
#pragma once

#include <rosin/diagnose/tension_drift.hpp>

#include <cmath>

namespace rosin {

/// The calibration at another place (fraction of the length from the near end).
[[nodiscard]] inline calibration at_place(calibration c, double position) {
  const double one_way_s = c.at.delay_s[0] + c.at.delay_s[1];
  c.position = position, c.at.delay_s = {position * one_way_s, (1 - position) * one_way_s};
  return c;
}

/// Where the two versions part least, and by how much: Eq. (12).
struct stroke_place {
  double position = 0, delta = 1;
};

/// Searched within `doubt` of `around` (fractions of the length); delta(position) is Eq. (12) of the take reconstructed there. At the
/// edge of what was searched nothing is found: delta is 1.
template <class Delta>
[[nodiscard]] stroke_place search_stroke_place(Delta&& delta, double around, double doubt) {
  constexpr double valley = 0.0005;  // is some times as wide
  const int steps = static_cast<int>(std::ceil(doubt / valley));
  const auto [position, delta_there] = detail::least_around(delta, around, steps, doubt / steps);
  if (!(std::abs(position - around) < doubt)) return {position, 1};
  return {position, delta_there};
}

}  // namespace rosin
