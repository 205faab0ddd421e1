// SPDX-License-Identifier: MIT
//
// The reference rig: a stiff string between two force sensors, plucked by a breaking wire, then bowed. What the
// sensors would record comes with the truth that they are meant to reveal.
//
#include <algorithm>
#include <cstdio>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_pluck.hpp>
#include <rosin/simulate/modal_stroke.hpp>

int main() {
  const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                        .tension_N = 72.5,
                                        .fundamental_Hz = 660,
                                        .bending_stiffness_Nm2 = 4.7e-5,
                                        .loss = {.quality = 1000}},
                             .torsion = {.speed_ratio = 7, .impedance_ratio = 3.5, .quality = 15}};

  const auto pluck = rosin::simulate_pluck(rig, {.position = 0.3, .force_N = 1, .release_s = 0.004, .duration_s = 0.02});
  const auto bowed = rosin::simulate_stroke(rig, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                                            rosin::steady_rod{.speed_m_s = 0.2, .normal_force_N = 0.3},
                                            {.position = 0.3, .duration_s = 0.06}, {.oversampling = 4});
  if (!pluck || !bowed) return 1;
  std::printf("wire holds the string: %.3f N near, %.3f N far\n", pluck->force_near_N[0], pluck->force_far_N[0]);

  const auto& v = bowed->centre_velocity_m_s;
  std::printf("bowed: %zu slips, string between %.2f and %.2f m/s, rod at %.2f m/s\n", bowed->slips,
              *std::min_element(v.begin(), v.end()), *std::max_element(v.begin(), v.end()), bowed->rod_velocity_m_s.back());

  const rosin::converter sensor{.gain = 1.02, .newtons_per_full_scale = 1.65, .noise_N = 0.3e-3, .bits = 16};
  const auto near = rosin::convert(bowed->force_near_N, bowed->sample_rate_Hz, sensor, 1);
  std::printf("recorded: %zu samples of %d bits, %zu clipped\n", near.size(), near.bits, near.clipped);
}
