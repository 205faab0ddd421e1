// SPDX-License-Identifier: MIT
#include <rosin/friction/yield_curve_design.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace friction_yield_curve_design {

TEST_CASE("the table turns the steady temperature round") {
  // Woodhouse and Galluzzo's Eq. (5): N mu v = v a delta rho c Theta + Theta A K sqrt(3 v / (8 a D)), no string
  const rosin::two_exponential_curve<> steady;
  const auto p = rosin::contact_heat_parameters<>{}.without_string();
  const double N = 0.3, A = p.area_per_newton_m2 * N, a = std::sqrt(A / 3.14159265358979);
  const double D = p.rod.conductivity_W_mK / (p.rod.density_kg_m3 * p.rod.heat_J_kgK);
  const auto table = rosin::design_yield_curve(steady, p, N);
  REQUIRE(table);
  for (const double v : {0.003, 0.01, 0.05, 0.2, 1.0}) {
    const double mu = steady(v).value;
    const double loss = v * a * p.layer_capacity_J_m2K() + A * p.rod.conductivity_W_mK * std::sqrt(3 * v / (8 * a * D));
    CAPTURE(v);
    CHECK((*table)(N * mu * v / loss) == test::approx(mu).epsilon(0.015));
  }
  CHECK(table->value.front() == test::approx(1.2));
  CHECK(table->value.back() == test::approx(0.35).epsilon(1e-4));
}

TEST_CASE("a shape that the law keeps explicit is divided out") {
  const rosin::power_law_curve<> steady, shape{0.37, 0.35, -0.4};
  const rosin::contact_heat_parameters<> p;
  const auto plain = rosin::design_yield_curve(steady, p, 0.3);
  const auto shaped = rosin::design_yield_curve(steady, shape, p, 0.3);
  REQUIRE(plain);
  REQUIRE(shaped);
  CHECK(shaped->value.front() == test::approx(plain->value.front() / shape(0).value));
  CHECK(shaped->value.back() == test::approx(plain->value.back() / shape(5).value));
}

TEST_CASE("what cannot be turned round is refused with the speed at which it fails") {
  rosin::two_exponential_curve<> cliff;  // friction power falls where mu falls faster than 1 / v
  cliff.a = 40;
  const auto table = rosin::design_yield_curve(cliff, rosin::contact_heat_parameters<>{}, 0.3);
  REQUIRE(!table);
  CHECK(table.error().find("falls with speed at 0.0") != std::string::npos);
  CHECK(!rosin::design_yield_curve(rosin::two_exponential_curve<>{}, rosin::contact_heat_parameters<>{}, 0.0));
}

}  // namespace friction_yield_curve_design
