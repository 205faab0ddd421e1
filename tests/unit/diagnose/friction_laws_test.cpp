// SPDX-License-Identifier: MIT
#include <rosin/diagnose/friction_laws.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"

namespace {

/// Slips made by hand: speeds of many shapes, a force by one law or the other.
std::vector<rosin::slip_record> by_hand(bool thermal) {
  std::vector<rosin::slip_record> records;
  for (const double strength : {1.0, 1.4}) {
    rosin::slip_record r;
    r.rate_Hz = 128e3, r.normal_N = 0.3 * strength;
    double heat = 0;
    for (std::size_t i = 0; i < 20000; ++i) {
      const std::size_t at = i % 250, slip = i / 250;
      const double size = 0.4 + 0.3 * std::sin(1.7 * static_cast<double>(slip)), u = static_cast<double>(at) / 100;
      const double v = at < 100 ? strength * size * std::sin(std::numbers::pi * u) * (1 + 0.4 * std::sin(11 * u)) + 0.05 : 0;
      const double mu = thermal ? 0.4 + 0.5 * std::exp(-heat / 0.05) : 0.4 + 0.5 * std::exp(-v / 0.15), f = r.normal_N * mu;
      heat = heat * std::exp(-(400 + 2500 * v) / r.rate_Hz) + (v > 0 ? v * f * 1e3 / r.rate_Hz : 0);
      r.force_N.push_back(v > 0 ? f : 0.2 * r.normal_N);
      r.relative_m_s.push_back(-v);
    }
    r.phases = rosin::find_phases(r.relative_m_s, 0.2, {.least = 0.1});
    r.slips = rosin::slips_of(r.force_N, r.relative_m_s, r.phases, 0.2, r.normal_N, 0, 2);
    records.push_back(std::move(r));
  }
  return records;
}

}  // namespace

TEST_CASE("friction laws: the law that made the force explains it, on takes it has not seen too") {
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
      CHECK(heat.rates.conduction_1_s + 0.5 * heat.rates.exchange_1_m == doctest::Approx(400 + 0.5 * 2500).epsilon(0.4));
    }
  }
}

TEST_CASE("friction laws: thermal friction of a simulated stroke, reconstructed") {
  const rosin::two_exponential_curve<> steady;
  const rosin::contact_heat_parameters<double> heat{.layer_m = 3e-6, .area_per_newton_m2 = 1e-7};
  const auto strength = rosin::design_yield_curve(steady, heat.without_string(), 0.3);
  REQUIRE(strength);
  const rosin::thermal_plastic<double> law{*strength, heat};
  const auto a = contact_rigs::play(law, contact_rigs::slow(), contact_rigs::rolls, 71), b = contact_rigs::play(law, contact_rigs::fast(), contact_rigs::rolls, 73);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  rosin::stick_bench sticks(takes, contact_rigs::declared());
  const auto records = rosin::slip_records(sticks, takes);
  const auto curve = rosin::fit_velocity_curve(records, 0.003), thermal = rosin::fit_thermal(records, 0.003);
  CHECK(thermal.residual() < 0.6 * curve.residual());
  CHECK(thermal.fit.density > curve.fit.density + 200);
}
