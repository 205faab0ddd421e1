// SPDX-License-Identifier: MIT
#include <rosin/calibrate/partials.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/approx.hpp"

TEST_CASE("one partial: frequency, decay and amplitude within their error bars") {
  constexpr double rate_Hz = 8000, f = 523.7, decay = 2.5, noise = 0.01;
  int inside = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random{seed};
    std::normal_distribution<double> gauss;
    std::vector<double> x(12000);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double t = static_cast<double>(i) / rate_Hz;
      x[i] = std::exp(-decay * t) * std::cos(2 * std::numbers::pi * f * t) + noise * gauss(random);
    }
    const auto track = rosin::track_partial(rosin::baseband_bank{x, rate_Hz, 40}, 2, 523, 5, 0.1, 1.4);
    REQUIRE(track);
    const rosin::partial p = rosin::summary_of(*track);
    CHECK(p.number == 2);
    CHECK(p.frequency_Hz == test::approx(f).epsilon(1e-4));
    CHECK(p.decay_per_s == test::approx(decay).epsilon(0.05));
    CHECK(p.inverse_q() == test::approx(decay / (std::numbers::pi * f)).epsilon(0.05));
    inside += std::abs(p.frequency_Hz - f) < 2 * p.frequency_sd ? 1 : 0;
    inside += std::abs(p.decay_per_s - decay) < 2 * p.decay_sd ? 1 : 0;
  }
  CHECK(inside >= 32);  // of 40
}

TEST_CASE("where nothing rings there is no partial") {
  const std::vector<double> silent(8000, 0.0), brief(40, 0.1);
  CHECK_FALSE(rosin::track_partial(rosin::baseband_bank{brief, 8000, 40}, 1, 523, 5, 0, 1));
}
