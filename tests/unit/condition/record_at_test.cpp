// SPDX-License-Identifier: MIT
#include <rosin/condition/record_at.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/approx.hpp"

namespace condition_record_at {

TEST_CASE("a record is read at instants that run unevenly") {
  for (const double share : {0.01, 0.2, 0.42}) {
    const auto tone = [&](double at) { return std::sin(2 * std::numbers::pi * share * at + 0.3); };
    std::vector<double> x(3000);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = tone(static_cast<double>(i));
    const auto instant = [](std::size_t i) { return static_cast<double>(i) + 3 * std::sin(0.01 * static_cast<double>(i)); };
    const auto y = rosin::record_at(x, instant);
    double worst = 0;
    for (std::size_t i = 100; i + 100 < x.size(); ++i) worst = std::max(worst, std::abs(y[i] - tone(instant(i))));
    CHECK(worst < 2e-5);
  }
}

TEST_CASE("what lies outside a record is like its nearest sample, however far") {
  const std::vector<double> x(100, 2.0);
  for (const double v : rosin::record_at(x, [](std::size_t i) { return (static_cast<double>(i) - 50) * 1e6; }))
    CHECK(v == test::approx(2).epsilon(1e-5));
  CHECK(rosin::record_at({}, [](std::size_t i) { return static_cast<double>(i); }).empty());
}

}  // namespace condition_record_at
