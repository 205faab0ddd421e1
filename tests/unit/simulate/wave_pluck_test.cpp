// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_pluck.hpp>

#include "support/apart.hpp"
#include "support/approx.hpp"
#include "support/violin_e_string.hpp"

#include <doctest/doctest.h>

#include <rosin/simulate/burdened_signals.hpp>

namespace simulate_wave_pluck {

namespace {

rosin::modal_rig plain_rig() {
  auto out = test::violin_e_string;
  out.torsion = {};
  return out;
}

const rosin::wave_settings settings{.pass_Hz = 20e3, .stop_Hz = 30e3};

}  // namespace

TEST_CASE("a pluck by waves is one by modes: let go at once, between two steps, and over a while") {
  for (const double release_duration_s : {0.0, 2e-4}) {
    CAPTURE(release_duration_s);
    const rosin::modal_pluck pluck{
        .position = 0.27, .force_N = 0.8, .release_s = 0.0040003, .release_duration_s = release_duration_s, .duration_s = 0.03};
    const auto modes = rosin::simulate_pluck(plain_rig(), pluck, settings.as_modal());
    const auto waves = rosin::simulate_wave_pluck(test::violin_e_string, pluck, settings);  // its torsion stays out of it
    REQUIRE(modes);
    REQUIRE_MESSAGE(waves, waves.error());
    REQUIRE(waves->size() == modes->size());
    CHECK(test::apart(waves->force_near_N, modes->force_near_N) < 2e-3);
    CHECK(test::apart(waves->force_far_N, modes->force_far_N) < 2e-3);
    CHECK(test::apart(waves->contact_force_N, modes->contact_force_N) < 1e-3);
    CHECK(test::apart(waves->centre_velocity_m_s, modes->centre_velocity_m_s) < 3e-3);
    for (const double v : waves->torsion_velocity_m_s) CHECK(v == 0);
    CHECK(waves->force_near_N.front() == test::approx(0.73 * 0.8).epsilon(1e-6));
  }
}

TEST_CASE("on ends that move the wire's force is shared as they give way, and the string rings as its modes do on them") {
  const auto rig = plain_rig();
  const double z = rig.string.impedance_Ns_m();
  rosin::rig_burden burden;
  burden.string.ends[0].modes = {{460, 30, z / 0.1}, {2400, 12, z / 0.004}};
  burden.string.ends[1].modes = {{700, 20, z / 0.05}};
  const rosin::modal_pluck pluck{.position = 0.3, .force_N = 1, .release_s = 0.004, .duration_s = 0.02};
  const auto modes = rosin::simulate_pluck(rig, burden, {.position = 0.3, .force_N = 1, .release_s = 0.004, .duration_s = 0.02},
                                           settings.as_modal());
  const auto waves = rosin::simulate_wave_pluck(rig, pluck, settings, burden.string.ends);
  REQUIRE_MESSAGE(modes, modes.error());
  REQUIRE_MESSAGE(waves, waves.error());
  CHECK(waves->force_near_N[100] == test::approx(modes->force_near_N[100]).epsilon(1e-4));
  CHECK(std::abs(waves->force_near_N[100] - 0.7) > 2e-4);
  CHECK(test::apart(waves->force_near_N, modes->force_near_N) < 3e-3);
  CHECK(test::apart(waves->force_far_N, modes->force_far_N) < 3e-3);
}

TEST_CASE("plucks that cannot be are refused with the reason") {
  CHECK(rosin::simulate_wave_pluck(plain_rig(), {.release_s = 0}).error().find("released") != std::string::npos);
  CHECK(rosin::simulate_wave_pluck(plain_rig(), {.release_duration_s = -1e-3}).error().find("released") != std::string::npos);
  CHECK(rosin::simulate_wave_pluck(plain_rig(), {.force_N = std::nan("")}).error().find("released") != std::string::npos);
  CHECK(rosin::simulate_wave_pluck(plain_rig(), {.position = 1.3}).error().find("position") != std::string::npos);
}

}  // namespace simulate_wave_pluck
