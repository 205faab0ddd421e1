// SPDX-License-Identifier: MIT
#include <rosin/friction/slip_loops.hpp>

#include <doctest/doctest.h>

#include <numbers>

#include <rosin/friction/thermal_plastic.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/friction/yield_curve_design.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include "support/approx.hpp"

namespace friction_slip_loops {

namespace {

constexpr double rate_Hz = 128e3, rod_m_s = 0.2;

/// Slips of 40 samples every 200: speed a raised cosine of height 2 A, force offset + B sin, an ellipse in the plane.
struct ellipses {
  double speed_m_s = 1.5, mean_N = 0.2, swing_N = 0.05;
  std::vector<double> force_N, relative_m_s;
  explicit ellipses(double way = 1) {
    for (std::size_t i = 0; i < 4000; ++i) {
      const bool slips = i % 200 >= 100 && i % 200 < 140;
      const double turn = 2 * std::numbers::pi * (static_cast<double>(i % 200) - 100) / 40;
      relative_m_s.push_back(slips ? -way * speed_m_s * (1 - std::cos(turn)) / 2 : 0.0);
      force_N.push_back(way * (mean_N + (slips ? swing_N * std::sin(turn) : 0.0)));
    }
  }
};

const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                      .tension_N = 72.5,
                                      .fundamental_Hz = 660,
                                      .bending_stiffness_Nm2 = 4.7e-5,
                                      .loss = {.quality = 1000}},
                           .torsion = {.speed_ratio = 7, .impedance_ratio = 3.5, .quality = 15}};

/// Loops of the last 0.07 s of a stroke at 0.3 of the string.
template <class Law>
std::vector<rosin::slip_loop> loops_of(const Law& law) {
  const auto take = rosin::simulate_stroke(rig, law, rosin::steady_rod{.speed_m_s = rod_m_s, .normal_force_N = 0.3},
                                           {.position = 0.3, .duration_s = 0.15}, {.oversampling = 4});
  REQUIRE(take);
  const std::vector<double> force(take->contact_force_N.begin() + 10240, take->contact_force_N.end());
  std::vector<double> relative;
  for (std::size_t i = 10240; i < take->size(); ++i)
    relative.push_back(take->centre_velocity_m_s[i] + take->torsion_velocity_m_s[i] - take->rod_velocity_m_s[i]);
  return rosin::slip_loops(force, relative, rosin::find_phases(relative, rod_m_s), rod_m_s, rate_Hz);
}

}  // namespace

TEST_CASE("slip loops: an ellipse has the area pi a b, counter-clockwise where the force is high first") {
  for (const double way : {1.0, -1.0})
    for (const double early : {1.0, -1.0}) {
      ellipses e(way);
      for (double& f : e.force_N) f = way * e.mean_N + early * (f - way * e.mean_N);
      const auto phases = rosin::find_phases(e.relative_m_s, way * rod_m_s);
      const auto loops = rosin::slip_loops(e.force_N, e.relative_m_s, phases, way * rod_m_s, rate_Hz);
      REQUIRE(loops.size() == 20);
      const double a = e.speed_m_s / 2, b = e.swing_N;
      for (const auto& s : loops) {
        CHECK(s.area_W == test::approx(early * std::numbers::pi * a * b).epsilon(0.01));
        CHECK(s.fastest_m_s == test::approx(e.speed_m_s));
        // segment of a circle beyond half a radius, as an ellipse; its mean height over a width of a / 2
        const double segment = (std::numbers::pi / 3 - std::sqrt(3.0) / 4) * a * b;
        CHECK(s.fast_area_W == test::approx(early * segment).epsilon(0.02));
        CHECK(s.split_N() == test::approx(early * segment / (a / 2)).epsilon(0.02));
        CHECK(s.range_N == test::approx(2 * b));
        CHECK(s.onset_N == test::approx(e.mean_N + (early > 0 ? b : 0.0)).epsilon(0.01));
        CHECK(s.recapture_N == test::approx(e.mean_N).epsilon(0.05));
        // the swing of the force is odd about the middle of the slip: its mean does the work
        CHECK(s.distance_m() == test::approx(e.speed_m_s * 40 / rate_Hz / 2).epsilon(1e-6));
        CHECK(s.dissipated_J == test::approx(e.mean_N * s.distance_m()).epsilon(1e-6));
        CHECK(s.duration_s() == test::approx(40 / rate_Hz).epsilon(0.06));
      }
      const auto verdict = rosin::judge_loops(loops, 30 / rate_Hz);
      CHECK(verdict.loops == 20);
      CHECK(verdict.split_N == test::approx(loops[7].split_N()));
      CHECK(verdict.sense == (early > 0 ? rosin::loop_sense::counter_clockwise : rosin::loop_sense::clockwise));
      CHECK(rosin::judge_loops(loops, 50 / rate_Hz).loops == 0);
    }
}

TEST_CASE("slip loops: a force that depends on speed alone encloses nothing") {
  ellipses e;
  for (std::size_t i = 0; i < e.force_N.size(); ++i) e.force_N[i] = 0.1 + 0.1 / (1 - 3 * e.relative_m_s[i]);
  const auto loops = rosin::slip_loops(e.force_N, e.relative_m_s, rosin::find_phases(e.relative_m_s, rod_m_s), rod_m_s, rate_Hz);
  REQUIRE(loops.size() == 20);
  for (const auto& s : loops) CHECK(std::abs(s.area_W) < 1e-12);
  CHECK(rosin::judge_loops(loops).sense == rosin::loop_sense::none);
}

TEST_CASE("slip loops: places on the rod, what stuck before, and a string that creeps") {
  ellipses e;
  for (double& v : e.relative_m_s) v -= 0.004;
  const auto track = rosin::track_along(e.relative_m_s, rate_Hz);
  const auto phases = rosin::find_phases(e.relative_m_s, rod_m_s);
  const auto loops = rosin::slip_loops(e.force_N, e.relative_m_s, phases, rod_m_s, rate_Hz);
  REQUIRE(loops.size() == 20);
  CHECK(track.back() == test::approx(20 * 1.5 * 40 / rate_Hz / 2 + 0.004 * 3999 / rate_Hz).epsilon(1e-9));
  for (std::size_t k = 1; k < loops.size(); ++k) {
    CHECK(loops[k].from_m == test::approx(loops[k - 1].to_m + loops[k].crept_m).epsilon(1e-9));
    CHECK(loops[k].crept_m == test::approx(0.004 * loops[k].stuck_s).epsilon(0.02));
    CHECK(loops[k].stuck_s + loops[k].duration_s() == test::approx(200 / rate_Hz));
  }
}

TEST_CASE("slip loops: what reaches into the unknown is left out, and so is the ringing of a band limit") {
  ellipses e;
  for (std::size_t i = 0; i < 110; ++i) e.relative_m_s[i] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 3930; i < 4000; ++i) e.force_N[i] = e.relative_m_s[i] = std::numeric_limits<double>::quiet_NaN();
  e.relative_m_s[1170] = e.relative_m_s[1171] = -0.03;
  const auto phases = rosin::find_phases(e.relative_m_s, rod_m_s);
  CHECK(phases.slips.size() == 21);
  const auto loops = rosin::slip_loops(e.force_N, e.relative_m_s, phases, rod_m_s, rate_Hz);
  CHECK(loops.size() == 18);
  CHECK(rosin::slip_loops(e.force_N, e.relative_m_s, phases, rod_m_s, rate_Hz, 0.01).size() == 19);
  CHECK(rosin::slip_loops({}, {}, {}, rod_m_s, rate_Hz).empty());
  CHECK(rosin::judge_loops({}).sense == rosin::loop_sense::none);
}

TEST_CASE("slip loops: simulated friction of a velocity curve splits hardly, thermal friction to the same steady curve clearly") {
  const rosin::two_exponential_curve<double> curve{};
  const auto by_speed = loops_of(rosin::velocity_curve{curve});
  const rosin::contact_heat_parameters<double> heat{};
  const auto strength = rosin::design_yield_curve(curve, heat.without_string(), 0.3);
  REQUIRE(strength);
  const auto by_heat = loops_of(rosin::thermal_plastic<double>{*strength, heat});
  const auto speed = rosin::judge_loops(by_speed), thermal = rosin::judge_loops(by_heat);
  REQUIRE(speed.loops > 30);
  REQUIRE(thermal.loops > 30);
  CHECK(std::abs(speed.split_N) < 0.03 * speed.range_N);
  CHECK(speed.sense == rosin::loop_sense::none);
  CHECK(thermal.split_N > 0.15 * thermal.range_N);
  CHECK(thermal.sense == rosin::loop_sense::counter_clockwise);
  for (const auto& s : by_heat) CHECK(s.dissipated_J > 0);
}

}  // namespace friction_slip_loops
