// SPDX-License-Identifier: MIT
#include <rosin/condition/low_pass.hpp>

#include <rosin/propagate/band.hpp>

#include <doctest/doctest.h>
#include <laws/fft_laws.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace condition_low_pass {

namespace {

constexpr double rate_Hz = 128e3;
constexpr rosin::band limits{10e3, 40e3};

}  // namespace

TEST_CASE_TEMPLATE("what the mirrors leave alone comes out times the window", T, float, double) {
  for (const std::size_t n : {1u, 2u, 97u, 256u, 1000u})
    for (const std::size_t half_turns : {0u, 1u, 20u, 50u, 90u}) {
      if (half_turns >= n) continue;
      std::vector<T> x(n);
      for (std::size_t j = 0; j < n; ++j)
        x[j] = static_cast<T>(
            std::cos(std::numbers::pi * static_cast<double>(half_turns * (2 * j + 1) % (4 * n)) / static_cast<double>(2 * n)));
      const std::vector<T> y = rosin::low_pass<T>(x, rate_Hz, limits);
      const T gain = static_cast<T>(limits(rate_Hz / 2 * static_cast<double>(half_turns) / static_cast<double>(n)));
      T worst = 0;
      for (std::size_t j = 0; j < n; ++j) worst = std::max(worst, std::abs(y[j] - gain * x[j]));
      CAPTURE(n);
      CAPTURE(half_turns);
      CHECK(worst < T(20) * std::numeric_limits<T>::epsilon());
    }
}

TEST_CASE("inside a record it is the sum with the window's response in time") {
  const std::vector<double> x = laws::noise<double>(600, 1);
  const std::vector<double> y = rosin::low_pass<double>(x, rate_Hz, limits);
  const int reach = 250, grid = 4096;
  std::vector<double> response(reach + 1);
  for (int lag = 0; lag <= reach; ++lag)
    for (int k = -grid / 2; k < grid / 2; ++k)
      response[static_cast<std::size_t>(lag)] +=
          limits(rate_Hz * k / grid) * std::cos(2 * std::numbers::pi * lag * k / grid) / grid;
  for (int n = reach; n + reach < 600; ++n) {
    double sum = 0;
    for (int lag = -reach; lag <= reach; ++lag)
      sum += response[static_cast<std::size_t>(std::abs(lag))] * x[static_cast<std::size_t>(n - lag)];
    CHECK(std::abs(y[static_cast<std::size_t>(n)] - sum) < 1e-6);
  }
}

TEST_CASE("a step at the other end of the record is not felt, as it would be if the record were taken for periodic") {
  std::vector<double> ramp(2000);
  for (std::size_t j = 0; j < ramp.size(); ++j) ramp[j] = static_cast<double>(j);
  const std::vector<double> y = rosin::low_pass<double>(ramp, rate_Hz, limits);
  for (std::size_t j = 100; j < 1900; ++j) CHECK(std::abs(y[j] - ramp[j]) < 2e-5);
  for (std::size_t j = 0; j < ramp.size(); ++j) CHECK(std::abs(y[j] - ramp[j]) < 2);
}

TEST_CASE("an empty record stays empty") { CHECK(rosin::low_pass<double>(std::span<const double>{}, rate_Hz, limits).empty()); }

}  // namespace condition_low_pass
