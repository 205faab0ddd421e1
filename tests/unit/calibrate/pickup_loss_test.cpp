// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pickup_loss.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/approx.hpp"

TEST_CASE("constant and internal loss from decays with errors") {
  std::mt19937_64 random{8};
  std::normal_distribution<double> gauss;
  std::vector<rosin::measured_decay> decays;
  for (int n = 1; n <= 30; ++n) {
    const double f = 200.0 * n, decay = std::numbers::pi * f * (1 / 900.0 + 3e-7 * f);
    decays.push_back({f, decay * (1 + 0.01 * gauss(random)), 0.01 * decay});
  }
  const rosin::loss_estimate loss = rosin::fit_loss(decays);
  for (const double f : {400.0, 2000.0, 5000.0}) CHECK(loss.law.inverse_q(f) == test::approx(1 / 900.0 + 3e-7 * f).epsilon(0.03));
  CHECK(loss.inverse_q_sd(2000) > 0);
  CHECK(loss.inverse_q_sd(2000) < 0.05 * loss.law.inverse_q(2000));
}
