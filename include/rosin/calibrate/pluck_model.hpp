// tier: hosted
// SPDX-License-Identifier: MIT
//
// A pluck in closed form. A force F at x_p holds the string aside until it vanishes at t0. Between pinned ends the modes of a
// stiff string are sines, each rings down by itself, and the forces on the terminations are exactly
//
//     before t0:  F_near = F (1 - p),                       F_far = F p,             p = x_p / L
//     after:      F_near = F sum_n  2/(n pi) sin(n pi p)    Re{ (1 + i psi/(2 Q_n)) exp(s_n (t - t0)) },
//                 F_far  = the same with (-1)^(n+1),
//     s_n = w_n (-1/(2 Q_n) + i sqrt(1 - 1/(4 Q_n^2))),     w_n = 2 pi n f0 sqrt(1 + b n^2),   b = pi^2 B / (T L^2).
//
// Stiffness enters through the pitch of the partials alone: near field and force factor are
// contained in it, since q_n (T k_n + B k_n^3) with q_n = 2 F sin(k_n x_p) / (L (T k_n^2 + B k_n^4)) leaves 2 F sin / (L k_n).
// That this is the inverse transform of sin(k x)/(G sin(k L)) is checked in the tests.
//
// psi is what conventions of damping differ in, all else being equal: -1 for a viscous force on each mode (no force at the
// ends from it), +1 where the loss is in the elastic stress (and is felt by the ends). It is a nuisance of order 1/Q and is
// fitted.
//
// Where loss is causal (loss_law) the partials are dispersed, and ring 1 / (1 - d ln c / d ln w) stronger against what the wire held:
// the residue's slope is that of the wavenumber, and held was the string as it is at rest.
//
// A band-limited recording sees partial n with the weight W(s_n / (2 pi i)): what a filter does to a line that decays is its
// response at a complex frequency, which on the band's flank is a turn in phase. Around t0 itself nothing has arrived at the ends
// yet.
//
#pragma once

#include <rosin/calibrate/damped_lines.hpp>
#include <rosin/propagate/band.hpp>
#include <rosin/propagate/string_parameters.hpp>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A string as its plucks reveal it.
struct ringing_string {
  double fundamental_Hz = 0;  ///< c / (2 L), without stiffness
  double inharmonicity = 0;   ///< b = pi^2 B / (T L^2)
  loss_law loss{};
  double convention = -1;  ///< psi

  /// Frequency of partial n >= 1, without damping but with what that disperses.
  [[nodiscard]] double partial_Hz(int n) const noexcept {
    return dispersed(n * fundamental_Hz * std::sqrt(std::max(0.0, 1 + inharmonicity * n * n)));
  }
  /// Where causal loss takes a partial: f = lossless f c(f) / c_ref, in two steps.
  [[nodiscard]] double dispersed(double lossless_Hz) const noexcept {
    return lossless_Hz * std::exp(loss.quickening(lossless_Hz * std::exp(loss.quickening(lossless_Hz))));
  }
  /// epsilon = B m / T^2, s^2: b / (2 pi f0)^2.
  [[nodiscard]] double stiffness_s2() const noexcept {
    const double w = 2 * std::numbers::pi * fundamental_Hz;
    return inharmonicity / (w * w);
  }
};

/// Forces on {near, far} before the release, per newton of F. `longer`: by how much more string either end counts that yields
/// (less where it holds the string against turning), fractions of the length.
[[nodiscard]] inline std::array<double, 2> static_forces(double position, const std::array<double, 2>& longer = {}) noexcept {
  const double far = (position + longer[0]) / (1 + longer[0] + longer[1]);
  return {1 - far, far};
}

/// The band's window (band.hpp) at the complex frequency of a pole: what it makes of exp(pole t).
[[nodiscard]] inline std::complex<double> band_weight(const band& limits, std::complex<double> pole) noexcept {
  const std::complex<double> f = std::complex<double>(pole.imag(), -pole.real()) / (2 * std::numbers::pi);
  if (f.real() <= limits.pass_Hz || f.real() >= limits.stop_Hz) return limits(f.real());
  const std::complex<double> b = (limits.stop_Hz - f) / (limits.stop_Hz - limits.pass_Hz);
  return b * b * b * b * (35.0 - b * (84.0 - b * (70.0 - b * 20.0)));
}

/// Partials of a pluck of 1 N at `position` (0..1), amplitudes at `age_s` after the release, up to the edge of the band or
/// `most` partials.
[[nodiscard]] inline std::vector<damped_line> pluck_lines(const ringing_string& string, double position, double age_s,
                                                          const band& limits, int most) {
  std::vector<damped_line> lines;
  for (int n = 1; n <= most; ++n) {
    const double f = string.partial_Hz(n);
    if (f >= limits.stop_Hz || (n > 1 && f <= string.partial_Hz(n - 1))) break;
    const double half = string.loss.inverse_q(f) / 2, w = 2 * std::numbers::pi * f;
    const std::complex<double> pole{-w * half, w * std::sqrt(std::max(0.0, 1 - half * half))};
    const double angle = n * std::numbers::pi;
    const std::complex<double> near = band_weight(limits, pole) * 2.0 / angle * std::sin(angle * position) /
                                      (1 - string.loss.dispersion(f)) * std::complex<double>(1, string.convention * half) *
                                      std::exp(pole * age_s);
    lines.push_back({pole, {near, n % 2 ? near : -near}});
  }
  return lines;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
