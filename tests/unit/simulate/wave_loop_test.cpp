// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_loop.hpp>

#include <doctest/doctest.h>

#include <numeric>

#include "support/approx.hpp"

namespace simulate_wave_loop {

TEST_CASE("the response to a growing or dying motion is the sum over the taps") {
  const rosin::fir kernel{3, {0.5, -0.25, 2}};
  const std::complex<double> z{0.9, 0.3};
  const auto direct = 0.5 * std::pow(z, -3) - 0.25 * std::pow(z, -4) + 2.0 * std::pow(z, -5);
  CHECK(std::abs(rosin::response_at(kernel, z) - direct) < 1e-13);
}

TEST_CASE("an echo is -1 with its delay at 0 Hz, whatever the taps cut off") {
  const auto lossy = [](double f) { return -std::exp(std::complex<double>{-1e-5 * f, -2 * std::numbers::pi * f * 30.3 / 48e3}); };
  const auto echo = rosin::sample_echo(lossy, {15e3, 23e3}, 48e3, 20, 44, 30.3);
  CHECK(std::accumulate(echo.taps.begin(), echo.taps.end(), 0.0) == test::approx(-1));
  double moment = 0;
  for (std::size_t k = 0; k < echo.taps.size(); ++k) moment -= echo.taps[k] * (20 + static_cast<double>(k));
  CHECK(moment == test::approx(30.3));
}

TEST_CASE("poles are set exactly, and the loop's own poles are found there") {
  const double step_s = 1 / 48e3, period = 1 / 440.0;
  rosin::wave_loop loop;
  loop.echo[0] = {33, {-1}};
  loop.echo[1] = {60, std::vector<double>(140, -1.0 / 140)};
  std::vector<std::complex<double>> poles;
  for (int n = 1; n <= 20; ++n) poles.push_back(2 * std::numbers::pi * n / period * std::complex<double>{-1 / (2 * 200.0), 1});
  rosin::set_poles(loop, poles, step_s, period / step_s - 33, 1e-6);
  CHECK(loop.largest_change > 0.1);
  for (const auto& p : poles) CHECK(std::abs(rosin::pole_near(loop, p * 1.0003, step_s) - p) < 1e-5 * std::abs(p));
}

TEST_CASE("the gain counts where a partial could grow, and only there") {
  rosin::wave_loop loop;
  loop.echo[0] = {10, {-1}};
  loop.echo[1] = {20, {-0.9}};
  CHECK(rosin::largest_gain(loop, 30) == test::approx(0.9));
  loop.echo[1].taps = {-1.2};
  CHECK(rosin::largest_gain(loop, 30) == test::approx(1.2));
}

}  // namespace simulate_wave_loop
