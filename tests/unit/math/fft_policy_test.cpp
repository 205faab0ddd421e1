// SPDX-License-Identifier: MIT
#include <rosin/math/fft_policy.hpp>

#include <rosin/math/fft.hpp>

#include <doctest/doctest.h>

#include <complex>
#include <cstddef>

static_assert(rosin::RealFft<rosin::eigen_fft<double>, double>);
static_assert(rosin::ComplexFft<rosin::eigen_fft<std::complex<float>>, float>);
static_assert(!rosin::RealFft<rosin::eigen_fft<double>, float>, "precisions are not mixed");
static_assert(!rosin::RealFft<rosin::eigen_fft<std::complex<double>>, double>);
static_assert(!rosin::ComplexFft<rosin::eigen_fft<double>, double>);

static_assert(rosin::largest_prime_factor(1) == 1 && rosin::largest_prime_factor(17921) == 17921);
static_assert(rosin::largest_prime_factor(1280000) == 5 && rosin::largest_prime_factor(9 * 1009) == 1009);

TEST_CASE("a fast size is the smallest one above without a prime factor beyond five") {
  const auto smooth = [](std::size_t n) {
    for (const std::size_t p : {2u, 3u, 5u})
      while (n % p == 0) n /= p;
    return n == 1;
  };
  CHECK(rosin::fast_size(0) == 1);
  std::size_t expected = 1;
  for (std::size_t n = 1; n <= 5000; ++n) {
    while (expected < n || !smooth(expected)) ++expected;
    CHECK(rosin::fast_size(n) == expected);
  }
  CHECK(rosin::fast_size(1280001) == 1296000);
}
