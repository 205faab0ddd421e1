// tier: hosted
// SPDX-License-Identifier: MIT
//
// The loss law from the partials' decay rates a_n,
//
//     a_n / (pi f_n) = 1/Q(f) = 1/Q0 + internal f + air / sqrt(f),      all three >= 0.
//
// Decay rates scatter in proportion to themselves (each support resonance takes its share), so the scatter is relative.
// The three terms look alike over two octaves: where least squares would make one negative it is zero, and the errors are
// those of the normal distribution cut off at zero (its second moments about the estimate, by sequential importance
// sampling after Geweke, Hajivassiliou and Keane on a fixed lattice): neither zero nor the absurd width of the unbounded fit.
//
#pragma once

#include <rosin/calibrate/pickup_regression.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/propagate/string_parameters.hpp>

#include <boost/math/special_functions/erf.hpp>

#include <Eigen/Dense>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Decay of a partial with its own standard deviation.
struct measured_decay {
  double frequency_Hz = 0;
  double decay_per_s = 0;
  double sd_per_s = 0;
};

struct loss_estimate {
  loss_law law;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();  ///< 1/Q0, internal (s), air (Hz^(1/2))
  Eigen::Vector3d sd = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double relative_scatter = 0;  ///< of single partials about the law, beyond their own errors
  int used = 0;

  /// Standard deviation of the law itself at a frequency; a single partial scatters besides.
  template <class = void>
  [[nodiscard]] double inverse_q_sd(double frequency_Hz) const {
    const Eigen::Vector3d slope{1, frequency_Hz, 1 / std::sqrt(frequency_Hz)};
    return std::sqrt(std::max(slope.dot(covariance * slope), 0.0));
  }
};

namespace detail {

/// E[(x - about)(x - about)'] of a normal distribution (mean, covariance) cut off to x >= 0.
template <class Real = double>
Eigen::MatrixXd moments_above_zero(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance, const Eigen::VectorXd& about) {
  const Eigen::Index n = mean.size();
  const Eigen::VectorX<Real> unit = covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
  Eigen::MatrixX<Real> correlation = unit.cwiseInverse().asDiagonal() * covariance * unit.cwiseInverse().asDiagonal();
  correlation.diagonal().array() += 1e-10;
  const Eigen::MatrixX<Real> L = correlation.llt().matrixL();
  const Eigen::VectorX<Real> centre = mean.cwiseQuotient(unit), from = about.cwiseQuotient(unit);
  constexpr double lattice[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};  // powers of 1 / 1.2207...
  Eigen::MatrixX<Real> sum = Eigen::MatrixX<Real>::Zero(n, n);
  double weights = 0;
  for (int k = 1; k <= 2000; ++k) {
    Eigen::VectorX<Real> u = Eigen::VectorX<Real>::Zero(n);
    double weight = 1;
    for (Eigen::Index i = 0; i < n; ++i) {
      const double low = -(centre[i] + L.row(i).head(i).dot(u.head(i))) / L(i, i);
      const double above = std::max(std::erfc(low / std::sqrt(2.0)) / 2, 1e-290);
      const double share = std::fmod(0.5 + k * lattice[i % 3], 1.0);
      u[i] = std::sqrt(2.0) * boost::math::erfc_inv(2 * above * std::max(share, 1e-9));
      weight *= above;
    }
    const Eigen::VectorX<Real> x = centre + L * u - from;
    sum += weight * x * x.transpose();
    weights += weight;
  }
  return unit.asDiagonal() * (sum / std::max(weights, 1e-300)) * unit.asDiagonal();
}

/// Columns of the loss law that are in `terms`, as a model for robust_regression.
struct loss_model {
  const std::vector<measured_decay>& data;
  std::vector<int> terms;

  [[nodiscard]] static double term(int which, double f) {
    return std::numbers::pi * f * (which == 0 ? 1 : which == 1 ? f : 1 / std::sqrt(f));
  }

  template <class = void>
  void operator()(const Eigen::VectorXd& theta, Eigen::VectorXd& y, Eigen::MatrixXd& J) const {
    for (Eigen::Index i = 0; i < y.size(); ++i)
      for (std::size_t k = 0; k < terms.size(); ++k)
        J(i, static_cast<Eigen::Index>(k)) = term(terms[k], data[static_cast<std::size_t>(i)].frequency_Hz);
    y = J * theta;
  }
};

/// Least squares with the terms given, the scatter in proportion to the law that results.
template <class Real = double>
robust_fit fit_loss_terms(const std::vector<measured_decay>& decays, const std::vector<int>& terms) {
  const auto n = static_cast<Eigen::Index>(decays.size());
  robust_data d{Eigen::VectorX<Real>(n), Eigen::VectorX<Real>(n), Eigen::VectorX<Real>(n)};
  Eigen::VectorX<Real> inverse_q(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& m = decays[static_cast<std::size_t>(i)];
    d.y[i] = m.decay_per_s;
    d.variance[i] = m.sd_per_s * m.sd_per_s;
    inverse_q[i] = m.decay_per_s / m.frequency_Hz;
  }
  const double usual = std::max(median_of(inverse_q), 1e-12);
  for (Eigen::Index i = 0; i < n; ++i) d.shape[i] = usual * decays[static_cast<std::size_t>(i)].frequency_Hz;
  const loss_model model{decays, terms};
  Eigen::VectorX<Real> theta = Eigen::VectorX<Real>::Zero(static_cast<Eigen::Index>(terms.size())), y(n);
  Eigen::MatrixX<Real> J(n, theta.size());
  const Eigen::VectorX<Real> least = 0.2 * d.shape;
  theta[0] = usual / loss_model::term(terms[0], 1) * (terms[0] == 0 ? 1 : 0);
  robust_fit fit;
  for (int i = 0; i < 6; ++i) {
    fit = robust_regression(d, model, theta);
    theta = fit.value;
    model(theta, y, J);
    d.shape = y.cwiseMax(least);
  }
  return fit;
}

}  // namespace detail

/// Constant alone below five partials. Precondition: at least one partial.
template <class = void>
[[nodiscard]] loss_estimate fit_loss(const std::vector<measured_decay>& decays) {
  std::vector<int> terms = decays.size() < 5 ? std::vector<int>{0} : std::vector<int>{0, 1, 2};
  const std::vector<int> all = terms;
  const robust_fit free = detail::fit_loss_terms(decays, all);
  robust_fit fit = free;
  for (Eigen::Index worst = 0; terms.size() > 1 && fit.value.minCoeff() < 0; fit = detail::fit_loss_terms(decays, terms)) {
    fit.value.cwiseQuotient(fit.covariance.diagonal().cwiseSqrt()).minCoeff(&worst);
    terms.erase(terms.begin() + worst);
  }
  loss_estimate loss;
  for (std::size_t k = 0; k < terms.size(); ++k) loss.value[terms[k]] = std::max(fit.value[static_cast<Eigen::Index>(k)], 0.0);
  const auto n = static_cast<Eigen::Index>(all.size());
  loss.covariance.topLeftCorner(n, n) = detail::moments_above_zero(free.value, free.covariance, loss.value.head(n));
  loss.sd = loss.covariance.diagonal().cwiseSqrt();
  loss.law = {loss.value[0] > 0 ? 1 / loss.value[0] : std::numeric_limits<double>::infinity(), loss.value[1], loss.value[2]};
  loss.relative_scatter = fit.scatter;
  loss.used = fit.used;
  return loss;
}
ROSIN_INSTANTIATE(loss_estimate fit_loss(const std::vector<measured_decay>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
