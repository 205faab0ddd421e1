// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_structure.hpp>

#include <doctest/doctest.h>

#include "pickup_plucks.hpp"
#include "support/approx.hpp"

using namespace rosin;

namespace {

structure_hypothesis likeliest(const rosin_test::heard_string& s) {
  const auto r = listen(s.pluck("a", 0.13, 2, 1), 220);
  REQUIRE(r);
  return structures_of({*r}, {true, true, false, false, {true}}).front();
}

}  // namespace

TEST_CASE("structures_of: nothing, a glide, a pair, and both" * doctest::test_suite("long")) {
  rosin_test::heard_string s;
  const auto none = likeliest(s);
  CHECK_FALSE(none.glides);
  CHECK_FALSE(none.paired);
  CHECK_FALSE(none.doubled);

  s.burden.axial_stiffness_N = 2000;
  const auto glide = likeliest(s);
  CHECK(glide.glides);
  CHECK_FALSE(glide.paired);

  s.detuning = 0.002, s.coupling = 0.4;
  const auto both = likeliest(s);
  CHECK(both.glides);
  CHECK(both.paired);
  CHECK(both.pair.detuning == test::approx(0.002).epsilon(0.02));

  s.burden.axial_stiffness_N = 0;
  const auto pair = likeliest(s);
  CHECK_FALSE(pair.glides);
  CHECK(pair.paired);
}
