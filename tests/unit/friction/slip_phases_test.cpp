// SPDX-License-Identifier: MIT
#include <rosin/friction/slip_phases.hpp>

#include <doctest/doctest.h>

#include <limits>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include "support/approx.hpp"

namespace friction_slip_phases {

namespace {

const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                      .tension_N = 72.5,
                                      .fundamental_Hz = 660,
                                      .bending_stiffness_Nm2 = 4.7e-5,
                                      .loss = {.quality = 1000}},
                           .torsion = {.speed_ratio = 7, .impedance_ratio = 3.5, .quality = 15}};

std::vector<double> relative(const rosin::modal_take& t, double torsion) {
  std::vector<double> v(t.size());
  for (std::size_t i = 0; i < v.size(); ++i)
    v[i] = t.centre_velocity_m_s[i] + torsion * t.torsion_velocity_m_s[i] - t.rod_velocity_m_s[i];
  return v;
}

}  // namespace

TEST_CASE("slip phases: intervals made by hand are found, to the sample, under ripple and an offset of the scale") {
  std::vector<double> v(4000);
  std::vector<char> slips(v.size(), 0);
  for (std::size_t i = 0; i < v.size(); ++i) {
    slips[i] = i % 200 >= 160 ? 1 : 0;
    v[i] = 0.004 + 0.01 * std::sin(0.7 * static_cast<double>(i)) - (slips[i] ? 0.8 : 0.0);
  }
  const auto p = rosin::find_phases(v, 0.2);
  CHECK(p.slips.size() == 20);
  CHECK(p.sticks.size() == 20);
  CHECK(p.sticking() == test::approx(0.8));
  CHECK(p.level_m_s == test::approx(0.004).epsilon(1.0));
  for (const auto& s : p.slips)
    for (std::size_t i = s.begin; i < s.end; ++i) CHECK(slips[i] == 1);
  for (double& x : v) x = -x;  // a stroke the other way
  const auto back = rosin::find_phases(v, -0.2);
  CHECK(back.slips.size() == 20);
  CHECK(back.level_m_s == test::approx(-p.level_m_s));
}

TEST_CASE("slip phases: unknown samples belong to nothing; nothing known is nothing found") {
  std::vector<double> v(300, 0.0);
  for (std::size_t i = 100; i < 120; ++i) v[i] = -1;
  for (std::size_t i = 0; i < 10; ++i) v[i] = v[299 - i] = std::numeric_limits<double>::quiet_NaN();
  const auto p = rosin::find_phases(v, 0.2);
  REQUIRE(p.sticks.size() == 2);
  CHECK(p.sticks[0].begin == 10);
  CHECK(p.sticks[1].end == 290);
  CHECK(p.known == 280);
  for (double& x : v) x = std::numeric_limits<double>::quiet_NaN();
  CHECK(rosin::find_phases(v, 0.2).sticks.empty());
  CHECK(rosin::find_phases({}, 0.2).known == 0);
}

TEST_CASE("slip phases: the interior keeps clear of both ends") {
  const auto inside = rosin::interior({{5, 15}, {20, 25}}, 30, 3);
  for (std::size_t i = 0; i < 30; ++i) CHECK(inside[i] == (i >= 8 && i < 12 ? 1 : 0));
}

TEST_CASE("slip phases: a simulated stroke, with torsion and without knowing of it") {
  const auto take = rosin::simulate_stroke(rig, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                                           rosin::steady_rod{.speed_m_s = 0.2, .normal_force_N = 0.3},
                                           {.position = 0.3, .duration_s = 0.06}, {.oversampling = 4});
  REQUIRE(take);
  const auto whole = rosin::find_phases(relative(*take, 1), 0.2);
  CHECK(whole.fluctuation_m_s < 0.02 * 0.2 + 0.002);
  CHECK(whole.sticking() > 0.3);
  CHECK(whole.sticking() < 0.95);
  // inside what is called sticking the surface moves with the rod, although the simulation's low-pass rings
  const auto inside = rosin::interior(whole.sticks, take->size(), 4);
  const auto r = relative(*take, 1);
  std::size_t late = 0, off = 0;
  for (std::size_t i = 2500; i < r.size(); ++i)
    late += inside[i] ? 1U : 0U, off += inside[i] && std::abs(r[i]) > 0.05 * 0.2 ? 1U : 0U;
  CHECK(late > 500);
  CHECK(static_cast<double>(off) < 0.1 * static_cast<double>(late));
  // without torsion the threshold widens with the ripple, and about the same share sticks
  const auto centre = rosin::find_phases(relative(*take, 0), 0.2);
  CHECK(centre.fluctuation_m_s > 3 * whole.fluctuation_m_s);
  CHECK(centre.sticking() == test::approx(whole.sticking()).epsilon(0.35));
}

}  // namespace friction_slip_phases
