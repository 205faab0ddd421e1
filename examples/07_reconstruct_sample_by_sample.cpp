// SPDX-License-Identifier: MIT
//
// The same reconstruction while the bow moves: filters designed on a desk, run block by block without heap or libm. One version
// of force and velocity is there as soon as the nearer end has heard of it; both versions wait for the farther.
//
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/reconstruct/passage_design.hpp>
#include <rosin/reconstruct/passage_reconstructor.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <algorithm>
#include <array>
#include <cstdio>

namespace {

constexpr std::size_t block = 32;

/// The stroke in blocks, as a converter would give it; the largest friction force and the bytes that the stream takes.
bool run(const char* name, const rosin::passage_plan& plan, const rosin::modal_take& take) {
  const auto coefficients = rosin::fixed_size<float, 64, 256, 8>(plan);
  if (!coefficients) return std::printf("%s\n", coefficients.error().c_str()), false;
  rosin::passage_reconstructor<float, 64, 256, 8> under_the_bow{*coefficients};

  float largest_N = 0;
  std::array<rosin::termination_frame<float>, block> forces;
  std::array<rosin::bow_frame<float>, block> bow;
  for (std::size_t n = 0; n + block <= take.size(); n += block) {
    for (std::size_t i = 0; i < block; ++i)
      forces[i] = {static_cast<float>(take.force_near_N[n + i]), static_cast<float>(take.force_far_N[n + i])};
    under_the_bow.process(forces, bow);
    if (under_the_bow.known())
      for (const auto& now : bow) largest_N = std::max(largest_N, now.force_N());
  }
  std::printf("%s: late by %.0f frames (%.2f ms), largest friction force %.2f N, %zu bytes in all\n", name,
              static_cast<double>(under_the_bow.latency()),
              1e3 * static_cast<double>(under_the_bow.latency()) / take.sample_rate_Hz, static_cast<double>(largest_N),
              sizeof under_the_bow);
  return true;
}

}  // namespace

int main() {
  const rosin::string_parameters string{
      .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5};
  const auto take =
      rosin::simulate_stroke({.string = string}, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                             rosin::steady_rod{.speed_m_s = 0.2, .normal_force_N = 0.3}, {.position = 0.3, .duration_s = 0.05});
  if (!take) return 1;

  const auto contact = rosin::contact_at(string, 0.3);
  const rosin::band band{20e3, 50e3};
  const auto plan = [&](rosin::bow_version version) {
    return rosin::plan_passages(contact, {1, 1}, band, take->sample_rate_Hz, 1e-3, version, 8);
  };
  const bool done =
      run("both versions", plan(rosin::bow_version::both), *take) && run("near version", plan(rosin::bow_version::near), *take);
  return done ? 0 : 1;
}
