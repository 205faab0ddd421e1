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
// in phase, which a good pluck can tell apart. Where the loss disperses (loss_law) w_n is shifted with it; that such a string also
// rings 1 / (pi Q) stronger against what holds it still is no affair of modes, and left out (a fit then finds 0.995 to 0.998 of the
// dispersion).
//
// An end that resists turning with the moment k y' has `clamping` k / (k + sqrt(B T)), 0 pinned, 1 clamped. With q^2 and -kappa^2
// the roots of B r^2 - T r = m w^2 the modes are then, but for e^(-kappa L),
//
//     sin(q x - a) + sin(a) e^(-kappa x) +- sin(a') e^(-kappa (L - x)),    q L = n pi + a + a',    B (q^2 + kappa^2) sin a = k (q cos a - kappa sin a).
//
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include <rosin/propagate/string_parameters.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Where the loss of a mode sits: in a drag on the string's motion, or in its elastic stress.
enum class damping_convention { viscous, kelvin_voigt };

/// The string's twist, by its ratios to the transverse motion. A speed ratio of zero: the string does not turn.
struct modal_torsion {
  double speed_ratio = 0;      ///< torsional / transverse wave speed
  double impedance_ratio = 0;  ///< torsional, referred to the surface, / transverse impedance
  double quality = 15;         ///< of all torsional modes
  bool causal = false;         ///< modes lie wider than harmonics, as a loss alike at all frequencies asks for (Kjartansson 1979)

  [[nodiscard]] bool present() const noexcept { return speed_ratio > 0 && impedance_ratio > 0; }
};

/// How unevenly modes lose: ln 1/Q of mode n is off by a normal deviate of its own.
struct uneven_loss {
  double scatter = 0;  ///< its standard deviation; 0: as the law says
  std::uint64_t seed = 0;

  [[nodiscard]] double factor(int n) const noexcept {
    return scatter == 0 ? 1.0 : std::exp(scatter * deviate(seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(n)));
  }

private:
  /// Bits mixed as by splitmix64 (Steele, Lea & Flood 2014), evenly in (0, 1).
  [[nodiscard]] static double evenly(std::uint64_t z) noexcept {
    z += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return (static_cast<double>((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
  }
  [[nodiscard]] static double deviate(std::uint64_t key) noexcept {
    constexpr double pi = 3.14159265358979323846;
    return std::sqrt(-2 * std::log(evenly(2 * key))) * std::cos(2 * pi * evenly(2 * key + 1));
  }
};

/// The mechanical part of a rig with rigid terminations.
struct modal_rig {
  string_parameters string{};
  modal_torsion torsion{};
  damping_convention damping = damping_convention::viscous;
  uneven_loss uneven{};  ///< of the string's modes
};

/// One mode: a damped oscillator whose free motion goes as exp(pole() t).
struct string_mode {
  int number = 1;              ///< n, from 1
  double omega_rad_s = 0;      ///< undamped
  double inverse_quality = 0;  ///< 1 / Q, below 2
  double mass_kg = 0;
  double end_stiffness_N_m = 0;       ///< force on the near end for q = 1 m
  double far_over_near = 1;           ///< the same for the far end, but for the parity
  std::array<double, 2> ahead_rad{};  ///< a and a', where the ends resist turning
  double near_fields = 0;             ///< kappa L, there

  [[nodiscard]] std::complex<double> pole() const noexcept {
    const double half = inverse_quality / 2;
    return omega_rad_s * std::complex<double>{-half, std::sqrt(1 - half * half)};
  }
  /// sin(k_n x) at x = position L.
  [[nodiscard]] double shape(double position) const noexcept {
    constexpr double pi = 3.14159265358979323846;
    if (near_fields == 0) return std::sin(pi * std::fmod(number * position, 2.0));
    return std::sin((number * pi + ahead_rad[0] + ahead_rad[1]) * position - ahead_rad[0]) +
           std::sin(ahead_rad[0]) * std::exp(-near_fields * position) +
           parity() * std::sin(ahead_rad[1]) * std::exp(-near_fields * (1 - position));
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
    modes.push_back({n, omega * std::exp(string.loss.quickening(omega / (2 * pi))), string.loss.inverse_q(omega / (2 * pi)),
                     string.linear_density_kg_m() * string.length_m / 2, string.tension_N * k * (1 + stiff)});
  }
}

namespace detail {

/// The n-th mode of a stiff string whose ends resist turning; number, omega, Q, mass and forces.
[[nodiscard]] inline string_mode clamped_mode(const string_parameters& string, const std::array<double, 2>& clamping, int n) {
  constexpr double pi = 3.14159265358979323846;
  const double L = string.length_m, T = string.tension_N, B = string.bending_stiffness_Nm2, still = std::sqrt(T / B);
  double q = n * pi / L, kappa = still;
  string_mode m{.number = n};
  for (int i = 0; i < 60; ++i) {
    kappa = std::hypot(q, still);
    for (std::size_t e = 0; e < 2; ++e)
      m.ahead_rad[e] =
          std::atan2(clamping[e] * still * q, (1 - clamping[e]) * (q * q + kappa * kappa) + clamping[e] * still * kappa);
    const double next = (n * pi + m.ahead_rad[0] + m.ahead_rad[1]) / L;
    if (std::abs(next - q) < 1e-15 * q) break;
    q = next;
  }
  m.near_fields = kappa * L;
  m.omega_rad_s = string.wave_speed_m_s() * q * std::sqrt(1 + B * q * q / T);
  m.inverse_quality = string.loss.inverse_q(m.omega_rad_s / (2 * pi));
  m.omega_rad_s *= std::exp(string.loss.quickening(m.omega_rad_s / (2 * pi)));
  std::array<double, 2> force{};
  double square = L / 2;  // of the shape, over the length
  for (std::size_t e = 0; e < 2; ++e) {
    const double s = std::sin(m.ahead_rad[e]), c = std::cos(m.ahead_rad[e]);
    square += -s * c / (2 * q) + 2 * s * (q * c - kappa * s) / (q * q + kappa * kappa) + s * s / (2 * kappa);
    force[e] = T * (q * c - kappa * s) + B * (q * q * q * c + kappa * kappa * kappa * s);
  }
  m.mass_kg = string.linear_density_kg_m() * square;
  m.end_stiffness_N_m = force[0], m.far_over_near = force[1] / force[0];
  return m;
}

}  // namespace detail

/// Transverse modes up to a frequency, of a stiff string whose ends resist turning.
[[nodiscard]] inline std::vector<string_mode> transverse_modes(const string_parameters& string, double limit_Hz,
                                                               const std::array<double, 2>& clamping) {
  if (clamping == std::array<double, 2>{} || !(string.bending_stiffness_Nm2 > 0)) return transverse_modes(string, limit_Hz);
  std::vector<string_mode> modes;
  for (int n = 1;; ++n) {
    modes.push_back(detail::clamped_mode(string, clamping, n));
    if (!(modes.back().omega_rad_s <= 2 * 3.14159265358979323846 * limit_Hz)) return modes.pop_back(), modes;
  }
}

/// The same of a rig, whose modes may lose unevenly.
[[nodiscard]] inline std::vector<string_mode> transverse_modes(const modal_rig& rig, double limit_Hz,
                                                               const std::array<double, 2>& clamping = {}) {
  std::vector<string_mode> modes = transverse_modes(rig.string, limit_Hz, clamping);
  for (string_mode& m : modes) m.inverse_quality *= rig.uneven.factor(m.number);
  return modes;
}

/// Forces on near and far end for a steady 1 N at `position`, likewise: an end takes clamping sqrt(B / T) from the length.
[[nodiscard]] inline std::array<double, 2> static_end_forces(const string_parameters& string, double position,
                                                             const std::array<double, 2>& clamping) noexcept {
  const double reach = std::sqrt(string.bending_stiffness_Nm2 / string.tension_N) / string.length_m;
  const double far = (position - clamping[0] * reach) / (1 - (clamping[0] + clamping[1]) * reach);
  return {1 - far, far};
}

/// Torsional modes up to a frequency; their displacement is that of the string's surface. They push no end sideways.
[[nodiscard]] inline std::vector<string_mode> torsional_modes(const modal_rig& rig, double limit_Hz) {
  constexpr double pi = 3.14159265358979323846;
  std::vector<string_mode> modes;
  if (!rig.torsion.present()) return modes;
  const double speed = rig.torsion.speed_ratio * rig.string.wave_speed_m_s();
  const double density = rig.torsion.impedance_ratio * rig.string.impedance_Ns_m() / speed;
  const double power = rig.torsion.causal ? 1 / (1 - 1 / (pi * rig.torsion.quality)) : 1;
  for (int n = 1; n * speed / (2 * rig.string.length_m) <= limit_Hz; ++n)
    modes.push_back({n, std::pow(n, power) * pi * speed / rig.string.length_m, 1 / rig.torsion.quality,
                     density * rig.string.length_m / 2, 0});
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

#include <rosin/core/macros_back.ipp>
