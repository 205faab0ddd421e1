// SPDX-License-Identifier: MIT
#include <rosin/diagnose/bristle_yield.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("bristle yield: by what the surface moves faster than they bend") {
  using rosin::bristle_yield;
  CHECK(bristle_yield{}.faster(0.3, 0.4, 0.01) == 1);  // nothing known of a limit: they only bend
  const bristle_yield at_once{.limit = 1};
  CHECK(at_once.faster(0.2, 0.4, 0.01) == test::approx(2));         // half of the limit: half of the motion is flow
  CHECK(at_once.faster(0.2, 0.4, -0.01) == test::approx(1 / 1.5));  // the other way flow goes along with the spring
  CHECK(at_once.faster(10, 0.4, 0.01) == test::approx(5));
  const bristle_yield later{.limit = 1, .elastic = 0.5};
  CHECK(later.faster(0.19, 0.4, 0.01) == 1);
  CHECK(later.faster(0.3, 0.4, -0.01) == 1);
  CHECK(later.faster(0.3, 0.4, 0.01) == test::approx(1 / (1 - 0.5 * 0.75)));  // in the middle alpha is one half
  const bristle_yield weaker{.limit = 1, .weakening_s_m = 10};
  const double faster = weaker.faster(0.1, 0.4, 0.01);
  CHECK(faster == test::approx(1 / (1 - 0.25 * (1 + 10 * 0.01 * faster))).epsilon(2e-3));
}
