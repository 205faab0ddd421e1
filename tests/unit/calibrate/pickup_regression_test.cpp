// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pickup_regression.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/approx.hpp"

TEST_CASE("a straight line through scattered points: the outlier is left out, the scatter found, the error bars cover") {
  int inside = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937_64 random{seed};
    std::normal_distribution<double> gauss;
    const Eigen::Index n = 25;
    rosin::robust_data d{Eigen::VectorXd(n), Eigen::VectorXd::Constant(n, 1e-4), Eigen::VectorXd::Ones(n)};
    for (Eigen::Index i = 0; i < n; ++i)
      d.y[i] = 2 + 0.5 * static_cast<double>(i) + 0.05 * gauss(random);  // five times the errors given
    d.y[4] += 10;
    const auto model = [](const Eigen::VectorXd& theta, Eigen::VectorXd& prediction, Eigen::MatrixXd& jacobian) {
      for (Eigen::Index i = 0; i < prediction.size(); ++i) {
        prediction[i] = theta[0] + theta[1] * static_cast<double>(i);
        jacobian(i, 0) = 1;
        jacobian(i, 1) = static_cast<double>(i);
      }
    };
    const rosin::robust_fit fit = rosin::robust_regression(d, model, Eigen::Vector2d{1.9, 0.51});
    CHECK(fit.value[1] == test::approx(0.5).epsilon(0.05));
    CHECK(fit.weight[4] < 0.05);
    CHECK(fit.scatter > 0.01);
    inside += std::abs(fit.value[1] - 0.5) < 2 * std::sqrt(fit.covariance(1, 1)) ? 1 : 0;
  }
  CHECK(inside >= 50);
}
