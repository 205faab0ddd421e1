// SPDX-License-Identifier: MIT
#include <rosin/math/chirp_z.hpp>

#include <rosin/math/fft.hpp>

#include <doctest/doctest.h>
#include <laws/fft_laws.hpp>

#include <complex>
#include <cstddef>

TEST_CASE_TEMPLATE("the chirp transform is the definition at any length", T, float, double) {
  using inner = rosin::eigen_fft<std::complex<T>>;
  for (const std::size_t n : laws::fft_lengths) laws::complex_transform_is_exact<T, rosin::chirp_z<T, inner>>(n);
}
