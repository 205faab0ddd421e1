// SPDX-License-Identifier: MIT
#include <rosin/friction/enhanced_thermal.hpp>

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include <rosin/friction/yield_curve_design.hpp>

#include "support/approx.hpp"

namespace friction_enhanced_thermal {

namespace {

const rosin::power_law_curve<> steady;  // 0.2 (v + 0.011)^(-0.4)

rosin::enhanced_thermal<double> usual_law() {
  const rosin::contact_heat_parameters<> p;
  const auto shape = rosin::rod_shear_shape();
  return {*rosin::design_yield_curve(steady, shape, p, 0.3), shape, p};
}

}  // namespace

TEST_CASE("steady sliding gives back the revised curve") {
  for (const double v : {0.01, 0.05, 0.2, 0.6}) {
    auto law = usual_law();
    double force = 0, h = 2e-6;
    for (int i = 0; i < 4000; ++i, h = std::min(1.01 * h, 2e-3)) force = law({0.0, 1e-9, v, 0.3, h}).force_N;
    CAPTURE(v);
    CHECK(force == test::approx(0.3 * steady(v).value).epsilon(0.004));
  }
}

TEST_CASE("at a given temperature, faster shear yields the published ratio at once") {
  auto law = usual_law();
  const double slow = law({0.0, 1e-9, 0.05, 0.3, 1e-9}).force_N;
  law.reset();
  const double fast = law({0.0, 1e-9, 1.0, 0.3, 1e-9}).force_N;
  CHECK(fast / slow == test::approx(std::pow(1.35 / 0.40, -0.4)).epsilon(1e-6));
}

TEST_CASE("against the slip in both directions, no force without the rod, forgets on reset") {
  auto law = usual_law();
  int slipped = 0;
  for (int i = 0; i < 5000; ++i) {
    const rosin::load_line<double> line{2 * std::sin(0.011 * i), 3.0, 0.2, 0.3, 1e-6};
    const auto contact = law(line);
    CHECK(contact.converged);
    CHECK(contact.force_N * line.slip(contact.force_N) <= 1e-15);
    slipped += contact.slipping ? 1 : 0;
  }
  CHECK(slipped > 1000);
  CHECK(slipped < 4900);
  CHECK(law.temperature_rise_K() > 1);
  CHECK(law({1.0, 3.0, 0.2, 0.0, 1e-6}).force_N == 0.0);
  law.reset();
  CHECK(law.temperature_rise_K() == 0.0);
}

}  // namespace friction_enhanced_thermal
