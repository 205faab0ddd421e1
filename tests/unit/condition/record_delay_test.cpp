// SPDX-License-Identifier: MIT
#include <rosin/condition/record_delay.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace condition_record_delay {

namespace {

/// Twenty partials of unit amplitude up to 0.8 of half the sampling rate, that one included, later by `delay`.
template <class T>
std::vector<T> tones(std::size_t n, double delay) {
  std::vector<T> x(n);
  for (std::size_t j = 0; j < n; ++j) {
    double sum = 0;
    for (int i = 1; i <= 20; ++i) sum += std::cos(0.8 * std::numbers::pi * i / 20 * (static_cast<double>(j) - delay) + i);
    x[j] = static_cast<T>(sum);
  }
  return x;
}

/// Worst error inside the valid range, in dB against the amplitude of one partial.
template <class T>
double worst_error_dB(double delay, const rosin::delay_limits& limits = {}) {
  auto made = rosin::record_delay<T>::make(delay, limits);
  REQUIRE(made);
  const std::size_t n = 6000;
  const std::vector<T> in = tones<T>(n, 0), should = tones<T>(n, delay);
  std::vector<T> out(n);
  made->process(in, out);
  CHECK(made->latency() == delay);
  const rosin::sample_range valid = made->valid(n);
  CHECK(valid.end - valid.begin + made->taps() + static_cast<std::size_t>(std::abs(delay)) >= n);
  double worst = 0;
  for (std::size_t j = valid.begin; j < valid.end; ++j)
    worst = std::max(worst, static_cast<double>(std::abs(out[j] - should[j])));
  return 20 * std::log10(worst);
}

}  // namespace

TEST_CASE("any real delay, to better than -120 dB up to 0.8 of half the sampling rate") {
  for (const double delay : {0.5, 0.001, 0.999, 29.105, 67.911, -24.254, -72.761, 1000.25}) {
    CAPTURE(delay);
    CHECK(worst_error_dB<double>(delay) < -120);  // twenty partials of -140 dB each, at worst
    CHECK(worst_error_dB<double>(delay, {0.8, -240}) < -210);
    CHECK(worst_error_dB<float>(delay) < -95);
  }
}

TEST_CASE("whole delays are exact to rounding") {
  for (const double delay : {0.0, 1.0, -3.0, 512.0}) CHECK(worst_error_dB<double>(delay) < -270);
}

TEST_CASE("no record comes of a delay that is no number") {
  CHECK_FALSE(rosin::record_delay<double>::make(std::numeric_limits<double>::quiet_NaN()).has_value());
}

}  // namespace condition_record_delay
