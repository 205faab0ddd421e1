// tier: freestanding
// SPDX-License-Identifier: MIT
//
// What the library has to know of a string. All else (wave speed, impedance, inharmonicity) follows.
//
#pragma once

#include <cmath>
#include <limits>

namespace rosin {

/// 1/Q of the transverse modes against frequency: a constant, a part that grows with frequency (internal
/// friction) and the drag of the air in its boundary layer (Valette 1995):
///
///     1/Q(f) = 1/quality + internal_s f + air_sqrt_Hz / sqrt(f)
struct loss_law {
  double quality = std::numeric_limits<double>::infinity();  ///< > 0; infinity: no constant part
  double internal_s = 0;                                     ///< s, >= 0
  double air_sqrt_Hz = 0;                                    ///< Hz^(1/2), >= 0

  /// 1/Q at a frequency; the air's part is left out at 0 Hz.
  [[nodiscard]] double inverse_q(double frequency_Hz) const noexcept {
    const double f = std::abs(frequency_Hz);
    return 1 / quality + internal_s * f + (f > 0 ? air_sqrt_Hz / std::sqrt(f) : 0.0);
  }
};

/// A uniform stiff string between two terminations.
struct string_parameters {
  double length_m = 0;
  double tension_N = 0;
  double fundamental_Hz = 0;         ///< c / (2 L): pitch of the string without its stiffness
  double bending_stiffness_Nm2 = 0;  ///< B; zero for an ideal string
  loss_law loss{};

  [[nodiscard]] double wave_speed_m_s() const noexcept { return 2 * length_m * fundamental_Hz; }
  [[nodiscard]] double impedance_Ns_m() const noexcept { return tension_N / wave_speed_m_s(); }
  [[nodiscard]] double linear_density_kg_m() const noexcept { return impedance_Ns_m() / wave_speed_m_s(); }

  /// epsilon = B m / T^2 in s^2: all that stiffness does to a wave in time, K(w) = (sqrt(1 + 4 epsilon w^2) - 1) / 2.
  [[nodiscard]] double stiffness_s2() const noexcept {
    return bending_stiffness_Nm2 / (tension_N * wave_speed_m_s() * wave_speed_m_s());
  }
  /// pi^2 B / (T L^2): mode n lies at n f0 sqrt(1 + inharmonicity n^2) between pinned ends.
  [[nodiscard]] double inharmonicity() const noexcept {
    constexpr double pi = 3.14159265358979323846;
    return pi * pi * bending_stiffness_Nm2 / (tension_N * length_m * length_m);
  }
};

}  // namespace rosin
