// SPDX-License-Identifier: MIT
#include <rosin/diagnose/loaded_motion.hpp>

#include <rosin/friction/friction_curves.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/burdened_take.hpp>
#include <rosin/simulate/modal_decimator.hpp>

#include <doctest/doctest.h>

namespace {

constexpr double rate_Hz = 128000;
constexpr int oversampling = 8;
const rosin::modal_rig rig{
    {.length_m = 0.32, .tension_N = 70, .fundamental_Hz = 640, .bending_stiffness_Nm2 = 4e-5, .loss = {.quality = 1000}},
    {7, 3.5, 15}};

/// rms difference of force and of velocity from the truth, relative; `scene` empty: as if the string were plain.
std::array<double, 2> errors(const rosin::string_burden& burden, const rosin::pluck_scene& scene) {
  constexpr double step = 1 / rate_Hz / oversampling, position = 0.3;
  const rosin::velocity_curve<rosin::two_exponential_curve<double>> law{{0.38, 0.02, 0.42, 0.14, 0.35}};
  const auto steps = rosin::step_stroke(rig, burden, law, rosin::steady_rod{.speed_m_s = 0.2, .normal_force_N = 0.3}, {},
                                        position, 0, 0.06, 200e3, step);
  const rosin::modal_decimator decimate{rosin::modal_settings{}.low_pass(), step, oversampling};
  const rosin::band limits{18e3, 22e3};
  const std::array<std::vector<double>, 2> ends{decimate.points(steps.end_N[0]), decimate.points(steps.end_N[1])};
  const auto motion = rosin::reconstruct_loaded(scene, rosin::contact_at(rig.string, position), ends, limits, rate_Hz);
  const auto kernel = rosin::shortest_fir([](double) { return 1.0; }, limits, rate_Hz, -300, 300, 1e-6);
  const auto smooth = [&](const std::vector<double>& x, std::size_t i) {
    double sum = 0;
    for (int k = kernel.first; k <= kernel.last(); ++k)
      sum += kernel.taps[static_cast<std::size_t>(k - kernel.first)] * x[i - static_cast<std::size_t>(k + 1000) + 1000];
    return sum;
  };
  const auto force = decimate.points(steps.force_N), centre = decimate.points(steps.centre_m_s);
  std::array<double, 2> off{}, all{};
  for (std::size_t i = motion.known.begin + 1500; i + 1500 < motion.known.end; ++i) {
    const double f = smooth(force, i), v = smooth(centre, i);
    off[0] += std::pow(motion.force_N(i) - f, 2), all[0] += f * f;
    off[1] += std::pow(motion.velocity_m_s(i) - v, 2), all[1] += v * v;
  }
  return {std::sqrt(off[0] / all[0]), std::sqrt(off[1] / all[1])};
}

}  // namespace

TEST_CASE(
    "the force under the bow of a string with beads, a finger and a support that yields, as right as that of a plain string") {
  const double z = rig.string.impedance_Ns_m();
  rosin::pluck_scene plain, loaded;
  rosin::string_burden burden;
  burden.loads = {
      {.position = 0.17, .mass_kg = 4e-6}, {.position = 0.62, .resistance_Ns_m = 2e-3}, {.position = 0.8, .mass_kg = 2e-6}};
  burden.supports[1] = {.mass_kg = 0.004, .frequency_Hz = 2500, .quality = 15};
  for (const auto& l : burden.loads)
    loaded.scatterers.push_back({.position = l.position, .mass_s = l.mass_kg / z, .resistance = l.resistance_Ns_m / z});
  loaded.ends[1].modes = {{2500, 15, z / 0.004}};

  const auto reference = errors({}, plain), blind = errors(burden, plain), knowing = errors(burden, loaded);
  INFO("plain ", reference[0], " ", reference[1], ", taken for plain ", blind[0], " ", blind[1], ", as it is ", knowing[0], " ",
       knowing[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(reference[i] < (i == 0 ? 0.0006 : 0.006));
    CHECK(blind[i] > 0.1);
    CHECK(knowing[i] < 1.3 * reference[i] + 0.0004);
  }
}

TEST_CASE(
    "the force under the bow of a string whose ends resist turning, with a bead on it, as right as that of one between knife "
    "edges") {
  const double z = rig.string.impedance_Ns_m();
  rosin::pluck_scene clamped;
  rosin::string_burden burden{.loads = {{.position = 0.12, .mass_kg = 4e-6}}, .clamping = {1, 0.6}};
  clamped.scatterers = {{.position = 0.12, .mass_s = 4e-6 / z}};
  auto pinned = clamped;
  for (std::size_t e = 0; e < 2; ++e) clamped.ends[e].clamping = burden.clamping[e];
  const auto reference = errors({}, {}), blind = errors(burden, pinned), knowing = errors(burden, clamped);
  INFO("pinned ", reference[0], " ", reference[1], ", taken for pinned ", blind[0], " ", blind[1], ", as it is ", knowing[0], " ",
       knowing[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(blind[i] > 0.03);
    CHECK(knowing[i] < 1.3 * reference[i] + 0.0004);
  }
}
