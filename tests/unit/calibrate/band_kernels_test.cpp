// SPDX-License-Identifier: MIT
#include <rosin/calibrate/band_kernels.hpp>

#include <doctest/doctest.h>

TEST_CASE("a band's kernel is designed once, and another band or rate has its own") {
  const rosin::band_kernels kernels;
  const rosin::band narrow{10e3, 16e3}, wide{30e3, 50e3};
  const rosin::fir& first = kernels.of(narrow, 128e3);
  CHECK(rosin::pass_band_error(
            first, [](double) { return 1.0; }, narrow, 128e3) < 2e-5);
  CHECK(std::abs(first.response(20e3, 128e3)) < 1e-4);
  CHECK(kernels.of(wide, 128e3).taps.size() < first.taps.size());
  CHECK(kernels.of(narrow, 96e3).taps != first.taps);
  CHECK(&kernels.of(narrow, 128e3) == &first);  // stays where it is while others come
}
