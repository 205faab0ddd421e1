// SPDX-License-Identifier: MIT
#include <rosin/friction/friction_curves.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace friction_friction_curves {

namespace {

template <class Curve>
void is_a_falling_curve_with_its_own_slope() {
  const Curve curve;
  for (double v = 1e-4; v < 2; v *= 1.3) {
    const double h = 1e-5 * v;
    CAPTURE(v);
    CHECK(curve(v).slope == test::approx((curve(v + h).value - curve(v - h).value) / (2 * h)).scale(0.1).epsilon(1e-6));
    CHECK(curve(v).slope < 0);
    CHECK(curve(v).value > 0);
  }
}

template <class Curve>
void is_convex_where_it_says() {
  const Curve curve;
  const double from = curve.convex_from();
  for (double v = from + 1e-5; v < 2; v *= 1.3) {
    CAPTURE(v);
    CHECK(curve(v * 1.01).slope >= curve(v).slope);
  }
  for (double v = 0.1 * from; v < 0.9 * from; v += 0.1 * from) CHECK(curve(v * 1.01).slope < curve(v).slope);
}

}  // namespace

TEST_CASE_TEMPLATE("curves of steady sliding", Curve, rosin::two_exponential_curve<>, rosin::hyperbolic_curve<>,
                   rosin::stribeck_curve<>, rosin::power_law_curve<>) {
  is_a_falling_curve_with_its_own_slope<Curve>();
  is_convex_where_it_says<Curve>();
}

TEST_CASE("values at rest and far out, from the sources") {
  CHECK(rosin::two_exponential_curve<>{}(0).value == test::approx(1.2));
  CHECK(rosin::two_exponential_curve<>{}(5).value == test::approx(0.35));
  CHECK(rosin::two_exponential_curve<>{}(0).slope == test::approx(-44.5));  // N |mu'(0)| = 13.4 N s/m at 0.3 N
  CHECK(rosin::hyperbolic_curve<>{}(0).value == test::approx(0.8));
  CHECK(rosin::hyperbolic_curve<>{}(0.2).value == test::approx(0.6));
  CHECK(rosin::stribeck_curve<>{}(0).value == test::approx(1.021));
  CHECK(rosin::stribeck_curve<>{}(0.228).value == test::approx(0.507 + 0.514 / std::exp(1.0)));
  CHECK(rosin::power_law_curve<>{}(1 - 0.011).value == test::approx(0.2));
}

TEST_CASE("single precision gives the same curve") {
  for (float v = 0.001F; v < 1; v *= 2)
    CHECK(rosin::two_exponential_curve<float>{}(v).value ==
          test::approx(rosin::two_exponential_curve<>{}(static_cast<double>(v)).value).epsilon(1e-5));
}

}  // namespace friction_friction_curves
