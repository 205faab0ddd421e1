// SPDX-License-Identifier: MIT
#include <rosin/adapt/fft_fftw.hpp>

#include <rosin/math/fft.hpp>

#include <doctest/doctest.h>
#include <laws/fft_laws.hpp>

#include <complex>
#include <cstddef>
#include <thread>
#include <vector>

#include "support/approx.hpp"

TEST_CASE_TEMPLATE("FFTW's transform is the definition at any length, as Eigen's is", T, float, double) {
  static_assert(rosin::RealFft<rosin::fftw_fft<T>, T> && rosin::ComplexFft<rosin::fftw_fft<std::complex<T>>, T>);
  for (const std::size_t n : laws::fft_lengths) {
    laws::real_transform_is_exact<T, rosin::fftw_fft<T>>(n);
    laws::complex_transform_is_exact<T, rosin::fftw_fft<std::complex<T>>>(n);
    laws::two_backends_agree<T, rosin::fftw_fft<T>, rosin::eigen_fft<T>>(n);
  }
}

TEST_CASE("measured plans give the same result") {
  laws::two_backends_agree<double, rosin::fftw_fft<double, FFTW_MEASURE>, rosin::eigen_fft<double>>(1000);
}

TEST_CASE("arrays may lie anywhere in memory") {
  const std::vector<double> x = laws::noise<double>(65, 1);
  std::vector<std::complex<double>> at_start(33), shifted(33);
  rosin::fftw_fft<double> fft(64);
  const std::vector<double> tail(x.begin() + 1, x.end());
  fft.forward(tail.data(), at_start.data());
  fft.forward(x.data() + 1, shifted.data());
  for (std::size_t k = 0; k < 33; ++k) CHECK(std::abs(at_start[k] - shifted[k]) < 1e-13);
}

TEST_CASE("plans are made from several threads at once") {
  std::vector<std::thread> threads;
  std::vector<double> sums(4);
  for (std::size_t t = 0; t < sums.size(); ++t)
    threads.emplace_back([&sum = sums[t]] {
      for (std::size_t n = 200; n < 260; ++n) {
        rosin::fftw_fft<double> fft(n);
        const std::vector<double> x(n, 1.0);
        std::vector<std::complex<double>> bins(n / 2 + 1);
        fft.forward(x.data(), bins.data());
        sum += bins[0].real();
      }
    });
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) CHECK(sum == test::approx(60 * 229.5));
}
