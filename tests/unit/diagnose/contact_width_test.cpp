// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_width.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"

TEST_CASE("contact width: a contact at one point is not called wide") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 81);
  rosin::stick_bench bench({a.take()}, contact_rigs::declared());
  const auto h = rosin::width_hypothesis(bench, {a.take()});
  CHECK((!h || !h->decided));
}

TEST_CASE("contact width: of five places, some of which slide on now and then while others hold" * doctest::test_suite("long")) {
  constexpr double width_m = 3e-3;
  const auto a =
      contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 81, 0.27, 0.05, 0.3e-3, width_m, 5);
  rosin::stick_bench bench({a.take()}, contact_rigs::declared());
  const auto h = rosin::width_hypothesis(bench, {a.take()});
  REQUIRE(h);
  CHECK(h->decided);
  const auto& width = h->parameters[0];
  CHECK(std::abs(width.value / width_m - 1) < 0.1);
  CHECK(std::abs(width.value - width_m) < 2 * width.sd);
}

TEST_CASE("contact width: and torsion that nobody declared, each of which hides the other" * doctest::test_suite("long")) {
  constexpr double width_m = 3e-3;
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::fast(), {6, 3.4, 27}, 81, 0.2, 0.06, 0.3e-3, width_m, 5);
  rosin::stick_bench bench({a.take()}, {});
  const auto h = rosin::width_hypothesis(bench, {a.take()});
  REQUIRE(h);
  CHECK(std::abs(h->parameters[0].value / width_m - 1) < 0.1);
}
