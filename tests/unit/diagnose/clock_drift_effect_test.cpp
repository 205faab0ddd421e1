// SPDX-License-Identifier: MIT
#include <rosin/diagnose/clock_drift_effect.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/approx.hpp"

namespace {

double tone(double at, double share_of_rate) { return std::sin(2 * std::numbers::pi * share_of_rate * at + 0.3); }

}  // namespace

TEST_CASE("clock drift: a record is read at the instants of another clock") {
  for (const double share : {0.01, 0.2, 0.42})
    for (const double stretch : {2e-5, -3e-4}) {
      std::vector<double> x(4000);
      for (std::size_t i = 0; i < x.size(); ++i) x[i] = tone(static_cast<double>(i), share);
      const auto y = rosin::resampled(x, stretch);
      REQUIRE(y.size() == x.size());
      double worst = 0;
      for (std::size_t i = 100; i + 100 < x.size(); ++i)
        worst = std::max(worst, std::abs(y[i] - tone(static_cast<double>(i) * (1 + stretch), share)));
      CHECK(worst < 2e-5);
    }
}

TEST_CASE("clock drift: only the far channel is put right, take by take") {
  const auto e = rosin::clock_drift_effect({});
  const double drift = 1e-4;
  std::vector<rosin::pluck_take> takes(2);
  for (auto& take : takes) {
    take.force_N = {std::vector<double>(3000), std::vector<double>(3000)};
    for (std::size_t i = 0; i < 3000; ++i) {
      take.force_N[0][i] = tone(static_cast<double>(i), 0.05);
      take.force_N[1][i] = tone(static_cast<double>(i) / (1 + drift), 0.05);  // more samples a second
    }
  }
  e.undo(takes, {}, {}, {}, drift);
  for (const auto& take : takes)
    for (std::size_t i = 50; i < 2950; ++i)
      CHECK(take.force_N[1][i] == test::approx(take.force_N[0][i]).epsilon(1e-4).scale(0.1));
}

TEST_CASE("clock drift: an empty record stays empty, a short one finite") {
  CHECK(rosin::resampled({}, 1e-4).empty());
  const auto y = rosin::resampled({1, 1, 1}, 1e-4);
  REQUIRE(y.size() == 3);
  for (const double v : y) CHECK(v == test::approx(1).epsilon(1e-3));
}
