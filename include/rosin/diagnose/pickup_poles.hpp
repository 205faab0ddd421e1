// tier: hosted
// SPDX-License-Identifier: MIT
//
// The partials of a string with everything that a single pickup can tell of it, as poles s_n = -decay + i w in closed form.
// With a mode number v that need not be whole, W(v) = v sqrt(1 + b v^2) the pitch in units of f0, and W' its slope,
//
//     sin(pi v) = i (Z Y (1 + b v^2) / W' r) [cos(pi v) - n_e sin(pi v)] - i sum_loads (z r / W') [sin(pi v x) sin(pi v (1 - x)) - n_x sin(pi v)]
//     s = 2 pi i f0 W(v) - pi f (1/Q0 + internal f + air / sqrt(f)) - 2 f0 conductance,     r = s / (2 pi i f0 W(v))
//
// z is the load's impedance over the string's (bead: i pi W m/M, finger: R/Z), Y the admittance of an end. The near field of a
// stiff string, n_x = (1 - exp(-2 pi k x) - exp(-2 pi k (1 - x))) v / 2k and n_e = v^3 / k^3 with k^2 = v^2 + 1/b, makes it exact
// however heavy the load (string_response.hpp). v is found by Newton's method from n on. Masses are in masses of the string
// M = Z / (2 f0), so that no newton is needed anywhere.
//
#pragma once

#include <cmath>
#include <complex>
#include <numbers>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What the partials of one string follow from. All zero but pitch and 1/Q: an ideal string.
struct pickup_law {
  double fundamental_Hz = 0, inharmonicity = 0;
  double inverse_q = 0, internal_s = 0, air_sqrt_Hz = 0;
  double conductance = 0;                     ///< of resistive ends, both together, times Z
  double loaded_loss = 0;                     ///< 0: the string's loss is the bare string's; 1: that of the modes with all loads
  double bead_position = 0.5, bead_mass = 0;  ///< of the string's mass
  double finger_position = 0.5, finger_resistance = 0;          ///< of Z
  double support_Hz = 1, support_q = 1, support_lightness = 0;  ///< mass of the string / mass of the support
};

namespace detail {

/// Decay rate by the law of losses alone, 1/s.
inline double pickup_loss_rate(const pickup_law& l, double f) {
  return std::numbers::pi * f * (l.inverse_q + l.internal_s * f + l.air_sqrt_Hz / std::sqrt(f)) +
         2 * l.fundamental_Hz * l.conductance;
}

/// Left side minus right side of the equation above. A lossy string's wave number goes with s + loss, its loads feel s and a
/// complex tension (string_response.hpp); where it is the modes with all loads that lose, loads are met without any of that.
inline std::complex<double> pickup_characteristic(const pickup_law& l, std::complex<double> v, double loss_per_s) {
  constexpr std::complex<double> i{0, 1};
  constexpr double pi = std::numbers::pi;
  const auto stiff = 1.0 + l.inharmonicity * v * v, root = std::sqrt(stiff), slope = (1.0 + 2.0 * l.inharmonicity * v * v) / root;
  const auto all = pi * v, sine = std::sin(all), lossless = v * root, s = i * lossless - loss_per_s / (2 * pi * l.fundamental_Hz);
  const auto near = std::sqrt(v * v + 1 / std::max(l.inharmonicity, 1e-24));  // the rate at which the near field fades
  const double inverse_q = loss_per_s / (pi * l.fundamental_Hz * std::abs(lossless.real())), bare = 1 - l.loaded_loss,
               own = bare * inverse_q / (2 * pi);
  auto value = sine;
  if (l.support_lightness != 0) {
    const auto x = -i * s * l.fundamental_Hz / l.support_Hz;  // of the support's resonance
    const auto zy = l.support_lightness * l.fundamental_Hz / (pi * l.support_Hz) * i * x / (1.0 - x * x + i * x / l.support_q);
    value += zy * (lossless / s * (1.0 + i * inverse_q / 2.0) * stiff / slope * (std::cos(all) - sine * std::pow(v / near, 3)) +
                   2 * own * sine);
  }
  const auto met = bare == 0 ? i * lossless : s;  // what loads feel
  const auto load = [&](std::complex<double> z, double x) {
    const auto fading = [&](double d) { return std::exp(-2 * pi * near * d); };
    const auto faded = (1.0 - fading(x) - fading(1 - x)) * v / (2.0 * near);
    value += z * (met / lossless / (1.0 + i * bare * inverse_q / 2.0) / slope *
                      (std::sin(all * x) * std::sin(all * (1 - x)) - faded * sine) -
                  own * sine);
  };
  if (l.bead_mass != 0) load(pi * met * l.bead_mass, l.bead_position);
  if (l.finger_resistance != 0) load(l.finger_resistance, l.finger_position);
  return value;
}

}  // namespace detail

/// Pole of partial n, 1/s.
[[nodiscard]] inline std::complex<double> pickup_pole(const pickup_law& l, int n) {
  const auto pitch = [&](std::complex<double> v) { return l.fundamental_Hz * v * std::sqrt(1.0 + l.inharmonicity * v * v); };
  std::complex<double> v = n;
  if (l.bead_mass != 0 || l.finger_resistance != 0 || l.support_lightness != 0)
    for (int k = 0; k < 12; ++k) {
      constexpr double h = 1e-6;
      const double loss = detail::pickup_loss_rate(l, std::abs(pitch(v).real()));
      const auto slope =
          (detail::pickup_characteristic(l, v + h, loss) - detail::pickup_characteristic(l, v - h, loss)) / (2 * h);
      auto step = -detail::pickup_characteristic(l, v, loss) / slope;
      if (std::abs(step) > 0.1) step *= 0.1 / std::abs(step);
      v += step;
      if (std::abs(step) < 1e-12) break;
    }
  const auto f = pitch(v);
  return std::complex<double>{0, 2 * std::numbers::pi} * f - detail::pickup_loss_rate(l, std::abs(f.real()));
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
