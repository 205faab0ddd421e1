// SPDX-License-Identifier: MIT
#include <rosin/friction/thermal_plastic.hpp>

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include <rosin/friction/yield_curve_design.hpp>

#include "support/approx.hpp"

namespace friction_thermal_plastic {

namespace {

rosin::thermal_plastic<double> usual_law(double normal = 0.3) {
  const rosin::contact_heat_parameters<> p;
  return {*rosin::design_yield_curve(rosin::two_exponential_curve<>{}, p, normal), p};
}

/// A string that is held: the rod slides over it at a speed.
rosin::load_line<double> held(double speed, double step) { return {0.0, 1e-9, speed, 0.3, step}; }

}  // namespace

TEST_CASE("steady sliding gives back the curve it was made from") {
  const rosin::two_exponential_curve<> steady;
  for (const double v : {0.01, 0.05, 0.2, 0.6}) {
    auto law = usual_law();
    double force = 0, h = 2e-6;
    for (int i = 0; i < 4000; ++i, h = std::min(1.01 * h, 2e-3)) force = law(held(v, h)).force_N;
    CAPTURE(v);
    CHECK(force == test::approx(0.3 * steady(v).value).epsilon(0.004));
  }
}

TEST_CASE("sliding that comes and goes draws a counter-clockwise loop in the plane of slip speed and force") {
  auto law = usual_law();
  double enclosed = 0, last_force = 0, last_slip = 0;  // area = integral of slip d force
  for (int i = 0; i < 60000; ++i) {
    const auto line = held(0.6 + 0.55 * std::sin(2 * 3.14159265358979 * 660 * i * 1e-6), 1e-6);
    const auto contact = law(line);
    const double slip = line.slip(contact.force_N);
    REQUIRE(contact.slipping);
    if (i > 30000) enclosed += (slip + last_slip) / 2 * (contact.force_N - last_force);
    last_force = contact.force_N, last_slip = slip;
  }
  CHECK(enclosed > 0.01);
}

TEST_CASE("sticks up to the strength of cold rosin, less after heating, and recovers") {
  auto law = usual_law();
  const auto line = [](double sticking, double step = 1e-6) { return rosin::load_line<double>{0.0, 1.0, sticking, 0.3, step}; };
  CHECK(!law(line(0.359)).slipping);
  CHECK(law(line(0.361)).slipping);
  for (int i = 0; i < 2000; ++i) law(held(1.0, 1e-6));
  CHECK(law.temperature_rise_K() > 10);
  CHECK(law(line(0.2)).slipping);
  for (int i = 0; i < 2000; ++i) law(line(0.01, 5e-5));
  CHECK(!law(line(0.2)).slipping);
  law.reset();
  CHECK(law.temperature_rise_K() == 0.0);
}

TEST_CASE("never feeds energy in; with the rod off there is no force") {
  auto law = usual_law();
  for (int i = 0; i < 5000; ++i) {
    const rosin::load_line<double> line{std::sin(0.011 * i) + 0.2 * std::sin(0.9 * i), 3.0, 0.2, 0.3 + 0.1 * std::sin(0.002 * i),
                                        1e-6};
    const auto contact = law(line);
    CHECK(contact.force_N * line.slip(contact.force_N) <= 1e-15);
    CHECK(contact.temperature_rise_K >= 0);
  }
  CHECK(law({1.0, 3.0, 0.2, 0.0, 1e-6}).force_N == 0.0);
  CHECK(law({1.0, 3.0, 0.2, -1.0, 1e-6}).slipping);
}

}  // namespace friction_thermal_plastic
