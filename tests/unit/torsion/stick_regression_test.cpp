// SPDX-License-Identifier: MIT
#include <rosin/torsion/stick_regression.hpp>

#include <doctest/doctest.h>

#include <random>

#include "support/approx.hpp"

namespace torsion_stick_regression {

namespace {

/// y = 2 a - 3 b + level + noise with correlation `hold` samples and a few outliers.
rosin::stick_rows rows(std::mt19937& source, double level, int n, int hold, double outliers) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  rosin::stick_rows r;
  r.target.resize(n);
  r.shared.resize(n, 2);
  r.own = Eigen::MatrixXd::Ones(n, 1);
  double noise = 0;
  for (int i = 0; i < n; ++i) {
    if (i % hold == 0) noise = 0.1 * normal(source);
    r.shared(i, 0) = normal(source);
    r.shared(i, 1) = normal(source);
    r.target[i] = 2 * r.shared(i, 0) - 3 * r.shared(i, 1) + level + noise - (uniform(source) < outliers ? 5.0 : 0.0);
    r.sample.push_back(static_cast<std::size_t>(i));
  }
  return r;
}

}  // namespace

TEST_CASE("stick regression: coefficients and levels, with errors that hold") {
  std::mt19937 source(1);
  double chi2 = 0;
  for (int run = 0; run < 60; ++run) {
    const auto s = rosin::stick_regression({rows(source, 0.5, 600, 1, 0), rows(source, -0.2, 400, 1, 0)});
    CHECK(s.own[0][0] == test::approx(0.5).epsilon(0.1));
    CHECK(s.own[1][0] == test::approx(-0.2).epsilon(0.2));
    chi2 += std::pow(s.shared[0] - 2, 2) / s.covariance(0, 0) / 120 + std::pow(s.shared[1] + 3, 2) / s.covariance(1, 1) / 120;
    CHECK(s.scale < 0.1);
    CHECK(s.scale > 0.07);
    CHECK(s.effective > 0.3 * s.rows);
  }
  CHECK(chi2 > 0.6);
  CHECK(chi2 < 1.7);
}

TEST_CASE("stick regression: slips among the rows hardly count") {
  std::mt19937 source(2);
  const auto s = rosin::stick_regression({rows(source, 0.5, 2000, 1, 0.05)});
  CHECK(s.shared[0] == test::approx(2).epsilon(0.01));
  CHECK(s.own[0][0] == test::approx(0.5).epsilon(0.05));
}

TEST_CASE("stick regression: correlated rows count for less") {
  std::mt19937 source(3);
  const auto apart = rosin::stick_regression({rows(source, 0, 4000, 1, 0)}),
             held = rosin::stick_regression({rows(source, 0, 4000, 10, 0)});
  CHECK(held.effective < 0.2 * apart.effective);
  CHECK(held.effective > 0.04 * held.rows);
}

TEST_CASE("stick regression: what is known beforehand") {
  std::mt19937 source(4);
  rosin::stick_prior prior{Eigen::Vector2d(1, 0), Eigen::Vector2d(1e12, 0)};
  const auto s = rosin::stick_regression({rows(source, 0.5, 600, 1, 0)}, 0, prior);
  CHECK(s.shared[0] == test::approx(1).epsilon(1e-3));
  CHECK(s.shared[1] == test::approx(-3).epsilon(0.2));
}

TEST_CASE("stick regression: likelihood prefers the model that is true") {
  std::mt19937 source(5);
  auto r = rows(source, 0.5, 800, 1, 0);
  const double whole = rosin::stick_regression({r}).log_likelihood;
  r.shared.conservativeResize(r.shared.rows(), 1);
  CHECK(whole > rosin::stick_regression({r}).log_likelihood + 500);
}

}  // namespace torsion_stick_regression
