// SPDX-License-Identifier: MIT
// Plucks of a stepped modal string with one thing wrong, fitted by closed forms that do not know it.
#include <rosin/diagnose/mismatch_class.hpp>
#include <rosin/diagnose/pluck_diagnosis.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <rosin/simulate/burdened_signals.hpp>

#include <doctest/doctest.h>

namespace {

/// The declared model fitted to two plucks; nothing is sought.
rosin::pluck_diagnosis as_declared(const rosin::rig_burden& burden, double release_duration_s) {
  std::vector<rosin::pluck_take> takes;
  for (const double force_N : {1.0, 0.5})
    takes.push_back(test::recorded(*rosin::simulate_pluck(test::plucked_rig, burden,
                                                          {.position = 0.3,
                                                           .force_N = force_N,
                                                           .release_s = 0.004,
                                                           .release_duration_s = release_duration_s,
                                                           .duration_s = 0.06}),
                                   force_N, takes.size()));
  const auto d = rosin::diagnose_plucks(takes, {}, {.fundamental_Hz = 660}, {.internal_loss = false},
                                        [](const auto&) { return std::vector<rosin::pluck_effect>{}; });
  REQUIRE_MESSAGE(d, d.error());
  return *d;
}

rosin::plucking_force seen(const rosin::rig_burden& burden, double release_duration_s = 0) {
  const auto d = as_declared(burden, release_duration_s);
  const auto force = rosin::plucking_force_of(d.data, d.declared, d.base, d.mismatch.take, {0.3e-3, 0.3e-3});
  REQUIRE(force);
  return *force;
}

}  // namespace

TEST_CASE("mismatch class: of a string as declared both versions are a step, to the noise") {
  const auto ideal = seen({});
  CHECK_FALSE(ideal.kind());
  CHECK(ideal.parting_N == test::approx(ideal.parting_noise_N).epsilon(0.15));
  CHECK(ideal.shape_N == test::approx(ideal.shape_noise_N).epsilon(0.2));
}

TEST_CASE("mismatch class: what the wire does both versions agree on" * doctest::test_suite("long")) {
  rosin::rig_burden wide;
  wide.pluck_width_m = 3e-3;
  for (const auto& wire : {seen({}, 60e-6), seen(wide)}) {
    CHECK(wire.kind() == rosin::mismatch_class::common_mode);
    CHECK(wire.shape_N > 2 * wire.shape_noise_N);
  }
}

TEST_CASE("mismatch class: what sensors, ends and loads do they do not" * doctest::test_suite("long")) {
  rosin::rig_burden bead, leak, late, curved, support;
  bead.string.loads = {{.position = 0.73, .mass_kg = 1e-6}};
  leak.sensors.crosstalk = 0.01;
  late.sensors.skew_s = 2e-6;
  curved.sensors.quadratic_per_N[0] = 0.02;
  support.string.supports[1] = {.mass_kg = 5e-3, .frequency_Hz = 2500, .quality = 12};
  for (const auto& burden : {bead, leak, late, curved, support}) {
    const auto force = seen(burden);
    CHECK(force.kind() == rosin::mismatch_class::sensor_or_string);
    CHECK(force.parting_N > 0.8 * force.shape_N);
  }
}
