// SPDX-License-Identifier: MIT
#include <rosin/diagnose/loaded_motion.hpp>

#include <doctest/doctest.h>

#include "support/burdened_stroke.hpp"

namespace {

const rosin::modal_rig rig{
    {.length_m = 0.32, .tension_N = 70, .fundamental_Hz = 640, .bending_stiffness_Nm2 = 4e-5, .loss = {.quality = 1000}},
    {7, 3.5, 15}};

/// rms difference of force and of velocity from the truth, relative; `scene` empty: as if the string were plain.
std::array<double, 2> errors(const rosin::string_burden& burden, const rosin::pluck_scene& scene) {
  const test::burdened_stroke bowed(rig, burden);
  return bowed.errors_of(
      rosin::reconstruct_loaded(scene, rosin::contact_at(rig.string, bowed.position), bowed.end_N, bowed.limits, bowed.rate_Hz));
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
