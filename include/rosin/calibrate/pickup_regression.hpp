// tier: hosted
// SPDX-License-Identifier: MIT
//
// Regression for measurements that scatter more than their own errors say, with some that are plainly wrong.
//
//     y_i = model_i(theta) + e_i,     var e_i = v_i + (scatter * shape_i)^2
//
// v_i is known, the scatter is not: partials of a real string are shifted by its supports, one by one. Fit and scatter are
// Huber's (location with 1.5 sigma, "proposal 2" for the scale), in the end with a cut at 5 sigma; with less than eight numbers
// to spare nothing can be called an outlier, and it is 3 sigma and no cut. The covariance is Huber's sandwich, psi^2 / (mean
// psi')^2 (J' V^-1 J)^-1, never less than the plain one, widened for few degrees of freedom (Student) and for residuals that hang
// together from one partial to the next: (1 + r)/(1 - r), r their correlation.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/math/median.hpp>
#include <rosin/math/robust_loss.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct robust_fit {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd weight;      ///< 0 ... 1 for each measurement
  Eigen::MatrixXd gain;        ///< d value / d measurement
  double scatter = 0;          ///< in the unit of y / shape, beyond the errors given
  double cost = 0;             ///< minus log likelihood, to compare shapes of the scatter; less is better
  int used = 0;                ///< measurements with weight
  bool in_proportion = false;  ///< set by who chose between shapes of the scatter (fit_pitch)
};

/// Measurements, their variances, and how the scatter goes with them.
struct robust_data {
  Eigen::VectorXd y, variance, shape;
};

namespace detail {

template <class = void>
Eigen::VectorXd spread_of(const robust_data& d, double scatter) {
  return (d.variance.array() + (scatter * d.shape.array()).square()).sqrt();
}

/// Huber's loss, and where a residual stops counting at all, in standard deviations.
struct huber_limits {
  huber_loss<> loss{1.5};
  double cut = 5;

  [[nodiscard]] double weight(double u) const { return std::abs(u) > cut ? 0.0 : loss.weight(u); }
};

/// The scatter at which the bounded squares of residual / sigma add up to what a normal distribution would give.
template <class = void>
double scatter_of(const robust_data& d, const Eigen::VectorXd& residual, Eigen::Index parameters, const huber_loss<>& loss) {
  const double wanted = loss.usual_square() * std::max(static_cast<double>(d.y.size() - parameters), 0.5);
  const auto excess = [&](double s) {
    return residual.cwiseQuotient(spread_of(d, s)).cwiseAbs2().cwiseMin(loss.bend * loss.bend).sum() - wanted;
  };
  if (!(excess(0) > 0)) return 0;
  double low = 0, high = 10 * residual.cwiseAbs().cwiseQuotient(d.shape).maxCoeff();
  for (int i = 0; i < 60; ++i) (excess((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
  return high;
}

/// Variance of the M-estimate against that of least squares without outliers.
template <class = void>
double sandwich(const Eigen::VectorXd& u, Eigen::Index parameters, const huber_limits& limits) {
  double psi2 = 0, slope = 0, n = 0, product = 0, before = 0;
  for (const double v : u) {
    if (limits.weight(v) == 0) continue;
    const double psi = limits.weight(v) * v;
    psi2 += psi * psi;
    slope += limits.loss.slope(v);
    if (n > 0) product += psi * before;
    before = psi;
    n += 1;
  }
  const double freedom = n - static_cast<double>(parameters);
  if (freedom < 1) return 9;
  const double plain = std::max(1.0, psi2 / freedom / std::pow(std::max(slope / n, 0.3), 2));
  const double correlation = std::clamp(product / std::max(psi2, 1e-300), 0.0, 0.7);
  const double together = correlation > 1 / std::sqrt(n) ? (1 + correlation) / (1 - correlation) : 1.0;
  return plain * together * (freedom > 2.5 ? freedom / (freedom - 2) : 5.0);
}
ROSIN_INSTANTIATE(double sandwich(const Eigen::VectorXd&, Eigen::Index, const huber_limits&))

}  // namespace detail

/// Model: model(theta, prediction, jacobian) fills both. `start` has to be near enough that half of the data look right.
template <class Model>
[[nodiscard]] robust_fit robust_regression(const robust_data& data, const Model& model, const Eigen::VectorXd& start) {
  const Eigen::Index n = data.y.size(), p = start.size();
  robust_fit fit;
  fit.value = start;
  Eigen::VectorXd prediction(n), sigma(n), u(n);
  Eigen::MatrixXd jacobian(n, p);
  detail::huber_limits limits{{n - p < 8 ? 3.0 : 1.5}, std::numeric_limits<double>::infinity()};
  for (int i = 0; i < 50; ++i) {
    if (i == 15 && n - p >= 8) limits.cut = 5;
    model(fit.value, prediction, jacobian);
    const Eigen::VectorXd residual = data.y - prediction;
    fit.scatter = detail::scatter_of(data, residual, p, limits.loss);
    sigma = detail::spread_of(data, fit.scatter);
    u = residual.cwiseQuotient(sigma);
    fit.weight = u.unaryExpr([&](double v) { return limits.weight(v); });
    const Eigen::VectorXd w = fit.weight.cwiseQuotient(sigma.cwiseAbs2());
    const Eigen::VectorXd size = (jacobian.transpose() * w.asDiagonal() * jacobian).diagonal().cwiseMax(1e-300).cwiseSqrt();
    const Eigen::MatrixXd scaled = jacobian * size.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd inverse =
        (scaled.transpose() * w.asDiagonal() * scaled).completeOrthogonalDecomposition().pseudoInverse();
    fit.gain = size.cwiseInverse().asDiagonal() * inverse * scaled.transpose() * w.asDiagonal();
    const Eigen::VectorXd step = fit.gain * residual;
    fit.value += step;
    if (step.cwiseProduct(size).norm() < 1e-6) i = i < 14 ? 14 : 50;
  }
  const Eigen::MatrixXd scaled = sigma.cwiseInverse().asDiagonal() * jacobian;
  const Eigen::VectorXd size = scaled.colwise().norm().transpose().cwiseMax(1e-300);
  const Eigen::MatrixXd unit = scaled * size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd inverse = (unit.transpose() * unit).completeOrthogonalDecomposition().pseudoInverse();
  fit.covariance =
      detail::sandwich(u, p, limits) * (size.cwiseInverse().asDiagonal() * inverse * size.cwiseInverse().asDiagonal());
  fit.used = static_cast<int>((fit.weight.array() > 0).count());
  for (Eigen::Index i = 0; i < n; ++i) fit.cost += std::log(sigma[i]) + limits.loss.rho(std::min(std::abs(u[i]), limits.cut));
  return fit;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
