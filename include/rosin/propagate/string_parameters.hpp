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
/// friction), the drag of the air in its boundary layer (Valette 1995), and a drag as the velocity:
///
///     1/Q(f) = 1/quality + internal_s f + air_sqrt_Hz / sqrt(f) + drag_Hz / f
///
/// What loses and is causal disperses: by Kramers and Kronig d ln c / d ln f = 1 / (pi Q) for a constant Q, and what the air
/// takes comes with as much inertia; the parts with f and 1/f disperse in second order only. Modes that are damped one by one
/// do not disperse at all; `causality` says how much of it there is.
struct loss_law {
  double quality = std::numeric_limits<double>::infinity();  ///< > 0; infinity: no constant part
  double internal_s = 0;                                     ///< s, >= 0
  double air_sqrt_Hz = 0;                                    ///< Hz^(1/2), >= 0
  double causality = 0;                                      ///< 0: phase as without loss; 1: as causality asks of that loss
  double drag_Hz = 0;       ///< also what is not lost for want of relaxations that are slower still
  double reference_Hz = 1;  ///< > 0; where the string's wave speed is that without loss

  /// 1/Q at a frequency; both drags are left out at 0 Hz.
  [[nodiscard]] double inverse_q(double frequency_Hz) const noexcept {
    const double f = std::abs(frequency_Hz);
    return 1 / quality + internal_s * f + (f > 0 ? air_sqrt_Hz / std::sqrt(f) + drag_Hz / f : 0.0);
  }
  /// What causality adds to the phase, of w t: c(reference_Hz) / c(f) - 1.
  [[nodiscard]] double lead(double frequency_Hz) const noexcept { return std::expm1(-quickening(frequency_Hz)); }
  /// ln of the wave speed over that at reference_Hz; 0 at 0 Hz.
  [[nodiscard]] double quickening(double frequency_Hz) const noexcept {
    constexpr double pi = 3.14159265358979323846;
    const double f = std::abs(frequency_Hz);
    if (causality == 0 || f == 0) return 0;
    const double air = air_sqrt_Hz / 2 * (1 / std::sqrt(reference_Hz) - 1 / std::sqrt(f));
    return causality * (std::log(f / reference_Hz) / (pi * quality) + air);
  }

  /// d ln c / d ln f, what quickening grows by.
  [[nodiscard]] double dispersion(double frequency_Hz) const noexcept {
    constexpr double pi = 3.14159265358979323846;
    const double f = std::abs(frequency_Hz);
    if (causality == 0 || f == 0) return 0;
    return causality * (1 / (pi * quality) + air_sqrt_Hz / (4 * std::sqrt(f)));
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
