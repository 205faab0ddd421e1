// SPDX-License-Identifier: MIT
#include <rosin/simulate/modal_take.hpp>

#include <limits>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_modal_take {

namespace {

rosin::modal_rig sound_rig() {
  return {.string = {.length_m = 0.314,
                     .tension_N = 72.5,
                     .fundamental_Hz = 660,
                     .bending_stiffness_Nm2 = 4.7e-5,
                     .loss = {.quality = 1000}}};
}

bool complains(const std::string& message, const char* about) { return message.find(about) != std::string::npos; }

}  // namespace

TEST_CASE("what cannot be simulated is named") {
  CHECK(rosin::problem_with(sound_rig(), 0.3).empty());
  CHECK(complains(rosin::problem_with(sound_rig(), 0.0), "position"));
  CHECK(complains(rosin::problem_with(sound_rig(), 1.0), "position"));
  auto rig = sound_rig();
  rig.string.tension_N = std::numeric_limits<double>::quiet_NaN();
  CHECK(complains(rosin::problem_with(rig, 0.3), "tension"));
  rig = sound_rig();
  rig.string.bending_stiffness_Nm2 = -1e-9;
  CHECK(complains(rosin::problem_with(rig, 0.3), "stiffness"));
  rig = sound_rig();
  rig.string.loss.quality = 0.5;
  CHECK(complains(rosin::problem_with(rig, 0.3), "Q"));
  rig = sound_rig();
  rig.torsion = {7, 3.5, 0.5};
  CHECK(complains(rosin::problem_with(rig, 0.3), "torsion"));
}

TEST_CASE("settings: the low-pass ends where the samples do, and the modes reach further") {
  const rosin::modal_settings usual;
  CHECK(rosin::problem_with(usual).empty());
  CHECK(usual.low_pass().stop_Hz() == test::approx(64e3));
  CHECK(usual.low_pass().pass_Hz() == test::approx(55.04e3));
  CHECK(complains(rosin::problem_with({.oversampling = 0}), "oversampling"));
  CHECK(complains(rosin::problem_with({.mode_limit_Hz = 50e3}), "modes"));
  CHECK(complains(rosin::problem_with({.pass_Hz = 30e3, .stop_Hz = 20e3}), "low-pass"));
}

TEST_CASE("a take lasts for a sample at least, and not for ever") {
  CHECK(rosin::problem_with_duration(0.36, {}).empty());
  for (const double bad :
       {0.0, -1.0, 1e-6, 1e6, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    CHECK(complains(rosin::problem_with_duration(bad, {}), "take"));
}

TEST_CASE("motions without slip are told from bowed motion") {
  rosin::modal_take take;
  CHECK(rosin::motion_of(take) == rosin::bowed_motion::sticking);
  take.slipping = 0.2;
  CHECK(rosin::motion_of(take) == rosin::bowed_motion::stick_slip);
  take.slipping = 1;
  CHECK(rosin::motion_of(take) == rosin::bowed_motion::sliding);
}

}  // namespace simulate_modal_take
