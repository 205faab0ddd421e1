// tier: hosted
// SPDX-License-Identifier: MIT
//
// From friction in steady sliding to friction as a function of temperature. At each speed v the power N mu(v) v meets the
// contact's steady loss, which gives Theta(v); where that rises with v it can be turned round, and
// Y(Theta) = mu(v(Theta)) / h(v(Theta)) with a shape h that the law keeps explicit (1 in the thermal plastic law). The loss is
// that of the very steps of contact_heat, so that a law with the same heat parameters gives back mu(v) in steady
// sliding. Woodhouse and Galluzzo (2025) count nothing as lost to the string: parameters.without_string(). The loss
// depends on the normal force, because the contact's radius does: the table belongs to the one it was made for.
//
#pragma once

#include <cmath>
#include <string>

#include <rosin/core/number_text.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/friction/contact_heat.hpp>
#include <rosin/friction/friction_curves.hpp>
#include <rosin/friction/yield_curve.hpp>

namespace rosin {

namespace detail {

template <class T, class Curve>
[[nodiscard]] T steady_rise_K(const Curve& steady, const contact_heat<T>& heat, T normal_N, T speed_m_s) {
  return normal_N * steady(speed_m_s).value * speed_m_s / heat.steady_loss_W_K(speed_m_s, normal_N);
}

/// h = 1: all of the friction is the temperature's doing.
template <class T>
struct no_shape {
  using scalar = T;
  [[nodiscard]] curve_point<T> operator()(T) const noexcept { return {T(1), T(0)}; }
  [[nodiscard]] T convex_from() const noexcept { return T(0); }
};

}  // namespace detail

/// Y(Theta) up to the temperature of steady sliding at `fastest_m_s`.
template <FrictionCurve Curve, FrictionCurve Shape, class T = typename Curve::scalar>
[[nodiscard]] outcome<yield_curve<T>> design_yield_curve(const Curve& steady, const Shape& shape,
                                                         const contact_heat_parameters<T>& parameters, T normal_N,
                                                         T fastest_m_s = T(5)) {
  const contact_heat<T> heat{parameters};
  if (!(normal_N > 0)) return failure{"yield curve: the normal force must be above 0"};
  const auto rise = [&](T v) { return detail::steady_rise_K(steady, heat, normal_N, v); };
  const T slowest = fastest_m_s * T(1e-7), ratio = std::pow(T(1e7), T(1) / 512);
  for (T v = slowest; v * ratio <= fastest_m_s; v *= ratio)
    if (!(rise(v * ratio) > rise(v)))
      return failure{"yield curve: the steady temperature falls with speed at " + number_text(v) + " m/s"};
  yield_curve<T> table;
  table.spacing_K = rise(fastest_m_s) / T(yield_curve<T>::entries - 1);
  for (std::size_t i = 0; i < table.value.size(); ++i) {
    T low = 0, high = fastest_m_s;
    for (int k = 0; k < 60; ++k) {
      const T middle = (low + high) / 2;
      (rise(middle) < table.spacing_K * static_cast<T>(i) ? low : high) = middle;
    }
    const T v = i == 0 ? T(0) : high;
    table.value[i] = steady(v).value / shape(v).value;
  }
  return table;
}

/// The same for the thermal plastic law.
template <FrictionCurve Curve, class T = typename Curve::scalar>
[[nodiscard]] outcome<yield_curve<T>> design_yield_curve(const Curve& steady, const contact_heat_parameters<T>& parameters,
                                                         T normal_N) {
  return design_yield_curve(steady, detail::no_shape<T>{}, parameters, normal_N);
}

}  // namespace rosin
