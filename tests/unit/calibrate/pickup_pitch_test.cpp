// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pickup_pitch.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/approx.hpp"

TEST_CASE("pitch and inharmonicity from numbered partials, an outlier among them") {
  std::mt19937_64 random{2};
  std::normal_distribution<double> gauss;
  std::vector<rosin::numbered_frequency> partials;
  for (int n = 1; n <= 20; ++n) partials.push_back({n, rosin::partial_frequency(220.5, 8e-5, n) + 0.01 * gauss(random), 0.01});
  partials[6].frequency_Hz += 3;  // pulled by a resonance
  const rosin::robust_fit fit = rosin::fit_pitch(partials, 220, 0);
  CHECK(std::abs(fit.value[0] - 220.5) < 4 * std::sqrt(fit.covariance(0, 0)));
  CHECK(std::abs(fit.value[1] - 8e-5) < 4 * std::sqrt(fit.covariance(1, 1)));
  CHECK(fit.value[1] == test::approx(8e-5).epsilon(0.02));
  CHECK(fit.weight[6] < 0.2);
}
