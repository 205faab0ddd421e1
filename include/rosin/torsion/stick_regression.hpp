// tier: hosted
// SPDX-License-Identifier: MIT
//
// Least squares for what should be steady while the string sticks, over several takes: coefficients that all takes share, and
// some that each has of its own (its level). Residuals follow Student's t with 4 degrees of freedom: a slip that was taken for
// sticking counts little. Iterated weights reach its maximum of likelihood.
//
// Neighbouring samples are not independent, the band limit and every model's error see to that. So rows are counted by the
// residual's correlation (`effective`), and standard errors come from the scatter of whole blocks of rows (the sandwich of
// Huber and White) and not from the rows' number.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/math/robust_loss.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The rows of one take: target = shared * s + own * o + residual. `sample` says from where each row is (ascending).
struct stick_rows {
  Eigen::VectorXd target;
  Eigen::MatrixXd shared, own;
  std::vector<std::size_t> sample;
};

struct stick_solution {
  Eigen::VectorXd shared;            ///< coefficients common to all takes
  std::vector<Eigen::VectorXd> own;  ///< of each take
  Eigen::MatrixXd covariance;        ///< of `shared`, by blocks
  std::vector<Eigen::VectorXd> residual;
  double scale = 0;           ///< of Student's t; about the standard deviation of the bulk
  double log_likelihood = 0;  ///< per effective row, summed over the effective rows
  double rows = 0, effective = 0;
};

/// Gaussian knowledge of the shared coefficients: precision 0 where there is none.
struct stick_prior {
  Eigen::VectorXd centre, precision;
};

namespace detail {

inline constexpr student_loss<> stick_loss{4};

[[nodiscard]] inline double student_log_density(double x, double scale) {
  constexpr double of_zero = -0.98082925301172623;  // ln Gamma((n + 1)/2) - ln Gamma(n/2) - ln(n pi) / 2 for n = 4
  return of_zero - std::log(scale) - stick_loss.rho(x / scale);
}

/// What squares are to be weighted by, as Student's likelihood asks; and what to multiply rows by for that.
template <class = void>
[[nodiscard]] Eigen::VectorXd student_weights(const Eigen::VectorXd& residual, double scale) {
  return (residual / scale).unaryExpr([](double u) { return stick_loss.weight(u); });
}
template <class = void>
[[nodiscard]] Eigen::VectorXd student_row_factors(const Eigen::VectorXd& residual, double scale) {
  return student_weights(residual, scale).cwiseSqrt();
}

/// Mean number of rows that one independent row is worth, from the autocorrelation over up to `lags` samples.
[[nodiscard]] inline double rows_per_independent(const std::vector<stick_rows>& takes,
                                                 const std::vector<Eigen::VectorXd>& residual, double scale,
                                                 std::size_t lags = 32) {
  std::vector<double> sum(lags + 1, 0.0), count(lags + 1, 0.0);
  for (std::size_t t = 0; t < takes.size(); ++t) {
    const auto& at = takes[t].sample;
    const auto clipped = [&](std::size_t i) {
      return std::clamp(residual[t][static_cast<Eigen::Index>(i)], -3 * scale, 3 * scale);
    };
    for (std::size_t i = 0; i < at.size(); ++i)
      for (std::size_t j = i; j < at.size() && at[j] - at[i] <= lags; ++j) {
        sum[at[j] - at[i]] += clipped(i) * clipped(j);
        count[at[j] - at[i]] += 1;
      }
  }
  if (!(count[0] > 0) || !(sum[0] > 0)) return 1;
  double total = 1;
  for (std::size_t lag = 1; lag <= lags; ++lag)
    if (count[lag] > 50) total += 2 * std::abs(sum[lag] / count[lag]) / (sum[0] / count[0]);
  return std::max(1.0, total);
}

struct stacked {
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
  std::vector<Eigen::Index> first;  // row of each take, and the end
};

template <class Real = double>
[[nodiscard]] stacked stack(const std::vector<stick_rows>& takes) {
  stacked s;
  Eigen::Index rows = 0, columns = takes.empty() ? 0 : takes.front().shared.cols();
  for (const auto& t : takes) s.first.push_back(rows), rows += t.target.size(), columns += t.own.cols();
  s.first.push_back(rows);
  s.x = Eigen::MatrixX<Real>::Zero(rows, columns);
  s.y.resize(rows);
  Eigen::Index own = takes.empty() ? 0 : takes.front().shared.cols();
  for (std::size_t t = 0; t < takes.size(); ++t) {
    const Eigen::Index n = takes[t].target.size();
    s.y.segment(s.first[t], n) = takes[t].target;
    s.x.block(s.first[t], 0, n, takes[t].shared.cols()) = takes[t].shared;
    s.x.block(s.first[t], own, n, takes[t].own.cols()) = takes[t].own;
    own += takes[t].own.cols();
  }
  return s;
}
ROSIN_INSTANTIATE(stacked stack(const std::vector<stick_rows>&))

/// Inverse Hessian times the scatter of blocks' gradients times inverse Hessian.
template <class Real = double>
[[nodiscard]] Eigen::MatrixXd sandwich(const stacked& s, const Eigen::VectorXd& weighted_residual,
                                       const Eigen::MatrixXd& inverse) {
  constexpr Eigen::Index blocks = 24;
  Eigen::MatrixX<Real> scatter = Eigen::MatrixX<Real>::Zero(inverse.rows(), inverse.cols());
  for (std::size_t t = 0; t + 1 < s.first.size(); ++t)
    for (Eigen::Index b = 0, n = s.first[t + 1] - s.first[t]; b < blocks; ++b) {
      const Eigen::Index from = s.first[t] + n * b / blocks, size = s.first[t] + n * (b + 1) / blocks - from;
      const Eigen::VectorX<Real> gradient = s.x.middleRows(from, size).transpose() * weighted_residual.segment(from, size);
      scatter += gradient * gradient.transpose();
    }
  return inverse * scatter * inverse;
}

}  // namespace detail

/// Preconditions: all takes have as many shared columns; rows in all exceed the columns. `floor`: least scale.
template <class Real = double>
[[nodiscard]] stick_solution stick_regression(const std::vector<stick_rows>& takes, double floor = 0,
                                              const stick_prior& prior = {}) {
  const detail::stacked s = detail::stack(takes);
  const Eigen::Index shared = takes.front().shared.cols(), all = s.x.cols(), n = s.y.size();
  Eigen::VectorX<Real> weight = Eigen::VectorX<Real>::Ones(n), value = Eigen::VectorX<Real>::Zero(all), residual = s.y;
  Eigen::MatrixX<Real> hessian;
  stick_solution out;
  out.scale = std::max(floor, std::sqrt(s.y.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, n))));
  for (int pass = 0; pass < 20; ++pass) {
    const Eigen::MatrixX<Real> wx = weight.asDiagonal() * s.x;
    hessian = s.x.transpose() * wx;
    Eigen::VectorX<Real> gradient = wx.transpose() * s.y;
    if (prior.precision.size() == shared) {
      hessian.diagonal().head(shared) += prior.precision * (out.scale * out.scale);
      gradient.head(shared) += prior.precision.cwiseProduct(prior.centre) * (out.scale * out.scale);
    }
    hessian.diagonal() *= 1 + 1e-12;
    value = hessian.ldlt().solve(gradient);
    residual = s.y - s.x * value;
    const double before = out.scale;
    for (int inner = 0; inner < 3; ++inner) {
      weight = detail::student_weights(residual, out.scale);
      out.scale = std::max(floor, std::sqrt(weight.dot(residual.cwiseAbs2()) / static_cast<double>(n)));
    }
    if (pass > 2 && std::abs(out.scale - before) < 1e-3 * before) break;
  }
  out.shared = value.head(shared);
  Eigen::Index at = shared;
  for (std::size_t t = 0; t < takes.size(); at += takes[t].own.cols(), ++t) {
    out.own.push_back(value.segment(at, takes[t].own.cols()));
    out.residual.push_back(residual.segment(s.first[t], s.first[t + 1] - s.first[t]));
  }
  // of the influence, against the weights
  const double slope =
      (residual / out.scale).unaryExpr([](double u) { return detail::stick_loss.slope(u); }).sum() / weight.sum();
  const Eigen::MatrixX<Real> inverse = hessian.ldlt().solve(Eigen::MatrixX<Real>::Identity(all, all)) / std::max(0.2, slope);
  out.covariance = detail::sandwich(s, weight.cwiseProduct(residual), inverse).topLeftCorner(shared, shared);
  out.rows = static_cast<double>(n);
  out.effective = out.rows / detail::rows_per_independent(takes, out.residual, out.scale);
  for (Eigen::Index i = 0; i < n; ++i) out.log_likelihood += detail::student_log_density(residual[i], out.scale);
  out.log_likelihood *= out.effective / std::max(1.0, out.rows);
  return out;
}
ROSIN_INSTANTIATE(stick_solution stick_regression(const std::vector<stick_rows>&, double, const stick_prior&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
