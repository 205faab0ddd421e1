// SPDX-License-Identifier: MIT
#include <rosin/condition/fractional_delay.hpp>

#include <rosin/condition/fractional_delay_design.hpp>
#include <rosin/core/stage.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "support/approx.hpp"

namespace condition_fractional_delay {

using rosin::fractional_delay, rosin::lagrange, rosin::kaiser;

static_assert(rosin::Stage<fractional_delay<float, lagrange<4>, 64>> && rosin::Stage<fractional_delay<double, kaiser<16>, 64>>);
static_assert(rosin::Interpolator<lagrange<4>, float> && rosin::Interpolator<kaiser<16>, double>);
static_assert(!rosin::Interpolator<lagrange<3>, float>, "an odd number of taps has no middle");

constexpr float half_a_sample_after_a_click() {
  fractional_delay<float, lagrange<2>, 8> delay{2.5F};
  delay(1.0F), delay(0.0F);
  return delay(0.0F) - 0.5F + delay(0.0F);
}
static_assert(half_a_sample_after_a_click() == 0.5F, "a stage with Lagrange weights runs in a constant expression");

namespace {

/// Worst error in dB of a running delay line against delayed cosines, up to `bandwidth` of half the sampling rate.
template <class Line>
double error_dB(double bandwidth) {
  using T = typename Line::input_type;
  double worst = 0;
  for (const double fraction : {0.0, 0.25, 0.5, 0.9})
    for (int step = 1; step <= 8; ++step) {
      const double delay = static_cast<double>(Line::least_delay) + 5 + fraction, w = std::numbers::pi * bandwidth * step / 8;
      Line line{delay};
      for (int n = 0; n < 400; ++n) {
        const double y = static_cast<double>(line(static_cast<T>(std::cos(w * n + 0.3))));
        if (n > 150) worst = std::max(worst, std::abs(y - std::cos(w * (n - delay) + 0.3)));
      }
    }
  return 20 * std::log10(worst);
}

}  // namespace

TEST_CASE("errors are those of the table in the documentation") {
  CHECK(error_dB<fractional_delay<double, lagrange<2>, 128>>(0.125) < -34.2);
  CHECK(error_dB<fractional_delay<double, lagrange<4>, 128>>(0.125) < -65.1);
  CHECK(error_dB<fractional_delay<double, lagrange<4>, 128>>(0.5) < -18.6);
  CHECK(error_dB<fractional_delay<double, lagrange<8>, 128>>(0.25) < -77.4);
  CHECK(error_dB<fractional_delay<double, kaiser<16>, 128>>(0.8) < -43);
  CHECK(error_dB<fractional_delay<double, kaiser<32>, 128>>(0.8) < -89.9);
  CHECK(error_dB<fractional_delay<double, kaiser<64>, 128>>(0.8) < -179);
  CHECK(error_dB<fractional_delay<double, kaiser<16, 60>, 128>>(0.6) < -84.4);
  CHECK(error_dB<fractional_delay<float, kaiser<32>, 128>>(0.8) < -89.5);
  CHECK(error_dB<fractional_delay<float, kaiser<64>, 128>>(0.8) < -125);
}

TEST_CASE_TEMPLATE("whole delays are exact, from the shortest to the longest", T, float, double) {
  using line_type = fractional_delay<T, lagrange<4>, 16>;
  for (std::size_t delay = 1; delay <= 13; ++delay) {
    line_type line{static_cast<T>(delay)};
    CHECK(line.latency() == static_cast<T>(delay));
    for (std::size_t n = 0; n < 40; ++n)
      CHECK(line(static_cast<T>(n * n)) == static_cast<T>(n < delay ? 0 : (n - delay) * (n - delay)));
  }
}

TEST_CASE_TEMPLATE("a Lagrange delay of degree three is exact for cubics", T, float, double) {
  fractional_delay<T, lagrange<4>, 16> line{T(5.375)};
  const auto cubic = [](double t) { return 0.5 - t + 0.25 * t * t - 0.125 * t * t * t; };
  for (int n = 0; n < 30; ++n) {
    const T y = line(static_cast<T>(cubic(0.1 * n)));
    if (n >= 7)
      CHECK(static_cast<double>(y) ==
            test::approx(cubic(0.1 * (n - 5.375))).epsilon(50 * static_cast<double>(std::numeric_limits<T>::epsilon())));
  }
}

TEST_CASE("a delay out of range becomes the nearest one, and latency says so") {
  using line_type = fractional_delay<double, lagrange<4>, 16>;
  CHECK(line_type{0.25}.latency() == 1);
  CHECK(line_type{-7.0}.latency() == 1);
  CHECK(line_type{std::numeric_limits<double>::quiet_NaN()}.latency() == 1);
  line_type longest{1000.25};
  CHECK(longest.latency() == 13.25);
  double sum = 0;  // the centre of gravity of the response to a click is where it says
  for (int n = 0; n < 20; ++n) sum += n * longest(n == 0 ? 1.0 : 0.0);
  CHECK(sum == test::approx(13.25));
}

TEST_CASE("reset brings back the state after construction") {
  using line_type = fractional_delay<float, kaiser<8>, 16>;
  line_type used{6.5}, fresh{6.5};
  for (int n = 0; n < 21; ++n) used(static_cast<float>(n));
  used.reset();
  for (int n = 0; n < 40; ++n)
    CHECK(used(std::sin(0.3F * static_cast<float>(n))) == fresh(std::sin(0.3F * static_cast<float>(n))));
}

TEST_CASE("a new delay takes effect from the next sample on, with all that the line holds") {
  using line_type = fractional_delay<double, lagrange<2>, 32>;
  line_type line{3.0};
  for (int n = 0; n < 20; ++n) line(n);
  line.set(rosin::design_delay<double, lagrange<2>>(7.5));
  CHECK(line(20) == 12.5);
  CHECK(line.latency() == 7.5);
}

TEST_CASE("not a number in, not a number out, until it has left the taps") {
  fractional_delay<double, lagrange<2>, 8> line{1.5};
  line(std::numeric_limits<double>::quiet_NaN());
  CHECK(std::isnan(line(1)));
  CHECK(std::isnan(line(1)));
  CHECK(line(1) == 1);
}

}  // namespace condition_fractional_delay
