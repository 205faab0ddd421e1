// SPDX-License-Identifier: MIT
#include <rosin/calibrate/partial_search.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/approx.hpp"

namespace {

std::vector<double> stiff_tone(double f0, double b, double noise) {
  std::mt19937_64 random{4};
  std::normal_distribution<double> gauss;
  std::vector<double> x(44100);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = static_cast<double>(i) / 44100;
    for (int n = 1; n <= 20; ++n)
      x[i] += std::exp(-(1 + 0.1 * n) * t) / n * std::cos(2 * std::numbers::pi * n * f0 * std::sqrt(1 + b * n * n) * t + n);
    x[i] += noise * gauss(random);
  }
  return x;
}

}  // namespace

TEST_CASE("partials are found and numbered, from 2 % beside the pitch") {
  const auto x = stiff_tone(196.3, 1.2e-4, 1e-3);
  for (const double nominal : {192.5, 196.0, 200.0}) {
    const rosin::found_partials found = rosin::find_partials(x, 44100, nominal, 0.06, 64);
    CHECK(found.fundamental_Hz == test::approx(196.3).epsilon(2e-3));
    REQUIRE(found.partials.size() >= 15);
    for (const auto& p : found.partials)
      CHECK(p.frequency_Hz == test::approx(p.number * 196.3 * std::sqrt(1 + 1.2e-4 * p.number * p.number)).epsilon(5e-3));
  }
}

TEST_CASE("there are no partials in noise") {
  std::mt19937_64 random{5};
  std::normal_distribution<double> gauss;
  std::vector<double> x(44100);
  for (double& v : x) v = gauss(random);
  CHECK(rosin::find_partials(x, 44100, 196, 0.06, 64).partials.size() < 4);
}
