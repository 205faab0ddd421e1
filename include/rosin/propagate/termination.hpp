// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a string ends on. A termination moves with the velocity V = Y F under the force F of the string on it; all that the string
// has to know is its admittance relative to the string's impedance,
//
//     z(w) = Z Y(w),      rigid: 0,      modes: sum_k (Z / M_k) s / (s^2 + s w_k / Q_k + w_k^2),  s = i w
//
// and, from that, the reflection of velocity waves R = -(1 - z)/(1 + z). An admittance is passive where
// Re z >= 0. Measured admittances and reflection functions: termination_table.hpp.
//
#pragma once

#include <rosin/math/plain_complex.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <concepts>
#include <numbers>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A termination: relative admittance Z Y at a frequency in Hz, and how long it rings (s, to a thousandth; 0: not at all).
template <class E>
concept Termination = requires(const E& end, double frequency_Hz) {
  { end.relative_admittance(frequency_Hz) } -> std::convertible_to<std::complex<double>>;
  { end.memory_s() } -> std::convertible_to<double>;
};

/// Does not move.
struct rigid_termination {
  [[nodiscard]] constexpr std::complex<double> relative_admittance(double) const noexcept { return 0; }
  [[nodiscard]] constexpr double memory_s() const noexcept { return 0; }
};

/// One mode of a termination: a damped mass on a spring.
struct admittance_mode {
  double frequency_Hz = 0, q = 1;
  double per_mass_per_s = 0;  ///< Z / M: 0 is rigid

  [[nodiscard]] std::complex<double> operator()(std::complex<double> s) const noexcept {
    const double w = 2 * std::numbers::pi * frequency_Hz, loss = w / q, x = s.real(), y = s.imag();
    const double re = x * (x + loss) - y * y + w * w, im = y * (2 * x + loss);
    const double scale = per_mass_per_s / (re * re + im * im);
    return {scale * (x * re + y * im), scale * (y * re - x * im)};
  }
  /// What it yields under a steady force, Z / K: as much as so many seconds of string.
  [[nodiscard]] double compliance_s() const noexcept { return per_mass_per_s / std::pow(2 * std::numbers::pi * frequency_Hz, 2); }
  /// The pole with the positive imaginary part; of two real ones the slower.
  [[nodiscard]] std::complex<double> pole() const noexcept {
    const double w = 2 * std::numbers::pi * frequency_Hz;
    return w * (-0.5 / q + std::sqrt(std::complex<double>(0.25 / (q * q) - 1)));
  }
};

/// A damper beside a spring, with a mass that hardly counts: Z Y = conductance s / (s + 2 pi corner) below R / M (1/s).
/// conductance: Z / R; corner: K / (2 pi R), at most a hundredth of R / M.
[[nodiscard]] inline admittance_mode overdamped_mode(double conductance, double corner_Hz,
                                                     double without_mass_1_s = 2e7) noexcept {
  const double soft_1_s = 2 * std::numbers::pi * corner_Hz;
  return {std::sqrt(soft_1_s * without_mass_1_s) / (2 * std::numbers::pi), std::sqrt(soft_1_s / without_mass_1_s),
          conductance * without_mass_1_s};
}

/// A sum of modes. Passive as long as no mass is negative.
struct modal_termination {
  std::vector<admittance_mode> modes;

  [[nodiscard]] std::complex<double> relative_admittance(double frequency_Hz) const noexcept {
    return at({0, 2 * std::numbers::pi * frequency_Hz});
  }
  [[nodiscard]] std::complex<double> at(std::complex<double> s) const noexcept {
    std::complex<double> sum = 0;
    for (const admittance_mode& m : modes) sum += m(s);
    return sum;
  }
  [[nodiscard]] double memory_s() const noexcept {
    double longest = 0;
    for (const admittance_mode& m : modes) longest = std::max(longest, std::log(1e3) / -m.pole().real());
    return longest;
  }
};

static_assert(Termination<rigid_termination> && Termination<modal_termination>);

/// Reflection of velocity waves at a termination, for the frequency domain: a ReflectionFunction (periodic_reconstruction.hpp).
template <Termination End>
struct reflection_of_end {
  End end;
  [[nodiscard]] std::complex<double> operator()(double frequency_Hz) const {
    const std::complex<double> z = end.relative_admittance(frequency_Hz);
    return (z - 1.0) / (z + 1.0);
  }
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
