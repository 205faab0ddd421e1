// SPDX-License-Identifier: MIT
#include <rosin/condition/fourier_shift.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "support/approx.hpp"

namespace condition_fourier_shift {

namespace {

/// Three partials, the highest one at or just below half the sampling rate, later by `delay`.
template <class T>
std::vector<T> tones(std::size_t n, double delay) {
  std::vector<T> x(n);
  for (std::size_t j = 0; j < n; ++j) {
    long double sum = 0.3L;
    for (const std::size_t cycles : {std::size_t{1}, n / 3, n / 2}) {
      const long double per_sample = static_cast<long double>(cycles) / static_cast<long double>(n);
      sum += std::cos(2 * std::numbers::pi_v<long double> * per_sample *
                      (static_cast<long double>(j) - static_cast<long double>(delay)));
    }
    x[j] = static_cast<T>(sum);
  }
  return x;
}

template <class T>
double worst_error(std::size_t n, double delay) {
  rosin::fourier_shift<T> shift(n);
  const std::vector<T> in = tones<T>(n, 0), should = tones<T>(n, delay);
  std::vector<T> out(n);
  shift.process(in, out, delay);
  double worst = 0;
  for (std::size_t j = 0; j < n; ++j) worst = std::max(worst, static_cast<double>(std::abs(out[j] - should[j])));
  return worst;
}

}  // namespace

TEST_CASE("a periodic record is delayed to rounding, by any real number of samples, at any length") {
  for (const std::size_t n : {2u, 7u, 64u, 100u, 997u, 4096u})
    for (const double delay : {0.0, 0.5, -0.25, 3.0, 29.105, -67.911, 12345.678}) {
      CAPTURE(n);
      CAPTURE(delay);
      CHECK(worst_error<double>(n, delay) < 1e-14);
      CHECK(worst_error<float>(n, delay) < 4e-6);
    }
}

TEST_CASE("the error does not grow with the delay") {
  const std::size_t n = 1000;  // the same delay, a million periods later
  rosin::fourier_shift<double> shift(n);
  const std::vector<double> in = tones<double>(n, 0);
  std::vector<double> once(n), later(n);
  shift.process(in, once, 0.25);
  shift.process(in, later, 1e9 + 0.25);
  for (std::size_t j = 0; j < n; ++j) CHECK(std::abs(once[j] - later[j]) < 1e-14);
}

TEST_CASE("in and out may be the same record") {
  std::vector<double> x = tones<double>(99, 0), expected = tones<double>(99, 1.5);
  rosin::fourier_shift<double>(99).process(x, x, 1.5);
  for (std::size_t j = 0; j < x.size(); ++j) CHECK(x[j] == test::approx(expected[j]).epsilon(1e-13));
}

}  // namespace condition_fourier_shift
