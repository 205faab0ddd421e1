// SPDX-License-Identifier: MIT
#include <rosin/friction/contact_heat.hpp>
#include <rosin/friction/creep.hpp>
#include <rosin/friction/elasto_plastic.hpp>
#include <rosin/friction/enhanced_thermal.hpp>
#include <rosin/friction/friction_curves.hpp>
#include <rosin/friction/friction_law.hpp>
#include <rosin/friction/slip_watch.hpp>
#include <rosin/friction/thermal_plastic.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/friction/yield_curve.hpp>

namespace {

using line = rosin::load_line<float>;

template <rosin::FrictionLaw Law>
float stroke(Law law, const line* lines, int count) noexcept {
  float force_N = 0;
  for (int n = 0; n < count; ++n) force_N += law(lines[n]).force_N;
  law.reset();
  return force_N;
}

}  // namespace

extern "C" float rosin_curves(const line* lines, int count) noexcept {
  return stroke(rosin::velocity_curve<rosin::two_exponential_curve<float>>{}, lines, count) +
         stroke(rosin::velocity_curve<rosin::hyperbolic_curve<float>>{}, lines, count) +
         stroke(rosin::velocity_curve<rosin::stribeck_curve<float>>{}, lines, count) +
         stroke(rosin::velocity_curve<rosin::power_law_curve<float>>{}, lines, count) +
         stroke(rosin::creep<rosin::two_exponential_curve<float>>{}, lines, count) +
         stroke(rosin::elasto_plastic<rosin::stribeck_curve<float>>{}, lines, count);
}

extern "C" float rosin_heat(const rosin::yield_curve<float>* strength, const line* lines, int count) noexcept {
  const rosin::contact_heat_parameters<float> heat;
  return stroke(rosin::thermal_plastic<float>{*strength, heat}, lines, count) +
         stroke(rosin::enhanced_thermal<float>{*strength, rosin::rod_shear_shape<float>(), heat}, lines, count) +
         rosin::contact_heat<float>{heat}.steady_loss_W_K(0.1F, 0.3F);
}

extern "C" bool rosin_slips(float velocity_m_s) noexcept {
  static rosin::slip_watch<float> watch{0.2F};
  return watch(velocity_m_s) == rosin::contact_state::slipping;
}
