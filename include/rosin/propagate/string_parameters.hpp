// tier: freestanding
// SPDX-License-Identifier: MIT
//
// What the library has to know of a string. All else (wave speed, impedance, inharmonicity) follows.
//
#pragma once

#include <rosin/core/finite_math.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace rosin {

/// How far a loss is from a constant, relatively, as no law of it is exact: a series in u = ln(f / reference),
///
///     r(u) = sum_m cosine_m cos(m u) + sine_m sin(m u),     m = 1, 2, 3, 4.
///
/// A modulus M ~ 1 + i / Q that is causal has with each term another one in its real part: (i w)^(i m) is causal, and its imaginary
/// part is tanh(m pi / 2) of its real part and a quarter of a period aside. Relaxations whose times lie a factor of five apart are such a loss
/// (r of a hundredth, m = 3.9).
struct loss_unevenness {
  static constexpr int orders = 4;
  std::array<double, orders> cosine{}, sine{};

  [[nodiscard]] bool is_there() const noexcept {
    bool any = false;
    for (std::size_t i = 0; i < orders; ++i) any = any || cosine[i] != 0 || sine[i] != 0;
    return any;
  }
  /// r(u)
  [[nodiscard]] double operator()(double u) const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < orders; ++i) sum += cosine[i] * std::cos(order(i) * u) + sine[i] * std::sin(order(i) * u);
    return sum;
  }
  /// What it adds to 2 ln c, per 1/Q, from u = 0 on.
  [[nodiscard]] double quickening(double u) const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < orders; ++i)
      sum += coth[i] * (cosine[i] * std::sin(order(i) * u) + sine[i] * (1 - std::cos(order(i) * u)));
    return sum;
  }
  /// d quickening / d u
  [[nodiscard]] double dispersion(double u) const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < orders; ++i)
      sum += order(i) * coth[i] * (cosine[i] * std::cos(order(i) * u) + sine[i] * std::sin(order(i) * u));
    return sum;
  }

private:
  static double order(std::size_t i) noexcept { return static_cast<double>(i + 1); }
  static constexpr std::array<double, orders> coth{1.09033141072737, 1.00374187319732, 1.00016140009466,
                                                   1.00000697468471};  // of m pi / 2
};

/// 1/Q of the transverse modes against frequency: a constant, a part that grows with frequency (internal
/// friction), the drag of the air in its boundary layer (Valette 1995), and a drag as the velocity:
///
///     1/Q(f) = (1 + r) / quality + internal_s f + air_sqrt_Hz / sqrt(f) + drag_Hz / f
///
/// with r = 0 but where a fit says otherwise (loss_unevenness).
///
/// What loses and is causal disperses: by Kramers and Kronig d ln c / d ln f = 1 / (pi Q) for a constant Q, and what the air
/// takes comes with as much inertia; the parts with f and 1/f disperse in second order only. Modes that are damped one by one
/// do not disperse at all; `causality` says how much of it there is. Where there is any, what is uneven is due to relaxations and
/// disperses in full: a string that loses by half to these is uneven by half as much.
struct loss_law {
  double quality = std::numeric_limits<double>::infinity();  ///< > 0; infinity: no constant part
  double internal_s = 0;                                     ///< s, >= 0
  double air_sqrt_Hz = 0;                                    ///< Hz^(1/2), >= 0
  double causality = 0;                                      ///< 0: phase as without loss; 1: as causality asks of that loss
  double drag_Hz = 0;       ///< also what is not lost for want of relaxations that are slower still
  double reference_Hz = 1;  ///< > 0; where the string's wave speed is that without loss
  loss_unevenness uneven{};

  /// 1/Q at a frequency; both drags are left out at 0 Hz.
  [[nodiscard]] double inverse_q(double frequency_Hz) const noexcept {
    const double f = std::abs(frequency_Hz);
    const double even = 1 / quality + internal_s * f + (f > 0 ? air_sqrt_Hz / std::sqrt(f) + drag_Hz / f : 0.0);
    return f > 0 && uneven.is_there() ? even + uneven(std::log(f / reference_Hz)) / quality : even;
  }
  /// What causality adds to the phase, of w t: c(reference_Hz) / c(f) - 1.
  [[nodiscard]] double lead(double frequency_Hz) const noexcept { return std::expm1(-quickening(frequency_Hz)); }
  /// ln of the wave speed over that at reference_Hz; 0 at 0 Hz.
  [[nodiscard]] double quickening(double frequency_Hz) const noexcept {
    constexpr double pi = 3.14159265358979323846;
    const double f = std::abs(frequency_Hz);
    if (causality == 0 || f == 0) return 0;
    const double air = air_sqrt_Hz / 2 * (1 / std::sqrt(reference_Hz) - 1 / std::sqrt(f));
    const double u = std::log(f / reference_Hz), more = uneven.is_there() ? uneven.quickening(u) / 2 : 0.0;
    return causality * (u / pi / quality + air) + more / quality;
  }

  /// d ln c / d ln f, what quickening grows by.
  [[nodiscard]] double dispersion(double frequency_Hz) const noexcept {
    constexpr double pi = 3.14159265358979323846;
    const double f = std::abs(frequency_Hz);
    if (causality == 0 || f == 0) return 0;
    const double more = uneven.is_there() ? uneven.dispersion(std::log(f / reference_Hz)) / 2 : 0.0;
    return causality * (1 / pi / quality + air_sqrt_Hz / (4 * std::sqrt(f))) + more / quality;
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
