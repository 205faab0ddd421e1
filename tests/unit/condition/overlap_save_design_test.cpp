// SPDX-License-Identifier: MIT
#include <rosin/condition/overlap_save_design.hpp>

#include <doctest/doctest.h>

#include <complex>
#include <cstddef>
#include <vector>

#include "support/approx.hpp"

namespace condition_overlap_save_design {

namespace {

struct kernel {
  int first;
  std::vector<double> taps;
};
static_assert(rosin::FirKernel<kernel> && !rosin::FirKernel<std::vector<double>>);

}  // namespace

TEST_CASE("lags are those of the kernels that have taps") {
  const rosin::lag_range lags = rosin::lags_of<kernel>({{-3, {1, 2}}, {90, {}}, {4, {1, 1, 1}}});
  CHECK(lags.first == -3);
  CHECK(lags.last == 6);
  CHECK(lags.taps() == 10);
  CHECK(rosin::lags_of<kernel>({{7, {}}}).taps() == 1);
}

TEST_CASE("a and b carry two channels through four filters") {
  const double h[2][2] = {{0.5, -2}, {3, 0.25}};
  rosin::pair_kernels pair{4, -1};
  for (std::size_t output = 0; output < 2; ++output)
    for (std::size_t input = 0; input < 2; ++input) pair.add(kernel{1, {h[output][input]}}, output, input);
  const double x[2] = {0.7, -1.3};
  const std::complex<double> z{x[0], x[1]}, y = pair.a[2] * z + pair.b[2] * std::conj(z);
  CHECK(y.real() == test::approx(h[0][0] * x[0] + h[0][1] * x[1]).epsilon(1e-15));
  CHECK(y.imag() == test::approx(h[1][0] * x[0] + h[1][1] * x[1]).epsilon(1e-15));
  for (const std::size_t other : {0u, 1u, 3u}) CHECK(std::abs(pair.a[other]) + std::abs(pair.b[other]) == 0);
}

TEST_CASE("blocks are powers of two of at least twice the taps, and shorter where the cache is short") {
  for (std::size_t taps = 1; taps < 700; taps = taps * 3 / 2 + 1) {
    const std::size_t block = rosin::quickest_block(taps, 16);
    CHECK(block >= 2 * taps);
    CHECK((block & (block - 1)) == 0);
    CHECK(rosin::quickest_block(taps, 1024) <= block);
  }
}

}  // namespace condition_overlap_save_design
