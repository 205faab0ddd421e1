// SPDX-License-Identifier: MIT
#include <rosin/friction/elasto_plastic.hpp>

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace friction_elasto_plastic {

namespace {

using law_type = rosin::elasto_plastic<rosin::stribeck_curve<>>;
const rosin::stribeck_curve<> steady;

law_type usual_law() { return law_type{steady, {.kinetic = 0.507}}; }

}  // namespace

TEST_CASE("steady sliding gives back the curve") {
  for (const double v : {0.01, 0.1, 0.3, 1.0}) {
    auto law = usual_law();
    rosin::contact_force<double> contact;
    for (int i = 0; i < 30000; ++i) contact = law({0.0, 1e-7, v, 0.3, 1e-6});
    CAPTURE(v);
    CHECK(contact.force_N == test::approx(0.3 * steady(v).value).epsilon(1e-5));
    CHECK(contact.slipping);
  }
}

TEST_CASE("below breakaway it is a spring: all motion comes back, none of it counts as slip") {
  auto law = usual_law();
  const double s0 = 1e6 * 0.3, amplitude = 0.2e-6;  // breakaway is 0.7 * 0.507 / 1e6 = 0.355 um
  double moved = 0;
  for (int i = 1; i <= 3000; ++i) {
    const double next = amplitude * std::sin(2 * 3.14159265358979 * i / 1000);
    const auto contact = law({0.0, 1e-9, (next - moved) / 1e-6, 0.3, 1e-6});
    moved = next;
    CHECK(!contact.slipping);
    CHECK(std::abs(law.deflection_m()) <= 1.05 * amplitude);
    if (i % 1000 == 250) CHECK(contact.force_N == test::approx(s0 * amplitude).epsilon(0.01));
  }
  CHECK(std::abs(law.deflection_m()) < 0.02 * amplitude);
}

TEST_CASE("reaches friction within microns of the first movement") {
  auto law = usual_law();
  double travelled = 0, force = 0;
  while (force < 0.9 * 0.3 * steady(0.05).value && travelled < 1e-4) {
    force = law({0.0, 1e-9, 0.05, 0.3, 1e-7}).force_N;
    travelled += 0.05 * 1e-7;
  }
  CHECK(travelled > 0.8e-6);
  CHECK(travelled < 4e-6);
}

TEST_CASE("passive: whatever the string does, more energy goes in than is stored") {
  auto law = usual_law();
  double dissipated = 0, least = 0, last_force = 0, last_slip = 0;
  for (int i = 0; i < 40000; ++i) {
    const rosin::load_line<double> line{0.4 * std::sin(0.003 * i) + 0.3 * std::sin(0.171 * i), 2.0, 0.1, 0.3, 1e-6};
    const auto contact = law(line);
    CHECK(contact.converged);
    const double slip = line.slip(contact.force_N);
    dissipated -= (contact.force_N + last_force) / 2 * (slip + last_slip) / 2 * line.step_s;
    last_force = contact.force_N, last_slip = slip;
    least = std::min(least, dissipated - law.stored_J(0.3));
  }
  CHECK(least > -1e-12);
  CHECK(dissipated > 1e-4);
}

TEST_CASE("every answer lies on the load line's equation and moves on continuously") {
  auto law = usual_law();
  double last = 0, largest = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto contact = law({0.2 * std::sin(0.0007 * i), 2.0, 0.1, 0.3, 1e-6});
    CHECK(contact.converged);
    largest = std::max(largest, std::abs(contact.force_N - last));
    last = contact.force_N;
  }
  CHECK(largest < 0.02);
}

TEST_CASE("with the rod off nothing acts and the bristles are straight") {
  auto law = usual_law();
  for (int i = 0; i < 100; ++i) law({0.0, 1.0, 0.1, 0.3, 1e-6});
  CHECK(law.deflection_m() > 0);
  CHECK(law({0.0, 1.0, 0.1, 0.0, 1e-6}).force_N == 0.0);
  CHECK(law.deflection_m() == 0.0);
}

}  // namespace friction_elasto_plastic
