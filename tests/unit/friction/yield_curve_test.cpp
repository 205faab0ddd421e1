// SPDX-License-Identifier: MIT
#include <rosin/friction/yield_curve.hpp>

#include <doctest/doctest.h>

TEST_CASE_TEMPLATE("straight between entries, held beyond the ends", T, float, double) {
  rosin::yield_curve<T> curve;
  curve.spacing_K = T(0.5);
  for (std::size_t i = 0; i < curve.entries; ++i) curve.value[i] = T(2) - T(0.001) * static_cast<T>(i);
  CHECK(curve(T(0)) == doctest::Approx(2.0));
  CHECK(curve(T(0.5)) == doctest::Approx(1.999));
  CHECK(curve(T(10.25)) == doctest::Approx(2 - 0.0205));
  CHECK(curve(T(-7)) == doctest::Approx(2.0));
  CHECK(curve(T(1e6)) == doctest::Approx(2 - 0.001 * (curve.entries - 1)).epsilon(1e-5));
}
