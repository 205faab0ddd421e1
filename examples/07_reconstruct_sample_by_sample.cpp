// SPDX-License-Identifier: MIT
//
// The same reconstruction while the bow moves: coefficients designed on a desk, run frame by frame without heap or libm.
//
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/reconstruct/streaming_design.hpp>
#include <rosin/reconstruct/streaming_reconstructor.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <cstdio>

int main() {
  const rosin::string_parameters string{.length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5};
  const auto take = rosin::simulate_stroke({.string = string}, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                                           rosin::steady_rod{.speed_m_s = 0.2, .normal_force_N = 0.3},
                                           {.position = 0.3, .duration_s = 0.05});
  if (!take) return 1;

  const auto coefficients = rosin::design_streaming<float, 256, 512>(rosin::contact_at(string, 0.3), {1, 1}, {20e3, 50e3},
                                                                     take->sample_rate_Hz, 1e-3);
  if (!coefficients) {
    std::printf("%s\n", coefficients.error().c_str());
    return 1;
  }
  rosin::streaming_reconstructor<float, 256, 512> under_the_bow{*coefficients};

  double largest = 0;
  for (std::size_t n = 0; n < take->size(); ++n) {
    const auto now = under_the_bow({static_cast<float>(take->force_near_N[n]), static_cast<float>(take->force_far_N[n])});
    largest = std::max(largest, static_cast<double>(now.force_N()));
  }
  std::printf("late by %.0f frames, largest friction force %.2f N, %zu bytes in all\n",
              static_cast<double>(under_the_bow.latency()), largest, sizeof under_the_bow);
}
