// SPDX-License-Identifier: MIT
#include <rosin/friction/yield_curve.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace friction_yield_curve {

TEST_CASE_TEMPLATE("straight between entries, held beyond the ends", T, float, double) {
  rosin::yield_curve<T> curve;
  curve.spacing_K = T(0.5);
  for (std::size_t i = 0; i < curve.entries; ++i) curve.value[i] = T(2) - T(0.001) * static_cast<T>(i);
  CHECK(curve(T(0)) == test::approx(2.0));
  CHECK(curve(T(0.5)) == test::approx(1.999));
  CHECK(curve(T(10.25)) == test::approx(2 - 0.0205));
  CHECK(curve(T(-7)) == test::approx(2.0));
  CHECK(curve(T(1e6)) == test::approx(2 - 0.001 * (curve.entries - 1)).epsilon(1e-5));
}

}  // namespace friction_yield_curve
