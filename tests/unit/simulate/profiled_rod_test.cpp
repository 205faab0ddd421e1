// SPDX-License-Identifier: MIT
#include <rosin/simulate/profiled_rod.hpp>

#include <doctest/doctest.h>

#include <rosin/friction/velocity_curve.hpp>

#include "support/approx.hpp"

namespace simulate_profiled_rod {

TEST_CASE("straight between break points, constant outside") {
  const rosin::profiled_rod rod{.speed_m_s = {{0.1, 0.2}, {0.3, -0.2}, {0.4, 0}}, .normal_force_N = {{0.2, 0.5}}};
  CHECK(rod(0).velocity_m_s == 0.2);
  CHECK(rod(0.1).velocity_m_s == 0.2);
  CHECK(rod(0.15).velocity_m_s == test::approx(0.1));
  CHECK(rod(0.3).velocity_m_s == test::approx(-0.2));
  CHECK(rod(0.375).velocity_m_s == test::approx(-0.05));
  CHECK(rod(7).velocity_m_s == 0);
  CHECK(rod(0).normal_force_N == 0.5);
  CHECK(rod(1).normal_force_N == 0.5);
}

TEST_CASE("what has no points is a steady stroke") {
  const rosin::steady_rod steady{.speed_m_s = 0.1, .normal_force_N = 0.4, .start_s = 0.01, .rise_s = 0.02};
  const rosin::profiled_rod pressed{.steady = steady, .normal_force_N = {{0, 0}, {0.1, 1}}};
  const rosin::profiled_rod moved{.steady = steady, .speed_m_s = {{0, 0}, {0.1, 1}}};
  for (const double t : {0.0, 0.013, 0.05}) {
    CHECK(pressed(t).velocity_m_s == steady(t).velocity_m_s);
    CHECK(pressed(t).normal_force_N == test::approx(10 * t).scale(1));
    CHECK(moved(t).velocity_m_s == test::approx(10 * t).scale(1));
    CHECK(moved(t).normal_force_N == 0.4);
  }
}

TEST_CASE("a stroke that ends: the rod stops and lifts off, and the string rings on its own") {
  const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                        .tension_N = 72.5,
                                        .fundamental_Hz = 660,
                                        .bending_stiffness_Nm2 = 4.7e-5,
                                        .loss = {.quality = 1000}}};
  const rosin::profiled_rod rod{.speed_m_s = {{0, 0}, {0.01, 0.2}}, .normal_force_N = {{0.02, 0.3}, {0.021, 0}}};
  const auto take = rosin::simulate_stroke(rig, rosin::velocity_curve{rosin::two_exponential_curve<>{}}, rod,
                                           {.position = 0.3, .duration_s = 0.03}, {.oversampling = 4, .mode_limit_Hz = 160e3});
  REQUIRE(take);
  const auto at = [&](double t) { return static_cast<std::size_t>(t * take->sample_rate_Hz); };
  double pushed = 0, free = 0, ringing = 0;
  for (std::size_t n = at(0.012); n < at(0.02); ++n) pushed = std::max(pushed, std::abs(take->contact_force_N[n]));
  for (std::size_t n = at(0.023); n < take->size(); ++n) {
    free = std::max(free, std::abs(take->contact_force_N[n]));
    ringing = std::max(ringing, std::abs(take->centre_velocity_m_s[n]));
  }
  CHECK(pushed > 0.1);
  CHECK(free < 1e-6);
  CHECK(ringing > 0.05);
}

TEST_CASE("it travels where it has a way, and stays where it has none") {
  CHECK(!rosin::profiled_rod{}.travels());
  const rosin::profiled_rod rod{.place = {{0.1, 0.3}, {0.2, 0.1}}};
  CHECK(rod.travels());
  CHECK(rod.position(0) == 0.3);
  CHECK(rod.position(0.15) == test::approx(0.2));
  CHECK(rod.position(1) == 0.1);
}

}  // namespace simulate_profiled_rod
