// SPDX-License-Identifier: MIT
//
// Calibrate a rig from one pluck: pitch, place, stiffness and loss of the string out of two noisy force signals.
//
#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_pluck.hpp>

#include <cstdio>

int main() {
  // A string that nobody has measured, plucked by a wire of 1 N, seen through two sensors with noise.
  const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                        .tension_N = 72.5,
                                        .fundamental_Hz = 660,
                                        .bending_stiffness_Nm2 = 4.7e-5,
                                        .loss = {.quality = 1000}}};
  const auto pluck = rosin::simulate_pluck(rig, {.position = 0.3, .force_N = 1, .release_s = 0.004, .duration_s = 0.14});
  if (!pluck) return 1;
  const rosin::converter sensor{.gain = 1.02, .newtons_per_full_scale = 1.65, .noise_N = 0.3e-3, .bits = 16};

  rosin::pluck_take take{.name = "pluck-1", .rate_Hz = pluck->sample_rate_Hz};
  take.force_N = {rosin::convert(pluck->force_near_N, take.rate_Hz, sensor, 1).newtons(),
                  rosin::convert(pluck->force_far_N, take.rate_Hz, sensor, 2).newtons()};
  take.strength_N = 1.0;  // what the wire is sold for, within 3 %
  take.position = 0.31;   // where the laboratory believes it was

  const auto fit = rosin::fit_plucks({take}, {.fundamental_Hz = 655});
  if (!fit) {
    std::printf("%s\n", fit.error().c_str());
    return 1;
  }
  for (const Eigen::Index p : {rosin::pluck_layout::fundamental, rosin::pluck_layout::inharmonicity,
                               rosin::pluck_layout::inverse_quality, rosin::pluck_layout::first_position})
    std::printf("%-16s %.8g +- %.1g\n", fit->layout.name(p).c_str(), fit->value[p], fit->sd[p]);
  std::printf("noise %.2f mN, misfit %.2f\n", 1e3 * fit->noise_N[0], fit->misfit);
  return std::abs(fit->value[rosin::pluck_layout::fundamental] / 660 - 1) < 1e-6 ? 0 : 1;
}
