// SPDX-License-Identifier: MIT
#include <rosin/friction/contact_heat.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace friction_contact_heat {

namespace {

constexpr double pi = 3.14159265358979323846;

/// No layer, no string: a half space under a constant flux.
rosin::contact_heat_parameters<double> rod_only() {
  rosin::contact_heat_parameters<double> p;
  p.layer_m = 1e-12;
  return p.without_string();
}

}  // namespace

TEST_CASE("a half space under constant flux warms as the square root of time") {
  // Theta = 2 q sqrt(D t / pi) / K (Carslaw and Jaeger)
  const auto p = rod_only();
  const double D = p.rod.conductivity_W_mK / (p.rod.density_kg_m3 * p.rod.heat_J_kgK);
  rosin::contact_heat<double> heat{p};
  const double normal = 0.3, area = p.area_per_newton_m2 * normal, flux = 1e6, h = 1e-6;
  for (int i = 1; i <= 20000; ++i) {
    const double rise = heat(flux * area, 0, normal, h), t = i * h;
    if (i == 50 || i == 500 || i == 5000 || i == 20000) {
      CAPTURE(t);
      CHECK(rise == test::approx(2 * flux * std::sqrt(D * t / pi) / p.rod.conductivity_W_mK).epsilon(i == 50 ? 0.02 : 0.006));
    }
  }
}

TEST_CASE("after a pulse of heat it cools as one over the square root of time") {
  // Theta = E / (K sqrt(pi t / D)), E heat per area
  const auto p = rod_only();
  const double D = p.rod.conductivity_W_mK / (p.rod.density_kg_m3 * p.rod.heat_J_kgK);
  rosin::contact_heat<double> heat{p};
  const double normal = 0.2, area = p.area_per_newton_m2 * normal, energy = 10, h = 1e-6;
  heat(energy * area / h, 0, normal, h);
  for (int i = 1; i <= 3000; ++i) {
    const double rise = heat(0, 0, normal, h), t = (i + 0.5) * h;
    if (i == 100 || i == 1000 || i == 3000)
      CHECK(rise == test::approx(energy / p.rod.conductivity_W_mK * std::sqrt(D / (pi * t))).epsilon(0.02));
  }
}

TEST_CASE("steady sliding on a fresh rod: K Theta sqrt(r / D) per area") {
  auto p = rod_only();
  const double normal = 0.3, area = p.area_per_newton_m2 * normal, radius = std::sqrt(area / pi);
  const double D = p.rod.conductivity_W_mK / (p.rod.density_kg_m3 * p.rod.heat_J_kgK);
  const rosin::contact_heat<double> heat{p};
  for (const double v : {0.01, 0.1, 0.5, 1.0, 2.0}) {
    CAPTURE(v);
    const double exact = area * p.rod.conductivity_W_mK * std::sqrt(3 * v / (8 * radius * D));
    CHECK(heat.steady_loss_W_K(v, normal) == test::approx(exact).epsilon(0.01));
  }
}

TEST_CASE("the steps settle to what the steady loss says, layer, rod and string together") {
  const rosin::contact_heat_parameters<double> p;
  for (const double v : {0.05, 0.5}) {
    rosin::contact_heat<double> heat{p};
    double rise = 0, h = 1e-6;
    for (int i = 0; i < 4000; ++i, h = std::min(h * 1.02, 0.01)) rise = heat(0.05, v, 0.3, h);
    CHECK(rise == test::approx(0.05 / heat.steady_loss_W_K(v, 0.3)).epsilon(1e-3));
  }
}

TEST_CASE("the layer's capacity rules the first microsecond") {
  rosin::contact_heat_parameters<double> p;
  p.rod = p.string = {};
  rosin::contact_heat<double> heat{p};
  const double rise = heat(0.1, 0, 0.3, 1e-6);
  CHECK(rise == test::approx(0.1 * 1e-6 / (0.3 * p.area_per_newton_m2 * p.layer_capacity_J_m2K())));
}

TEST_CASE("reset forgets all heat") {
  rosin::contact_heat<double> heat, fresh;
  for (int i = 0; i < 10; ++i) heat(0.1, 0.3, 0.3, 1e-6);
  heat.reset();
  CHECK(heat.temperature_rise_K() == 0.0);
  CHECK(heat(0.1, 0.3, 0.3, 1e-6) == fresh(0.1, 0.3, 0.3, 1e-6));
}

}  // namespace friction_contact_heat
