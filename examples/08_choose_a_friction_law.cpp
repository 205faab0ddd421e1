// SPDX-License-Identifier: MIT
//
// One string, one bow, four laws of friction that agree in steady sliding and differ in motion. The simulator does
// not know which law it runs: each answers the same question, once a step.
//
#include <algorithm>
#include <cstdio>

#include <rosin/friction/creep.hpp>
#include <rosin/friction/elasto_plastic.hpp>
#include <rosin/friction/thermal_plastic.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/friction/yield_curve_design.hpp>
#include <rosin/simulate/modal_stroke.hpp>

namespace {

const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                      .tension_N = 72.5,
                                      .fundamental_Hz = 660,
                                      .bending_stiffness_Nm2 = 4.7e-5,
                                      .loss = {.quality = 1000}},
                           .torsion = {.speed_ratio = 7, .impedance_ratio = 3.5, .quality = 15}};
const rosin::steady_rod rod{.speed_m_s = 0.2, .normal_force_N = 0.3, .start_s = 0, .rise_s = 0.005};

template <rosin::FrictionLaw Law>
void bow_with(const char* name, Law law) {
  const auto take = rosin::simulate_stroke(rig, law, rod, {.position = 0.3, .duration_s = 0.03}, {.oversampling = 4});
  if (!take) {
    std::printf("%s: %s\n", name, take.error().c_str());
    return;
  }
  const auto& f = take->contact_force_N;
  std::printf("%-16s largest force %.2f N, slipping %2.0f %% of the time\n", name, *std::max_element(f.begin(), f.end()),
              100 * take->slipping);
}

}  // namespace

int main() {
  const rosin::two_exponential_curve<> steady;  // measured in steady sliding
  const rosin::contact_heat_parameters<> heat;  // the contact's layer, rod and string
  const auto strength = rosin::design_yield_curve(steady, heat.without_string(), rod.normal_force_N);
  if (!strength) return 1;

  bow_with("velocity curve", rosin::velocity_curve{steady});
  bow_with("creep", rosin::creep{steady});
  bow_with("elasto-plastic", rosin::elasto_plastic{steady});
  bow_with("thermal plastic", rosin::thermal_plastic<>{*strength, heat});
}
