// SPDX-License-Identifier: MIT
#include <rosin/diagnose/law_choice.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

namespace {

template <class Law>
rosin::outcome<rosin::law_choice> chosen(const Law& law, std::uint64_t seed) {
  const auto a = contact_rigs::play(law, contact_rigs::slow(), contact_rigs::rolls, seed),
             b = contact_rigs::play(law, contact_rigs::fast(), contact_rigs::rolls, seed + 2);
  return rosin::choose_friction_law({a.take(), b.take()}, contact_rigs::declared());
}

}  // namespace

TEST_CASE("law choice: a velocity curve is told as one" * doctest::test_suite("long")) {
  const auto c = chosen(contact_rigs::curve(), 81);
  REQUIRE(c);
  CHECK(c->law == rosin::contact_law::velocity_curve);
  CHECK_FALSE(c->laws[1].counts());
  CHECK_FALSE(c->laws[2].counts());
}

TEST_CASE("law choice: heat is told from strokes that were not fitted" * doctest::test_suite("long")) {
  const rosin::two_exponential_curve<> steady;
  const rosin::contact_heat_parameters<double> heat{.layer_m = 3e-6, .area_per_newton_m2 = 1e-7};
  const auto strength = rosin::design_yield_curve(steady, heat.without_string(), 0.3);
  REQUIRE(strength);
  const auto c = chosen(rosin::thermal_plastic<double>{*strength, heat}, 85);
  REQUIRE(c);
  CHECK(c->law == rosin::contact_law::thermal);
  CHECK(c->margin > 50);
}

TEST_CASE("law choice: bristles, 60 us to give way, with their stiffness and how it goes with the normal force" *
          doctest::test_suite("long")) {
  const rosin::two_exponential_curve<> steady;
  const double per_newton = steady(0).value / (0.22 * 60e-6);
  const auto c = chosen(
      rosin::elasto_plastic<rosin::two_exponential_curve<>>{steady, {.stiffness_1_m = per_newton, .kinetic = steady.c}}, 89);
  REQUIRE(c);
  CHECK(c->law == rosin::contact_law::elasto_plastic);
  CHECK(c->margin > 200);
  REQUIRE(!c->laws[2].parameters.empty());
  const auto& s0 = c->laws[2].parameters.front();
  CHECK(s0.name == "bristle_stiffness_1_m");
  CHECK(s0.value == test::approx(per_newton).epsilon(0.1));
}

TEST_CASE("law choice: what is missing is said") {
  auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 93, 0.27, 0.05);
  auto take = a.take();
  take.normal_force_N = 0;
  const auto c = rosin::choose_friction_law({take}, contact_rigs::declared());
  REQUIRE_FALSE(c);
  CHECK(c.error().find("normal force") != std::string::npos);
}
