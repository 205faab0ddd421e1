// SPDX-License-Identifier: MIT
#include <rosin/math/reweighted_regression.hpp>

#include <doctest/doctest.h>

#include <cmath>

#include "support/approx.hpp"

namespace {

/// A line 2 - 0.5 t with a little on it, and every seventh row plainly wrong.
rosin::regression_row<double, 2> row(Eigen::Index i) {
  const double t = 0.01 * static_cast<double>(i), wobble = 0.01 * std::sin(12.9898 * static_cast<double>(i));
  return {{1, t}, 2 - 0.5 * t + wobble + (i % 7 == 0 ? 3.0 : 0.0)};
}

template <class Loss>
Eigen::Vector2d fitted(const Loss& loss, double scale, Eigen::Vector2d value = {0, 0}, int passes = 60) {
  for (int pass = 0; pass < passes; ++pass) rosin::reweighted_pass(loss, scale, 0, 500, row, value);
  return value;
}

}  // namespace

TEST_CASE("reweighted_pass: with hardly a bend it is least squares, and done at once") {
  Eigen::MatrixX2d x(500, 2);
  Eigen::VectorXd y(500);
  for (Eigen::Index i = 0; i < 500; ++i) x.row(i) = row(i).x.transpose(), y[i] = row(i).y;
  const Eigen::Vector2d least_squares = x.colPivHouseholderQr().solve(y);
  CHECK((fitted(rosin::huber_loss<>{1e9}, 1, {0, 0}, 1) - least_squares).norm() < 1e-10);
}

TEST_CASE("reweighted_pass: outliers pull less, and those that stop counting not at all") {
  const Eigen::Vector2d truth(2, -0.5);
  const double squares = (fitted(rosin::huber_loss<>{1e9}, 1) - truth).norm(),
               huber = (fitted(rosin::huber_loss<>{}, 0.02) - truth).norm(),
               cauchy = (fitted(rosin::cauchy_loss<>{}, 0.02, fitted(rosin::cauchy_loss<>{}, 1)) - truth).norm(),
               geman = (fitted(rosin::geman_mcclure_loss<>{}, 0.05, fitted(rosin::cauchy_loss<>{}, 0.2)) - truth).norm();
  CHECK(squares > 0.3);
  CHECK(huber < 0.1 * squares);
  CHECK(cauchy < 0.1 * huber);
  CHECK(geman < 1e-3);
}

TEST_CASE("reweighted_pass: the sum of rho never rises, and where it ends its slope is zero") {
  const auto descends = [](const auto& loss) {
    Eigen::Vector2d value(5, 1);
    double before = 1e300;
    for (int pass = 0; pass < 200; ++pass) {
      const double cost = rosin::reweighted_pass(loss, 0.1, 0, 500, row, value);
      CHECK(cost <= before * (1 + 1e-9));
      before = cost;
    }
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    for (Eigen::Index i = 0; i < 500; ++i) slope += loss.psi((row(i).y - row(i).x.dot(value)) / 0.1) * row(i).x;
    CHECK(slope.norm() < 1e-5);
  };
  descends(rosin::huber_loss<>{});
  descends(rosin::cauchy_loss<>{});
  descends(rosin::student_loss<>{});
}

TEST_CASE("reweighted_pass: what the rows do not tell of is zero") {
  Eigen::Vector2d value(1, 1);
  rosin::reweighted_pass(
      rosin::cauchy_loss<>{}, 1.0, 0, 10,
      [](Eigen::Index) {
        return rosin::regression_row<double, 2>{{1, 0}, 3};
      },
      value);
  CHECK(value[1] == 0);
  CHECK(value[0] == test::approx(3).epsilon(1e-10));
}
