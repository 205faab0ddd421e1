// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_settings.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_wave_settings {

namespace {

const rosin::modal_rig rig{
    .string = {.length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5}};

}  // namespace

TEST_CASE("sound settings have nothing said against them") {
  CHECK(rosin::problem_with(rosin::wave_settings{}).empty());
  CHECK(rosin::problem_with_contact(rig, 0.3, {}).empty());
  CHECK(rosin::wave_settings{}.step_s() == test::approx(1 / 1.024e6));
}

TEST_CASE("what cannot be is said") {
  CHECK(rosin::problem_with(rosin::wave_settings{.sample_rate_Hz = -1}).find("sample rate") != std::string::npos);
  CHECK(rosin::problem_with(rosin::wave_settings{.oversampling = 0}).find("oversampling") != std::string::npos);
  CHECK(rosin::problem_with(rosin::wave_settings{.band_Hz = 0}).find("band") != std::string::npos);
  CHECK(rosin::problem_with(rosin::wave_settings{.pass_Hz = 30e3, .stop_Hz = 20e3}).find("low-pass") != std::string::npos);
  CHECK(rosin::problem_with_contact(rig, 0.004, {}).find("bends") != std::string::npos);
  CHECK(rosin::problem_with_contact(rig, 0.02, {.oversampling = 1}).find("three steps") != std::string::npos);
  CHECK(rosin::problem_with_contact(rig, 0.3, {.sample_rate_Hz = 2000, .oversampling = 1}).find("pitch") != std::string::npos);
}

}  // namespace simulate_wave_settings
