// tier: hosted
// SPDX-License-Identifier: MIT
//
// One pass of iteratively reweighted least squares for a few coefficients over many rows,
//
//     sum_i weight(u_i) x_i x_i' value = sum_i weight(u_i) x_i y_i,     u_i = (y_i - x_i' value before) / scale,
//
// the rows never in memory as a matrix. Passes at one scale only ever lower sum rho(u_i) where weight falls with |u|, which it does for all of
// robust_loss.hpp (Huber 1981, section 7.8); with losses that are not convex they end in the minimum nearest to where they began, so that
// whoever begins far begins with a large scale.
//
#pragma once

#include <rosin/math/robust_loss.hpp>

#include <Eigen/Dense>

namespace rosin {

/// A row: y = x' value + residual.
template <class Real, int Size>
struct regression_row {
  Eigen::Vector<Real, Size> x;
  Real y;
};

/// Moves `value` by one pass over row(first) ... row(last - 1). Returns sum rho at the value that came in. What the rows do not
/// tell of becomes 0. Allocates nothing.
template <RobustLoss Loss, class Rows, class Real, int Size>
Real reweighted_pass(const Loss& loss, Real scale, Eigen::Index first, Eigen::Index last, const Rows& row,
                     Eigen::Vector<Real, Size>& value) {
  static_assert(Size != Eigen::Dynamic);
  Eigen::Matrix<Real, Size, Size> normal = Eigen::Matrix<Real, Size, Size>::Zero();
  Eigen::Vector<Real, Size> side = Eigen::Vector<Real, Size>::Zero();
  Real cost = 0;
  for (Eigen::Index i = first; i < last; ++i) {
    const regression_row<Real, Size> r = row(i);
    const Real u = (r.y - r.x.dot(value)) / scale, weight = loss.weight(u);
    normal += weight * r.x * r.x.transpose();
    side += weight * r.y * r.x;
    cost += loss.rho(u);
  }
  normal.diagonal().array() += Real(1e-12) * normal.diagonal().maxCoeff();
  value = normal.ldlt().solve(side);
  return cost;
}

}  // namespace rosin
