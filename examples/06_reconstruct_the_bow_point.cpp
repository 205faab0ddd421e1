// SPDX-License-Identifier: MIT
//
// What happened under the bow, from the forces at the two ends of the string.
//
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/reconstruct/consistency.hpp>
#include <rosin/reconstruct/reconstructor.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <cstdio>

namespace {

const rosin::string_parameters string{
    .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 1000}};

}  // namespace

int main() {
  // Another method than the one that is inverted makes the recording: modes, stepped under a friction law.
  const auto take =
      rosin::simulate_stroke({.string = string}, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                             rosin::steady_rod{.speed_m_s = 0.2, .normal_force_N = 0.3}, {.position = 0.3, .duration_s = 0.1});
  if (!take) return 1;

  const rosin::band limits{20e3, 40e3};
  rosin::reconstructor<double> reconstruct(rosin::contact_at(string, 0.3), limits, take->sample_rate_Hz);
  const auto bow = reconstruct(take->force_near_N, take->force_far_N);

  std::printf("force, two versions:  Delta = %.5f\n", rosin::consistency_delta(bow.force_near_N, bow.force_far_N));
  std::printf("first and last samples cannot be known: %zu and %zu of them\n", bow.known.begin, take->size() - bow.known.end);

  // The paper's own processing is one of the choices made at compile time.
  rosin::reconstructor<double, rosin::paper_physics> as_printed(rosin::contact_at(string, 0.3), limits, take->sample_rate_Hz);
  const auto paper = as_printed(take->force_near_N, take->force_far_N);
  std::printf("the paper's filters:  Delta = %.5f\n", rosin::consistency_delta(paper.force_near_N, paper.force_far_N));
}
