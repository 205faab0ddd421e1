// SPDX-License-Identifier: MIT
#include <rosin/calibrate/stroke_noise.hpp>
#include <rosin/simulate/converter.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("Noise of both channels and what the model leaves are told apart by their spectra") {
  rosin::gaussian_source g{11};
  const rosin::stroke_noise truth{{0.7e-3, 2e-3}, 3e-3};
  rosin::stroke_leftover take;
  for (int k = 0; k < 20000; ++k) {
    const double f = 0.01 * k;
    take.near.push_back(std::pow(std::sin(0.3 * f), 2)), take.far.push_back(std::pow(std::sin(2.9 * f), 2));
    take.signal.push_back(k % 100 == 0 ? 50.0 : 0.01);
    take.power.push_back(0);
    take.power.back() = -std::log(g.uniform()) * take.expected(take.power.size() - 1, truth);
  }
  const auto found = rosin::estimate_noise({take}, {{1e-2, 1e-4}, 1e-1});
  CHECK(found.sensor_N[0] == test::approx(0.7e-3).epsilon(0.05));
  CHECK(found.sensor_N[1] == test::approx(2e-3).epsilon(0.02));
  CHECK(found.model == test::approx(3e-3).epsilon(0.2));
  CHECK(take.misfit(found) == test::approx(1).epsilon(0.01));
}
