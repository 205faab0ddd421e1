// SPDX-License-Identifier: MIT
#include <rosin/diagnose/friction_laws.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"
#include "slips_by_hand.hpp"
#include "support/approx.hpp"

namespace {

/// Friction by a heat that decays, the faster the faster it slips.
struct fading_heat {
  double heat = 0;
  double operator()(double v, double normal_N) {
    const double mu = 0.4 + 0.5 * std::exp(-heat / 0.05);
    heat = heat * std::exp(-(400 + 2500 * v) / rosin_test::slip_rate_Hz) + v * normal_N * mu * 1e3 / rosin_test::slip_rate_Hz;
    return mu;
  }
};

std::vector<rosin::slip_record> by_hand(bool thermal) {
  std::vector<rosin::slip_record> records;
  for (const double strength : {1.0, 1.4})
    records.push_back(thermal ? rosin_test::slips_by_hand(strength, 20000, 0.4, fading_heat{})
                              : rosin_test::slips_by_hand(strength, 20000, 0.4, rosin_test::curve_by_hand{}));
  return records;
}

}  // namespace

TEST_CASE("friction laws: the law that made the force explains it, on takes it has not seen too" * doctest::test_suite("long")) {
  for (const bool thermal : {false, true}) {
    const auto records = by_hand(thermal);
    const auto curve = rosin::fit_velocity_curve(records, 1e-4), heat = rosin::fit_thermal(records, 1e-4);
    const auto& right = thermal ? heat : curve;
    const auto& wrong = thermal ? curve : heat;
    CHECK(right.residual() < 0.01);
    CHECK(wrong.residual() > 3 * right.residual());
    CHECK(right.fit.held_out > wrong.fit.held_out + 500);
    if (thermal) {
      CHECK(heat.rates.capacity_power == 0);
      CHECK(heat.rates.conduction_1_s + 0.5 * heat.rates.exchange_1_m == test::approx(400 + 0.5 * 2500).epsilon(0.4));
    }
  }
}

TEST_CASE("friction laws: thermal friction of a simulated stroke, reconstructed" * doctest::test_suite("long")) {
  const rosin::two_exponential_curve<> steady;
  const rosin::contact_heat_parameters<double> heat{.layer_m = 3e-6, .area_per_newton_m2 = 1e-7};
  const auto strength = rosin::design_yield_curve(steady, heat.without_string(), 0.3);
  REQUIRE(strength);
  const rosin::thermal_plastic<double> law{*strength, heat};
  const auto a = contact_rigs::play(law, contact_rigs::slow(), contact_rigs::rolls, 71),
             b = contact_rigs::play(law, contact_rigs::fast(), contact_rigs::rolls, 73);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  rosin::stick_bench sticks(takes, contact_rigs::declared());
  const auto records = rosin::slip_records(sticks, takes);
  const auto curve = rosin::fit_velocity_curve(records, 0.003), thermal = rosin::fit_thermal(records, 0.003);
  CHECK(thermal.residual() < 0.6 * curve.residual());
  CHECK(thermal.fit.density > curve.fit.density + 200);
}
