// tier: hosted
// SPDX-License-Identifier: MIT
//
// A lump on the string that takes part in its motion: mass, damper and spring in parallel. With v its velocity at the end of a
// step h and the two before it, and y where it is,
//
//     f + alpha v = -beta,     alpha = 3 M / 2h + R + K h / 2,     v' = (3 v - 4 v_0 + v_-1) / 2h,
//
// the trapezoidal rule for y, the difference of second order for v'.
//
#pragma once

#include <utility>

namespace rosin {

/// Mass, damper and spring in parallel, at one point of the string.
struct point_load {
  double position = 0.5;  ///< distance from the near end / length
  double mass_kg = 0, resistance_Ns_m = 0, stiffness_N_m = 0;
};

struct moving_load {
  point_load load;
  double v = 0, v_before = 0, y = 0;

  [[nodiscard]] double alpha(double h) const noexcept {
    return 1.5 * load.mass_kg / h + load.resistance_Ns_m + load.stiffness_N_m * h / 2;
  }
  [[nodiscard]] double beta(double h) const noexcept {
    return load.mass_kg * (v_before - 4 * v) / (2 * h) + load.stiffness_N_m * (y + h * v / 2);
  }
  /// Ends the step with this velocity.
  void move(double h, double now) noexcept {
    y += h * (v + now) / 2;
    v_before = std::exchange(v, now);
  }
};

}  // namespace rosin
