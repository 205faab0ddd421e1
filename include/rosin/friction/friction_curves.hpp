// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Coefficient of friction against slip speed, measured in steady sliding.
// Each curve gives value and slope at once, is defined for v >= 0 and falls with v; `convex_from()` is the slip
// speed above which it is convex, on which the solution of the contact equation relies.
//
#pragma once

#include <cmath>
#include <concepts>

namespace rosin {

/// mu and d mu / d v.
template <class T>
struct curve_point {
  T value{}, slope{};
};

template <class C>
concept FrictionCurve = std::copyable<C> && requires(const C& curve, typename C::scalar v) {
  typename C::scalar;
  { curve(v) }
  noexcept->std::same_as<curve_point<typename C::scalar>>;
  { curve.convex_from() }
  noexcept->std::same_as<typename C::scalar>;
};

/// a exp(-v / va) + b exp(-v / vb) + c. The default is rosin in steady sliding after Smith and Woodhouse (2000).
template <class T = double>
struct two_exponential_curve {
  using scalar = T;
  T a = T(0.4), va_m_s = T(0.01), b = T(0.45), vb_m_s = T(0.1), c = T(0.35);

  [[nodiscard]] curve_point<T> operator()(T v) const noexcept {
    using std::exp;
    const T fast = a * exp(-v / va_m_s), slow = b * exp(-v / vb_m_s);
    return {fast + slow + c, -fast / va_m_s - slow / vb_m_s};
  }
  [[nodiscard]] T convex_from() const noexcept { return T(0); }
};

/// mu_d + (mu_s - mu_d) v0 / (v0 + v).
template <class T = double>
struct hyperbolic_curve {
  using scalar = T;
  T dynamic = T(0.4), at_rest = T(0.8), v0_m_s = T(0.2);

  [[nodiscard]] curve_point<T> operator()(T v) const noexcept {
    const T part = (at_rest - dynamic) * v0_m_s / (v0_m_s + v);
    return {dynamic + part, -part / (v0_m_s + v)};
  }
  [[nodiscard]] T convex_from() const noexcept { return T(0); }
};

/// mu_C + (mu_S - mu_C) exp(-(v / v_S)^2), after Stribeck.
template <class T = double>
struct stribeck_curve {
  using scalar = T;
  T coulomb = T(0.507), at_rest = T(1.021), v_stribeck_m_s = T(0.228);

  [[nodiscard]] curve_point<T> operator()(T v) const noexcept {
    using std::exp;
    const T u = v / v_stribeck_m_s, part = (at_rest - coulomb) * exp(-u * u);
    return {coulomb + part, -2 * u * part / v_stribeck_m_s};
  }
  [[nodiscard]] T convex_from() const noexcept { return v_stribeck_m_s * T(0.70710678118654752440); }
};

/// a (v + v0)^p with p < 0. The default is the steady curve that Woodhouse and Galluzzo (2025) fit to rosin.
template <class T = double>
struct power_law_curve {
  using scalar = T;
  T a = T(0.2), v0_m_s = T(0.011), exponent = T(-0.4);

  [[nodiscard]] curve_point<T> operator()(T v) const noexcept {
    using std::pow;
    const T value = a * pow(v + v0_m_s, exponent);
    return {value, exponent * value / (v + v0_m_s)};
  }
  [[nodiscard]] T convex_from() const noexcept { return T(0); }
};

}  // namespace rosin
