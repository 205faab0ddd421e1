// SPDX-License-Identifier: MIT
#include <rosin/math/fft.hpp>

#include <doctest/doctest.h>
#include <laws/fft_laws.hpp>

#include <complex>
#include <cstddef>
#include <ctime>
#include <vector>

#include "support/approx.hpp"

TEST_CASE_TEMPLATE("Eigen's transform is the definition at any length", T, float, double) {
  for (const std::size_t n : laws::fft_lengths) {
    laws::real_transform_is_exact<T, rosin::eigen_fft<T>>(n);
    laws::complex_transform_is_exact<T, rosin::eigen_fft<std::complex<T>>>(n);
  }
}

TEST_CASE("a copy of a plan works by itself") {
  for (const std::size_t n : {24u, 97u}) {
    rosin::eigen_fft<double> first(n);
    rosin::eigen_fft<double> second = first;
    const std::vector<double> x = laws::noise<double>(n, 1);
    std::vector<std::complex<double>> a(n / 2 + 1), b(n / 2 + 1);
    first.forward(x.data(), a.data());
    second.forward(x.data(), b.data());
    CHECK(a == b);
  }
}

TEST_CASE("a large prime does not take quadratic time") {
  const std::size_t prime = 99991;  // 1e10 operations by the definition
  rosin::eigen_fft<double> fft(prime);
  const std::vector<double> x(prime, 1.0);
  std::vector<std::complex<double>> bins(prime / 2 + 1);
  const std::clock_t begin = std::clock();
  fft.forward(x.data(), bins.data());
  CHECK(std::clock() - begin < 3 * CLOCKS_PER_SEC);
  CHECK(bins[0].real() == test::approx(static_cast<double>(prime)));
}
