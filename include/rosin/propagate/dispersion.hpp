// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Exact dispersion of a stiff string, m w^2 = T k^2 + B k^4, written in time alone: with
// epsilon = B m / T^2 (s^2) a path of travel time tau (s, = x / c) delays the frequency w by tau q(w), where
//
//     q(w) = c k(w) = w sqrt( 2 / (1 + sqrt(1 + 4 epsilon w^2)) ),   K = B k^2 / T = epsilon q^2.
//
// Checked in the tests against the roots of the PDE.
//
#pragma once

#include <cmath>

namespace rosin {

/// c k(w) in rad/s: the phase that one second of travel (at low frequency) costs. Odd in w, exact, no cancellation. Of real
/// frequencies; others: complex_dispersion.hpp.
template <class T>
[[nodiscard]] T phase_rate(T omega, T epsilon_s2) noexcept {
  using std::sqrt;
  return omega * sqrt(T(2) / (T(1) + sqrt(T(1) + T(4) * epsilon_s2 * omega * omega)));
}

/// K = B k^2 / T, dimensionless.
template <class T>
[[nodiscard]] T stiffness_ratio(T omega, T epsilon_s2) noexcept {
  const T q = phase_rate(omega, epsilon_s2);
  return epsilon_s2 * q * q;
}

/// c / c_g: how much longer than a low-frequency wave's the energy of this frequency is under way, inverted.
template <class T>
[[nodiscard]] T slowness_ratio(T omega, T epsilon_s2) noexcept {
  using std::sqrt;
  const T K = stiffness_ratio(omega, epsilon_s2);
  return sqrt(T(1) + K) / (T(1) + T(2) * K);
}

/// G = Z_f / Z_w = (1 + 2K) / (1 + K): the factor on the force that a constant wave impedance leaves out.
template <class T>
[[nodiscard]] T force_factor(T omega, T epsilon_s2) noexcept {
  const T K = stiffness_ratio(omega, epsilon_s2);
  return (T(1) + T(2) * K) / (T(1) + K);
}

/// Z_w / Z = sqrt(1 + K): force at a pinned end against the velocity wave that arrives there.
template <class T>
[[nodiscard]] T wave_impedance_ratio(T omega, T epsilon_s2) noexcept {
  using std::sqrt;
  return sqrt(T(1) + stiffness_ratio(omega, epsilon_s2));
}

/// k / kappa = sqrt(K / (1 + K)): propagating against evanescent wavenumber, the size of the near field at the bow.
template <class T>
[[nodiscard]] T near_field_ratio(T omega, T epsilon_s2) noexcept {
  using std::sqrt;
  const T K = stiffness_ratio(omega, epsilon_s2);
  return sqrt(K / (T(1) + K));
}

}  // namespace rosin
