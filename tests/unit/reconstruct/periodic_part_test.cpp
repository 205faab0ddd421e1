// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/periodic_part.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "support/approx.hpp"

namespace reconstruct_periodic_part {

namespace {

constexpr double rate_Hz = 48e3;

double tone(double t, double f_Hz) {
  double x = 0;
  for (int h = 1; h <= 12; ++h) x += std::cos(2 * std::numbers::pi * h * f_Hz * t + h) / h;
  return x;
}

}  // namespace

TEST_CASE("the steady stretch of a take is found, and its period") {
  std::mt19937 random{5};
  std::normal_distribution<double> noise{0, 1e-3}, wild{0, 0.3};
  std::vector<double> near(9000), far(9000);
  for (std::size_t i = 0; i < near.size(); ++i) {
    const double t = static_cast<double>(i) / rate_Hz;
    const bool steady = i >= 4000 && i < 6000;
    near[i] = tone(t, 311.7) + (steady ? noise(random) : wild(random));
    far[i] = 0.5 * tone(t + 1e-3, 311.7) + (steady ? noise(random) : wild(random));
  }
  const auto part = rosin::find_periodic_part(near, far, rate_Hz, 305, 20e3);
  REQUIRE_MESSAGE(part, part.error());
  CHECK(part->begin >= 3990);
  CHECK(part->end <= 6200);
  CHECK(part->period == test::approx(rate_Hz / 311.7).epsilon(1e-5));
  CHECK(part->remainder < 0.01);
  CHECK(part->periods() == test::approx(7).epsilon(0.01));
  CHECK(std::abs(part->series[0][1]) == test::approx(1).epsilon(1e-3));
  CHECK(std::abs(part->series[1][4]) == test::approx(0.125).epsilon(5e-3));
}

TEST_CASE("what does not repeat, is too short, silent or not a number is said") {
  std::mt19937 random{6};
  std::normal_distribution<double> noise{0, 1};
  std::vector<double> x(6000), zero(6000, 0.0);
  for (double& v : x) v = noise(random);
  CHECK(rosin::find_periodic_part(x, x, rate_Hz, 300, 20e3).error().find("repeats itself") != std::string::npos);
  CHECK(rosin::find_periodic_part(zero, zero, rate_Hz, 300, 20e3).error().find("nothing moves") != std::string::npos);
  const std::vector<double> brief(200, 1.0);
  CHECK(rosin::find_periodic_part(brief, brief, rate_Hz, 300, 20e3).error().find("shorter than") != std::string::npos);
  x[77] = std::numeric_limits<double>::quiet_NaN();
  CHECK(rosin::find_periodic_part(x, x, rate_Hz, 300, 20e3).error().find("sample 77") != std::string::npos);
}

}  // namespace reconstruct_periodic_part
