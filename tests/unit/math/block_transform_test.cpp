// SPDX-License-Identifier: MIT
#include <rosin/math/block_transform.hpp>

#include <rosin/math/fft.hpp>
#include <rosin/math/lane_fft.hpp>

#include <doctest/doctest.h>
#include <laws/fft_laws.hpp>

#include <complex>
#include <cstddef>
#include <vector>

#include "support/approx.hpp"

static_assert(rosin::LaneFft<rosin::lane_fft<float>, float> && !rosin::LaneFft<rosin::eigen_fft<std::complex<float>>, float>);
static_assert(rosin::block_transform<double, rosin::eigen_fft<std::complex<double>>>::lanes == 1);

TEST_CASE_TEMPLATE("both kinds of transform give the same bins where position() says, and come back", Fft,
                   rosin::lane_fft<double>, rosin::lane_fft<double, 1>, rosin::eigen_fft<std::complex<double>>) {
  const std::size_t n = 64;
  rosin::block_transform<double, Fft> fft(n);
  constexpr std::size_t lanes = rosin::block_transform<double, Fft>::lanes;
  const std::vector<std::complex<double>> x = laws::noise<std::complex<double>>(n, 3);
  auto data = fft.make_buffer();
  for (std::size_t j = 0; j < n; ++j) {
    data[2 * j * lanes] = x[j].real();
    data[(2 * j + 1) * lanes] = x[j].imag();
  }
  fft.forward(data);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t at = 2 * fft.position(k) * lanes;
    const auto expected = laws::bin_by_definition(x, k);
    CHECK(std::abs(std::complex<double>{data[at], data[at + lanes]} - std::complex<double>{expected}) < 1e-13);
  }
  fft.inverse(data);
  for (std::size_t j = 0; j < n; ++j)
    CHECK(data[2 * j * lanes] / fft.gain() == test::approx(x[j].real()).scale(1).epsilon(1e-14));
}
