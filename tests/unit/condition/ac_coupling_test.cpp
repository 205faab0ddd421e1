// SPDX-License-Identifier: MIT
#include <rosin/condition/ac_coupling.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/approx.hpp"

namespace condition_ac_coupling {

TEST_CASE_TEMPLATE("a step that drooped away comes back, but for its mean", T, float, double) {
  constexpr double rate_Hz = 128e3, corner_Hz = 3, step_at = 0.05;
  std::vector<T> seen, was;
  for (int n = 0; n < 40000; ++n) {
    const double t = n / rate_Hz, since = t - step_at;
    was.push_back(static_cast<T>(since < 0 ? 0.7 : -0.3));
    // The high-pass was settled before: it shows 0, then the step and its decay.
    seen.push_back(static_cast<T>(since < 0 ? 0.0 : -std::exp(-2 * std::numbers::pi * corner_Hz * since)));
  }
  double mean = 0;
  for (const T x : was) mean += static_cast<double>(x) / static_cast<double>(was.size());
  rosin::restore_ac_coupled<T>(seen, corner_Hz, rate_Hz);
  for (std::size_t n = 0; n < seen.size(); n += 37)
    CHECK(static_cast<double>(seen[n]) == test::approx(static_cast<double>(was[n]) - mean).epsilon(2e-4));
}

TEST_CASE("what passes a high-pass comes back, but for its mean") {
  std::vector<double> was, x;
  for (int n = 0; n < 5000; ++n) was.push_back(0.2 + std::sin(0.05 * n) + (n > 700 ? 0.5 : 0.0));
  x = was;
  rosin::pass_ac_coupled<double>(x, 40, 48e3);
  CHECK(x[0] == 0);
  CHECK(std::abs(x[4999] - was[4999]) > 0.1);
  rosin::restore_ac_coupled<double>(x, 40, 48e3);
  double mean = 0;
  for (const double w : was) mean += w / 5000;
  for (std::size_t n = 0; n < x.size(); n += 61) CHECK(x[n] == test::approx(was[n] - mean).epsilon(1e-9));
}

TEST_CASE("a DC-coupled signal is left alone") {
  std::vector<double> x{1, 2, 3};
  rosin::restore_ac_coupled<double>(x, 0, 1000);
  CHECK(x == std::vector<double>{1, 2, 3});
}

}  // namespace condition_ac_coupling
