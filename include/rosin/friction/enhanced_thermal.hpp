// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Enhanced thermal law after Woodhouse and Galluzzo (2025): the strength of rosin depends on temperature and, slowly, on
// the rate at which it is sheared, f = N Y(Theta) h(|v_r|). In each step the temperature is that of the step before; what is left
// is a velocity curve, solved with the same rule of branches. The constants come
// from a secondary source.
//
#pragma once

#include <cmath>

#include <rosin/friction/contact_heat.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/friction/yield_curve.hpp>

namespace rosin {

/// h(v) of the published rod: 0.37 (v + 0.35)^(-0.4), made for Y about 1 at 36.8 K above the surroundings.
template <class T = double>
[[nodiscard]] constexpr power_law_curve<T> rod_shear_shape() noexcept {
  return {T(0.37), T(0.35), T(-0.4)};
}

template <class T = double>
class enhanced_thermal {
public:
  using scalar = T;

  enhanced_thermal(const yield_curve<T>& strength, const power_law_curve<T>& shape,
                   const contact_heat_parameters<T>& heat) noexcept
      : strength_{strength}, shape_{shape}, heat_{heat} {}

  contact_force<T> operator()(const load_line<T>& line) noexcept {
    using std::abs;
    power_law_curve<T> now = shape_;
    now.a *= strength_(heat_.temperature_rise_K());
    auto answer = stay_on_branch(now, line, slipping_);
    const T slip = slipping_ ? abs(line.slip(answer.force_N)) : T(0);
    answer.temperature_rise_K = heat_(abs(answer.force_N) * slip, slip, line.normal_force_N, line.step_s);
    return answer;
  }

  void reset() noexcept {
    heat_.reset();
    slipping_ = false;
  }
  [[nodiscard]] T temperature_rise_K() const noexcept { return heat_.temperature_rise_K(); }

private:
  yield_curve<T> strength_;
  power_law_curve<T> shape_;
  contact_heat<T> heat_;
  bool slipping_ = false;
};

static_assert(FrictionLaw<enhanced_thermal<>>);

}  // namespace rosin
