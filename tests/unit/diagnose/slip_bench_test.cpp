// SPDX-License-Identifier: MIT
#include <rosin/diagnose/slip_bench.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

namespace {

template <class Law>
std::array<contact_rigs::stroke, 2> under_ripple(const Law& law, double ripple_Hz, double relative) {
  auto slow = contact_rigs::slow(), fast = contact_rigs::fast();
  slow.normal_Hz = fast.normal_Hz = ripple_Hz;
  slow.normal_relative = fast.normal_relative = relative;
  return {contact_rigs::play(law, slow, contact_rigs::rolls, 51), contact_rigs::play(law, fast, contact_rigs::rolls, 53)};
}

}  // namespace

TEST_CASE("slip bench: a curve and a ripple of the normal force, found in turn") {
  const auto [a, b] = under_ripple(contact_rigs::curve(), 118, 0.2);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  rosin::stick_bench sticks(takes, contact_rigs::declared());
  const rosin::slip_bench bench(sticks, takes);
  REQUIRE(bench.usable());
  const auto both = bench.fit_under(118, false);
  CHECK(both.size() == test::approx(0.2).epsilon(0.02));
  for (const auto& r : both.relative) CHECK(std::abs(r) == test::approx(0.2).epsilon(0.02));
  CHECK(both.law.residual() < 0.2 * bench.declared().residual());
}

TEST_CASE("slip bench: heat that is known, under a normal force that the contact grows with") {
  const rosin::contact_heat_parameters<double> heat{.layer_m = 3e-6, .area_per_newton_m2 = 1e-7};
  const auto strength = rosin::design_yield_curve(rosin::two_exponential_curve<>{}, heat.without_string(), 0.3);
  REQUIRE(strength);
  const auto [a, b] = under_ripple(rosin::thermal_plastic<double>{*strength, heat}, 260, 0.15);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  auto model = contact_rigs::declared();
  model.law = rosin::contact_law::thermal, model.heat = {heat.layer_m, heat.area_per_newton_m2};
  rosin::stick_bench sticks(takes, model);
  const rosin::slip_bench bench(sticks, takes);
  REQUIRE(bench.usable());
  const auto both = bench.fit_under(260, true);
  CHECK(both.law.heat_memory);
  CHECK(both.size() == test::approx(0.15).epsilon(0.03));
  CHECK(both.law.residual() < 0.2 * bench.declared().residual());
}
