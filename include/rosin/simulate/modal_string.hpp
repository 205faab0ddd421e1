// tier: hosted
// SPDX-License-Identifier: MIT
//
// The modes of a stiff string between pinned ends, and of its twist between fixed ends. Mode n has the shape
// sin(k_n x), k_n = n pi / L, the mass m L / 2 and the undamped frequency w_n = c k_n sqrt(1 + B k_n^2 / T);
// it obeys
//
//     q'' + (w_n / Q_n) q' + w_n^2 q = f sin(k_n x_b) / (m L / 2)
//
// and pushes the near end with (T k_n + B k_n^3) q, the far end with (-1)^(n+1) times that. A second
// convention of damping puts the loss into the elastic stress (Kelvin and Voigt): the motion is the same, but
// the ends then also feel the stress that belongs to q' / (w_n Q_n). At equal Q the two differ by a turn of 1 / Q
// in phase, which a good pluck can tell apart.
//
#pragma once

#include <cmath>
#include <complex>
#include <vector>

#include <rosin/propagate/string_parameters.hpp>

namespace rosin {

/// Where the loss of a mode sits: in a drag on the string's motion, or in its elastic stress.
enum class damping_convention { viscous, kelvin_voigt };

/// The string's twist, by its ratios to the transverse motion. A speed ratio of zero: the string does not turn.
struct modal_torsion {
  double speed_ratio = 0;      ///< torsional / transverse wave speed
  double impedance_ratio = 0;  ///< torsional, referred to the surface, / transverse impedance
  double quality = 15;         ///< of all torsional modes

  [[nodiscard]] bool present() const noexcept { return speed_ratio > 0 && impedance_ratio > 0; }
};

/// The mechanical part of a rig with rigid terminations.
struct modal_rig {
  string_parameters string{};
  modal_torsion torsion{};
  damping_convention damping = damping_convention::viscous;
};

/// One mode: a damped oscillator whose free motion goes as exp(pole() t).
struct string_mode {
  int number = 1;              ///< n, from 1
  double omega_rad_s = 0;      ///< undamped
  double inverse_quality = 0;  ///< 1 / Q, below 2
  double mass_kg = 0;
  double end_stiffness_N_m = 0;  ///< force on the near end for q = 1 m

  [[nodiscard]] std::complex<double> pole() const noexcept {
    const double half = inverse_quality / 2;
    return omega_rad_s * std::complex<double>{-half, std::sqrt(1 - half * half)};
  }
  /// sin(k_n x) at x = position L.
  [[nodiscard]] double shape(double position) const noexcept {
    constexpr double pi = 3.14159265358979323846;
    return std::sin(pi * std::fmod(number * position, 2.0));
  }
  /// +1 or -1: force on the far end against force on the near end.
  [[nodiscard]] double parity() const noexcept { return number % 2 == 1 ? 1.0 : -1.0; }
};

/// Transverse modes up to a frequency.
[[nodiscard]] inline std::vector<string_mode> transverse_modes(const string_parameters& string, double limit_Hz) {
  constexpr double pi = 3.14159265358979323846;
  std::vector<string_mode> modes;
  for (int n = 1;; ++n) {
    const double k = n * pi / string.length_m;
    const double stiff = string.bending_stiffness_Nm2 * k * k / string.tension_N;
    const double omega = string.wave_speed_m_s() * k * std::sqrt(1 + stiff);
    if (!(omega <= 2 * pi * limit_Hz)) return modes;
    modes.push_back({n, omega, string.loss.inverse_q(omega / (2 * pi)), string.linear_density_kg_m() * string.length_m / 2,
                     string.tension_N * k * (1 + stiff)});
  }
}

/// Torsional modes up to a frequency; their displacement is that of the string's surface. They push no end sideways.
[[nodiscard]] inline std::vector<string_mode> torsional_modes(const modal_rig& rig, double limit_Hz) {
  constexpr double pi = 3.14159265358979323846;
  std::vector<string_mode> modes;
  if (!rig.torsion.present()) return modes;
  const double speed = rig.torsion.speed_ratio * rig.string.wave_speed_m_s();
  const double density = rig.torsion.impedance_ratio * rig.string.impedance_Ns_m() / speed;
  for (int n = 1; n * speed / (2 * rig.string.length_m) <= limit_Hz; ++n)
    modes.push_back({n, n * pi * speed / rig.string.length_m, 1 / rig.torsion.quality, density * rig.string.length_m / 2, 0});
  return modes;
}

/// Static deflection at the contact for 1 N there, m/N: the sum over all modes in closed form.
[[nodiscard]] inline double static_compliance_m_N(const string_parameters& string, double position) noexcept {
  const double near = position * string.length_m, far = string.length_m - near;
  if (!(string.bending_stiffness_Nm2 > 0)) return near * far / (string.length_m * string.tension_N);
  const double kappa = std::sqrt(string.tension_N / string.bending_stiffness_Nm2);
  const double a = std::expm1(-2 * kappa * near), b = std::expm1(-2 * kappa * far);
  const double bend = a * b / (-2 * kappa * std::expm1(-2 * kappa * (near + far)));  // sinh sinh / (kappa sinh)
  return (near * far / string.length_m - bend) / string.tension_N;
}

/// What the modes above a limit add to it.
[[nodiscard]] inline double residual_compliance_m_N(const string_parameters& string, double position, double limit_Hz) {
  double residual = static_compliance_m_N(string, position);
  for (const auto& mode : transverse_modes(string, limit_Hz))
    residual -= std::pow(mode.shape(position) / mode.omega_rad_s, 2) / mode.mass_kg;
  return residual;
}

}  // namespace rosin
