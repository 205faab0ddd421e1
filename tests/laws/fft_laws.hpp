// SPDX-License-Identifier: MIT
// What every Fourier transform of the library has to obey, at lengths that are easy, odd, prime and one.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

namespace laws {

// 17921 is prime; 2 * 127 and 9 * 1009 have a large prime factor; 6 and 10 are even but no multiples of four.
inline const std::vector<std::size_t> fft_lengths{1,  2,  3,  4,  5,   6,   7,    8,    9,    10,   12,   23,
                                                  29, 31, 64, 97, 120, 254, 1000, 1021, 4096, 9081, 17921};

template <class T>
std::vector<T> noise(std::size_t n, unsigned seed) {
  std::mt19937 engine{seed};
  std::normal_distribution<double> normal;
  std::vector<T> x(n);
  for (T& sample : x) {
    if constexpr (std::is_floating_point_v<T>) {
      sample = static_cast<T>(normal(engine));
    } else {
      using real = typename T::value_type;
      const double re = normal(engine);
      sample = T{static_cast<real>(re), static_cast<real>(normal(engine))};
    }
  }
  return x;
}

template <class T>
std::complex<long double> widened(T x) {
  return static_cast<long double>(x);
}
template <class T>
std::complex<long double> widened(std::complex<T> x) {
  return {static_cast<long double>(x.real()), static_cast<long double>(x.imag())};
}

/// One bin by its definition, in long double, with the phase reduced in integers.
template <class T>
std::complex<long double> bin_by_definition(const std::vector<T>& x, std::size_t k) {
  const std::size_t n = x.size();
  std::complex<long double> sum{};
  for (std::size_t j = 0; j < n; ++j) {
    const long double angle =
        -2 * 3.14159265358979323846264338328L * static_cast<long double>(j * k % n) / static_cast<long double>(n);
    sum += std::complex<long double>{std::cos(angle), std::sin(angle)} * widened(x[j]);
  }
  return sum;
}

/// All bins of a short record, six of a long one.
inline std::vector<std::size_t> bins_to_check(std::size_t bins) {
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < bins; k += std::max<std::size_t>(1, bins / 5)) chosen.push_back(k);
  if (bins > 1) chosen.push_back(bins - 1);
  return chosen;
}

/// Rounding that n points may collect: 4 epsilon, and a little more per factor of two, against the root mean square.
template <class T>
double allowed(std::size_t n) {
  return static_cast<double>(std::numeric_limits<T>::epsilon()) * (4 + 2 * std::log2(static_cast<double>(n)));
}

template <class T, class Fft>
void real_transform_is_exact(std::size_t n) {
  CAPTURE(n);
  Fft fft(n);
  REQUIRE(fft.size() == n);
  const std::vector<T> x = noise<T>(n, static_cast<unsigned>(n));
  std::vector<std::complex<T>> bins(n / 2 + 1);
  fft.forward(x.data(), bins.data());
  double worst = 0;
  for (const std::size_t k : bins_to_check(bins.size()))
    worst = std::max(worst, static_cast<double>(std::abs(widened(bins[k]) - bin_by_definition(x, k))));
  CHECK(worst / std::sqrt(static_cast<double>(n)) < allowed<T>(n));
  CHECK(bins[0].imag() == 0);
  if (n % 2 == 0) CHECK(bins[n / 2].imag() == 0);

  bins[0].imag(T(2));  // by contract without effect, as at half the sampling rate
  if (n % 2 == 0) bins[n / 2].imag(T(2));
  const std::vector<std::complex<T>> kept = bins;
  std::vector<T> back(n);
  fft.inverse(bins.data(), back.data());
  CHECK(bins == kept);
  worst = 0;
  for (std::size_t j = 0; j < n; ++j) worst = std::max(worst, static_cast<double>(std::abs(back[j] - x[j])));
  CHECK(worst < 4 * allowed<T>(n));
}

template <class T, class Fft>
void complex_transform_is_exact(std::size_t n) {
  CAPTURE(n);
  Fft fft(n);
  REQUIRE(fft.size() == n);
  const std::vector<std::complex<T>> x = noise<std::complex<T>>(n, static_cast<unsigned>(n));
  std::vector<std::complex<T>> bins(n), back(n);
  fft.forward(x.data(), bins.data());
  double worst = 0;
  for (const std::size_t k : bins_to_check(n))
    worst = std::max(worst, static_cast<double>(std::abs(widened(bins[k]) - bin_by_definition(x, k))));
  CHECK(worst / std::sqrt(static_cast<double>(n)) < allowed<T>(n));
  fft.inverse(bins.data(), back.data());
  worst = 0;
  for (std::size_t j = 0; j < n; ++j) worst = std::max(worst, static_cast<double>(std::abs(back[j] - x[j])));
  CHECK(worst < 4 * allowed<T>(n));
}

template <class T, class First, class Second>
void two_backends_agree(std::size_t n) {
  CAPTURE(n);
  First first(n);
  Second second(n);
  const std::vector<T> x = noise<T>(n, 7);
  std::vector<std::complex<T>> a(n / 2 + 1), b(n / 2 + 1);
  first.forward(x.data(), a.data());
  second.forward(x.data(), b.data());
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, static_cast<double>(std::abs(a[k] - b[k])));
  CHECK(worst / std::sqrt(static_cast<double>(n)) < 2 * allowed<T>(n));
}

}  // namespace laws
