// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_strays.hpp>

#include <doctest/doctest.h>

#include <rosin/simulate/converter.hpp>

#include "support/approx.hpp"

using namespace rosin;

TEST_CASE("find_strays: hum is steady, another string is not at the mains' multiples, the string's own are left alone") {
  std::vector<double> x(32000);
  gaussian_source normal{1};
  const double turn = 2 * 3.14159265358979323846 / 16000;
  for (std::size_t j = 0; j < x.size(); ++j) {
    const double t = static_cast<double>(j);
    x[j] = 0.01 * normal() + 0.02 * std::sin(50.03 * turn * t) + 0.01 * std::sin(3 * 50.03 * turn * t) +
           0.03 * std::exp(-t / 24000) * std::sin(329.6 * turn * t) + 0.05 * std::sin(440 * turn * t);
  }
  const auto s = find_strays(x, 16000, {440}, 5, 2000);
  CHECK(s.mains_Hz == test::approx(50.03).epsilon(1e-3));
  REQUIRE(s.hum.size() == 2);
  CHECK(s.hum[0].amplitude == test::approx(0.02).epsilon(0.05));
  REQUIRE(s.others.size() == 1);
  CHECK(s.others[0].frequency_Hz == test::approx(329.6).epsilon(1e-3));
  for (std::size_t j = 0; j < x.size(); ++j) x[j] = 0.01 * normal();
  const auto none = find_strays(x, 16000, {440}, 5, 2000);
  CHECK(none.hum.empty());
  CHECK(none.others.empty());
}
