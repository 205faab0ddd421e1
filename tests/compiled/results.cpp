// SPDX-License-Identifier: MIT
// What a fit and a diagnosis of simulated plucks and a torsion's fit find, to the last bit. The same file is compiled header-only and
// against rosin::compiled, with the same flags: both have to print the same.
#include <rosin/calibrate/calibration.hpp>
#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/diagnose/pluck_diagnosis.hpp>
#include <rosin/simulate/burdened_signals.hpp>
#include <rosin/simulate/converter.hpp>

#include <cstdio>

namespace {

constexpr double rate_Hz = 64e3;
const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                      .tension_N = 72.5,
                                      .fundamental_Hz = 659.69,
                                      .bending_stiffness_Nm2 = 4.7e-5,
                                      .loss = {.quality = 1000}}};
const rosin::pluck_guess guess{.fundamental_Hz = 660};

/// A pluck of a string that carries a bead of 4 mg.
rosin::pluck_take pluck(std::uint64_t seed) {
  rosin::rig_burden burden;
  burden.string.loads.push_back({.position = 0.4, .mass_kg = 4e-6});
  const auto made = rosin::simulate_pluck(rig, burden, {.position = 0.3, .force_N = 1, .release_s = 0.02, .duration_s = 0.1},
                                          {.sample_rate_Hz = rate_Hz});
  const rosin::converter sensor{.gain = 1, .newtons_per_full_scale = 2, .noise_N = 0.3e-3, .bits = 16};
  rosin::pluck_take take;
  take.name = "pluck", take.rate_Hz = rate_Hz, take.strength_N = 1, take.position = 0.304;
  take.force_N = {rosin::convert(made->force_near_N, rate_Hz, sensor, seed).newtons(),
                  rosin::convert(made->force_far_N, rate_Hz, sensor, seed + 1).newtons()};
  return take;
}

void print(const char* what, const Eigen::VectorXd& values) {
  for (const double v : values) std::printf("%s %a\n", what, v);
}

}  // namespace

int main() {
  const std::vector takes{pluck(1), pluck(3)}, held{pluck(5)};
  const auto fit = rosin::fit_plucks(takes, guess);
  if (!fit) return std::printf("%s\n", fit.error().c_str()), 1;
  print("fit", fit->value), print("sd", fit->sd);
  const auto found = rosin::diagnose_plucks(takes, held, guess, {}, [](const rosin::pluck_fit_result& declared) {
    const rosin::string_facts facts{declared.value[rosin::pluck_layout::fundamental],
                                    rate_Hz,
                                    declared.limits.stop_Hz,
                                    rig.string.impedance_Ns_m(),
                                    rig.string.length_m,
                                    declared.layout.takes()};
    std::vector<rosin::pluck_effect> few;
    for (rosin::pluck_effect& e : rosin::catalogue_without({}, facts, declared.limits))
      if (e.name == "point-mass" || e.name == "ac-coupling") few.push_back(std::move(e));
    return few;
  });
  if (!found) return std::printf("%s\n", found.error().c_str()), 1;
  for (const auto& e : found->best.effects) std::printf("effect %s\n", e.name.c_str());
  print("value", found->best.value), print("value sd", found->best.sd);
}
