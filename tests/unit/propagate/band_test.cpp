// SPDX-License-Identifier: MIT
#include <rosin/propagate/band.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

#include "support/approx.hpp"

namespace propagate_band {

namespace {

constexpr rosin::band lp{20e3, 60e3};

double as_printed(double f) {
  const double a = std::fmin(1.0, std::fmax(0.0, (f - lp.pass_Hz) / (lp.stop_Hz - lp.pass_Hz)));
  return 1 - std::pow(a, 4) * (35 - 84 * a + 70 * a * a - 20 * a * a * a);
}

}  // namespace

static_assert(lp(0) == 1 && lp(20e3) == 1 && lp(-60e3) == 0 && lp(1e9) == 0);

TEST_CASE("the window is the printed polynomial, even in frequency") {
  for (double f = 0; f <= 64e3; f += 250) {
    CHECK(lp(f) == test::approx(as_printed(f)).scale(1).epsilon(1e-13));
    CHECK(lp(-f) == lp(f));
  }
  CHECK(lp(40e3) == 0.5);
}

TEST_CASE("it falls monotonically, and three derivatives vanish at both edges") {
  for (double f = 20e3; f < 60e3; f += 100) CHECK(lp(f + 100) < lp(f));
  for (const double d : {1e-3, 1e-4}) {  // 35 d^4 to leading order, without cancellation
    CHECK(lp(60e3 - 40e3 * d) / (35 * std::pow(d, 4)) == test::approx(1).epsilon(3 * d));
    CHECK(1 - lp(20e3 + 40e3 * d) <= 36 * std::pow(d, 4) + 2e-14);
  }
}

TEST_CASE("a band without a transition is a step") {
  constexpr rosin::band step{1e3, 1e3};
  CHECK(step(1e3) == 1);
  CHECK(step(1000.001) == 0);
}

}  // namespace propagate_band
