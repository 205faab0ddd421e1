// SPDX-License-Identifier: MIT
#include <rosin/acquire/rig_values.hpp>

#include <doctest/doctest.h>

#include <algorithm>

#include "support/approx.hpp"

namespace acquire_rig_values {

namespace {

rosin::rig paper_rig() {
  rosin::rig r;
  r.string.fundamental_Hz = 660;
  r.string.length_m = 0.314;
  r.string.tension_N = 72.5;
  r.contact_position = 0.3;
  return r;
}

bool says(const rosin::rig_values& values, const std::string& sentence) {
  return std::find(values.assumed.begin(), values.assumed.end(), sentence) != values.assumed.end();
}

}  // namespace

TEST_CASE("impedance follows from tension and fundamental, and says so") {
  const auto v = rosin::values_of(paper_rig());
  CHECK(v.wave_speed_m_s.value() == test::approx(414.48));
  CHECK(v.impedance_Ns_m->value == test::approx(0.174918).epsilon(1e-5));
  CHECK(v.linear_density_kg_m.value() == test::approx(72.5 / (414.48 * 414.48)));
  CHECK(says(v, "impedance_Ns_m = 0.1749, from tension and fundamental"));
  CHECK(says(v, "tension_tolerance = 0.02, none given"));
}

TEST_CASE("a tolerance is two standard deviations, and one that was given needs no sentence") {
  rosin::rig r = paper_rig();
  r.string.tension_tolerance = 0.04;
  r.position_tolerance = 0.01;
  const auto v = rosin::values_of(r);
  CHECK(v.tension_N->sd == test::approx(72.5 * 0.02));
  CHECK(v.position->sd == test::approx(0.005));
  CHECK(v.fundamental_Hz.sd == test::approx(660 * 0.0015));
  CHECK(v.impedance_Ns_m->sd == test::approx(v.impedance_Ns_m->value * std::hypot(0.02, 0.0015)));
  CHECK_FALSE(says(v, "tension_tolerance = 0.02, none given"));
}

TEST_CASE("an impedance that was given is taken as it is") {
  rosin::rig r = paper_rig();
  r.string.impedance_Ns_m = 0.175;
  const auto v = rosin::values_of(r);
  CHECK(v.impedance_Ns_m->value == 0.175);
  CHECK_FALSE(says(v, "impedance_Ns_m = 0.1749, from tension and fundamental"));
}

TEST_CASE("the wire's material stands in for what was not measured") {
  rosin::rig r = paper_rig();
  r.string.tension_N.reset();
  CHECK_FALSE(rosin::values_of(r).impedance_Ns_m);
  r.string.diameter_m = 0.26e-3;
  r.string.density_kg_m3 = 7850;
  r.string.youngs_modulus_Pa = 2.0e11;
  const auto v = rosin::values_of(r);
  // 4.168e-4 kg/m for steel of this radius
  CHECK(v.linear_density_kg_m.value() == test::approx(4.168e-4).epsilon(1e-3));
  CHECK(v.tension_N->value == test::approx(4.168e-4 * 414.48 * 414.48).epsilon(1e-3));
  CHECK(v.bending_stiffness_Nm2->value == test::approx(4.486e-5).epsilon(1e-3));
}

TEST_CASE("without length there is nothing in SI units, and nothing is made up") {
  rosin::rig r;
  r.string.fundamental_Hz = 196;
  const auto v = rosin::values_of(r);
  CHECK(v.fundamental_Hz.value == 196);
  CHECK_FALSE(v.impedance_Ns_m);
  CHECK_FALSE(v.wave_speed_m_s);
  CHECK_FALSE(v.position);
}

TEST_CASE("gains and forces without a tolerance get the default, named by channel and take") {
  rosin::rig r = paper_rig();
  r.channels.resize(1);
  r.channels[0].name = "near";
  r.takes.resize(1);
  r.takes[0].name = "p";
  r.takes[0].force_N = 1;
  const auto v = rosin::values_of(r);
  CHECK(says(v, "channels.near.gain_tolerance = 0.05, none given"));
  CHECK(says(v, "force_tolerance of take p = 0.03, none given"));
  CHECK(rosin::gain_tolerance_of(r.channels[0]) == 0.05);
  CHECK(rosin::force_tolerance_of(r.takes[0]) == 0.03);
}

}  // namespace acquire_rig_values
