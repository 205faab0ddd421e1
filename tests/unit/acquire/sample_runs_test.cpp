// SPDX-License-Identifier: MIT
#include <rosin/acquire/sample_runs.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <random>

#include "support/approx.hpp"

namespace acquire_sample_runs {

namespace {

constexpr double step = 1.0 / 32768;

std::vector<double> sine(double amplitude, double period, double noise, std::size_t size = 8000) {
  std::mt19937_64 random{7};
  std::normal_distribution<double> white{0, 1};
  std::vector<double> x(size);
  for (std::size_t i = 0; i < size; ++i)
    x[i] = amplitude * std::sin(6.283185307179586 * static_cast<double>(i) / period) + noise * white(random);
  for (double& v : x) v = std::round(v / step) * step;
  return x;
}

void cut(std::vector<double>& x, double top) {
  for (double& v : x) v = std::min(v, top);
}

}  // namespace

TEST_CASE("samples that are not finite are found as stretches") {
  std::vector<double> x(10, 0.5);
  x[3] = x[4] = std::numeric_limits<double>::quiet_NaN();
  x[9] = std::numeric_limits<double>::infinity();
  const auto spans = rosin::not_finite(x);
  REQUIRE(spans.size() == 2);
  CHECK(spans[0].first == 3);
  CHECK(spans[0].count == 2);
  CHECK(spans[1].first == 9);
  CHECK(rosin::not_finite(sine(0.5, 100, 0)).empty());
}

TEST_CASE("a cut at full scale is clipping, and so is one below it") {
  auto x = sine(1.4, 100, 1e-3);
  cut(x, 1 - step);
  CHECK(rosin::clipped(x, step, 1.0).size() >= 70);
  auto below = sine(0.5, 100, 1e-3);
  cut(below, 0.4);
  CHECK(rosin::clipped(below, step, 1.0).size() >= 70);
  auto real = sine(0.5, 100, 1e-3);
  for (double& v : real) v *= 1.7;
  cut(real, 0.7);
  CHECK(rosin::clipped(real, 0, 1.0).size() >= 70);
}

TEST_CASE("smooth maxima, noise and a touch of full scale are no clipping") {
  for (const double period : {8.0, 100.0, 3000.0})
    for (const double noise : {0.0, 1e-4, 1e-2}) {
      CAPTURE(period);
      CAPTURE(noise);
      CHECK(rosin::clipped(sine(0.3, period, noise), step, 1.0).empty());
    }
  auto touch = sine(0.5, 100, 1e-3);
  touch[25] = 1 - step;
  CHECK(rosin::clipped(touch, step, 1.0).empty());
}

TEST_CASE("held and zeroed samples are dropouts") {
  auto held = sine(0.5, 100, 1e-3);
  for (std::size_t i = 4011; i < 4041; ++i) held[i] = held[4010];
  const auto spans = rosin::dropouts(held, step);
  REQUIRE(spans.size() == 1);
  CHECK(spans[0].first == 4010);
  CHECK(spans[0].count >= 31);
  auto zeroed = sine(0.5, 100, 1e-3);
  for (std::size_t i = 4020; i < 4024; ++i) zeroed[i] = 0;
  REQUIRE(rosin::dropouts(zeroed, step).size() == 1);
  CHECK(rosin::dropouts(zeroed, step)[0].count == 4);
}

TEST_CASE("what is cut off is held at full scale, and no dropout") {
  auto x = sine(0.9, 100, 1e-3);
  for (std::size_t i = 4060; i < 4066; ++i) x[i] = -1;
  x[4059] = -0.99, x[4066] = -0.7;
  REQUIRE(rosin::dropouts(x, step).size() == 1);
  const auto cut_off = rosin::clipped(x, step, 1.0);
  REQUIRE(cut_off.size() == 1);
  CHECK(rosin::dropouts(x, step, cut_off).empty());
  for (std::size_t i = 5011; i < 5041; ++i) x[i] = x[5010];
  REQUIRE(rosin::dropouts(x, step, cut_off).size() == 1);
  CHECK(rosin::dropouts(x, step, cut_off)[0].first == 5010);
}

TEST_CASE("what repeats by nature is no dropout") {
  for (const double period : {20.0, 100.0, 3000.0})
    for (const double noise : {0.0, 3e-5, 1e-3}) {
      CAPTURE(period);
      CAPTURE(noise);
      CHECK(rosin::dropouts(sine(0.3, period, noise), step).empty());
    }
  auto rectangle = sine(0.3, 100, 0);
  for (double& v : rectangle) v = v > 0 ? 0.5 : 0.0;
  CHECK(rosin::dropouts(rectangle, step).empty());
  auto padded = sine(0.5, 100, 1e-3);
  std::fill(padded.begin(), padded.begin() + 500, 0.0);
  std::fill(padded.end() - 500, padded.end(), 0.0);
  CHECK(rosin::dropouts(padded, step).empty());
}

TEST_CASE("noise under a level and under hum") {
  auto x = sine(0.02, 960, 1e-3, 20000);
  for (double& v : x) v += 0.7;
  CHECK(rosin::noise_in(x, 20000) == test::approx(1e-3).epsilon(0.03));
  CHECK(rosin::noise_in(x, 1) == 0);
}

TEST_CASE("four equal samples in a quiet stretch are chance, in the middle of a motion they are not") {
  // Ten steps of noise, then a motion of thousands: in all of the record repeats are rare, in the noise they are not.
  std::mt19937 random{1};
  std::normal_distribution<double> noise{0, 10};
  std::vector<double> x;
  for (int i = 0; i < 500; ++i) x.push_back(std::round(noise(random)));
  for (int i = 0; i < 17500; ++i) x.push_back(std::round(noise(random) + 8000 * std::sin(0.03 * i)));
  auto still = x, moving = x;
  for (std::size_t i = 237; i < 241; ++i) still[i] = still[236] + 40;
  for (std::size_t i = 9001; i < 9005; ++i) moving[i] = moving[9000];
  CHECK(rosin::dropouts(x, 1).empty());
  CHECK(rosin::dropouts(still, 1).empty());
  CHECK(rosin::dropouts(moving, 1).size() == 1);
}

}  // namespace acquire_sample_runs
