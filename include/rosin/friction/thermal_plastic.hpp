// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Rosin as a plastic solid whose strength depends on its temperature alone (Smith and Woodhouse 2000): while it slips
// the force is N Y(Theta) against the slip, whatever the speed; it sticks while less is asked of it. The temperature
// is that of the step before, so there is nothing to solve.
//
#pragma once

#include <cmath>

#include <rosin/friction/contact_heat.hpp>
#include <rosin/friction/friction_law.hpp>
#include <rosin/friction/yield_curve.hpp>

namespace rosin {

template <class T = double>
class thermal_plastic {
public:
  using scalar = T;

  thermal_plastic(const yield_curve<T>& strength, const contact_heat_parameters<T>& heat) noexcept
      : strength_{strength}, heat_{heat} {}

  contact_force<T> operator()(const load_line<T>& line) noexcept {
    using std::abs;
    using std::copysign;
    const T normal = line.normal_force_N > 0 ? line.normal_force_N : T(0);
    const T sticking = line.sticking_force(), limit = normal * strength_(heat_.temperature_rise_K());
    const bool slips = !(abs(sticking) <= limit) || !(normal > 0);
    const T force = slips ? copysign(limit, sticking) : sticking;
    const T slip = slips ? abs(line.slip(force)) : T(0);
    const T rise = heat_(abs(force) * slip, slip, normal, line.step_s);
    return {.force_N = force, .temperature_rise_K = rise, .slipping = slips};
  }

  void reset() noexcept { heat_.reset(); }
  [[nodiscard]] T temperature_rise_K() const noexcept { return heat_.temperature_rise_K(); }

private:
  yield_curve<T> strength_;
  contact_heat<T> heat_;
};

static_assert(FrictionLaw<thermal_plastic<>>);

}  // namespace rosin
