// tier: hosted
// SPDX-License-Identifier: MIT
//
// A law (pickup_poles.hpp) fitted to a table of partials, frequencies and decays at once. No law of real strings is exact, so
// both have a scatter about it beside their own errors,
//
//     var f_n = sd^2 + (s_f shape)^2,  shape 1 or n, whichever is likelier;     var a_n = sd^2 + (s_a a_n)^2,
//
// found with the law (Huber's proposal 2) and robust against a few wrong partials (1.5 standard deviations). ln L therefore rises
// only as an effect takes scatter away: what stands for deviations no larger than those that remain is worth nothing, however
// small the errors.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pickup_poles.hpp>
#include <rosin/diagnose/pickup_table.hpp>
#include <rosin/math/levenberg_marquardt.hpp>

#include <array>
#include <utility>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One free number of a law.
struct law_parameter {
  std::string name;
  double pickup_law::*member = nullptr;
  double low = 0, high = 1;
  bool logarithmic = false;
};

/// Asks of a column of derivatives of (frequencies, decays): by how much would the weighted squares fall, half of it, if it joined
/// the parameters of a law, and what is its best size?
class law_score {
public:
  /// Roots of the weights; weighted Jacobian of the parameters that are free already; weighted residual.
  template <class = void>
  law_score(Eigen::VectorXd root, Eigen::MatrixXd jacobian, const Eigen::VectorXd& residual)
      : root_{std::move(root)}, jacobian_{std::move(jacobian)}, qr_{jacobian_}, rest_{without_jacobian(residual)} {}

  template <class Real = double>
  [[nodiscard]] std::pair<double, double> operator()(const Eigen::VectorXd& column) const {
    const Eigen::VectorX<Real> clean = without_jacobian(column.cwiseProduct(root_));
    const double size = clean.dot(rest_) / std::max(clean.squaredNorm(), 1e-300);
    return {0.5 * size * clean.dot(rest_), size};
  }

private:
  Eigen::VectorXd root_;
  Eigen::MatrixXd jacobian_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;
  Eigen::VectorXd rest_;

  template <class = void>
  [[nodiscard]] Eigen::VectorXd without_jacobian(const Eigen::VectorXd& v) const {
    return v - jacobian_ * qr_.solve(v);
  }
};

struct fitted_law {
  pickup_law law;
  std::vector<law_parameter> parameters;
  Eigen::VectorXd sd;  ///< of the parameters themselves
  double log_likelihood = -std::numeric_limits<double>::infinity();
  double scatter_Hz = 0, scatter_decay = 0;  ///< beyond errors; of the first partial where in_proportion; relative
  bool in_proportion = false;

  [[nodiscard]] double sd_of(const std::string& name) const {
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (parameters[i].name == name) return sd[static_cast<Eigen::Index>(i)];
    return 0;
  }
};

namespace detail {

inline constexpr huber_loss<> law_loss{1.5};

/// Frequencies, then decays.
inline Eigen::VectorXd predicted_lines(const line_table& table, const pickup_law& law) {
  const auto n = static_cast<Eigen::Index>(table.lines.size());
  Eigen::VectorXd y(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto s = pickup_pole(law, table.lines[static_cast<std::size_t>(i)].number);
    y[i] = s.imag() / full_turn, y[n + i] = -s.real();
  }
  return y;
}

/// What a prediction leaves of frequencies and of decays, with their errors and the shape of their scatter.
template <class = void>
std::array<robust_data, 2> left_by_law(const line_table& table, const Eigen::VectorXd& predicted, bool in_proportion) {
  const auto n = static_cast<Eigen::Index>(table.lines.size());
  std::array<robust_data, 2> left;
  for (auto& d : left) d.y.resize(n), d.variance.resize(n), d.shape.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& l = table.lines[static_cast<std::size_t>(i)];
    left[0].y[i] = l.frequency_Hz - predicted[i], left[1].y[i] = l.decay_per_s - predicted[n + i];
    left[0].variance[i] = std::pow(l.frequency_sd, 2), left[1].variance[i] = std::pow(l.decay_sd, 2);
    left[0].shape[i] = in_proportion ? l.number : 1.0, left[1].shape[i] = std::max(predicted[n + i], 0.2 * l.decay_per_s);
  }
  return left;
}

/// ln L but for a constant: squares up to the bend, straight beyond.
inline double robust_log_likelihood(const Eigen::VectorXd& left, const Eigen::VectorXd& sigma) {
  double sum = 0;
  for (Eigen::Index i = 0; i < left.size(); ++i) sum -= std::log(sigma[i]) + law_loss.rho(left[i] / sigma[i]);
  return sum;
}

class law_problem {
public:
  law_problem(const line_table& table, const std::vector<law_parameter>& parameters, bool in_proportion)
      : table_{table}, parameters_{parameters}, proportion_{in_proportion}, rows_{static_cast<Eigen::Index>(table.lines.size())} {
  }

  /// A law, and what it leaves of the table.
  struct view {
    pickup_law law;
    Eigen::VectorXd residual, weight;
    double scatter_Hz = 0, scatter_decay = 0, log_likelihood = 0;
  };
  /// In the units of squares: 2 (-ln L).
  [[nodiscard]] double cost(const view& v) const { return -2 * v.log_likelihood; }
  template <class Real = double>
  [[nodiscard]] normal_equations<> linearise(const view& v) const {
    const Eigen::VectorX<Real> root = v.weight.cwiseSqrt();
    const Eigen::MatrixX<Real> j = jacobian(v.law).array().colwise() * root.array();
    return {j.transpose() * j, j.transpose() * v.residual.cwiseProduct(root), cost(v)};
  }
  [[nodiscard]] view moved(const view& v, const Eigen::VectorXd& by) const {
    pickup_law l = v.law;
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
      const auto& p = parameters_[k];
      double& x = l.*p.member;
      const double step = by[static_cast<Eigen::Index>(k)];
      x = std::clamp(p.logarithmic ? x * std::exp(std::clamp(step, -1.0, 1.0)) : x + step, p.low, p.high);
    }
    return look(l);
  }

  template <class = void>
  [[nodiscard]] fitted_law fit(const pickup_law& start) const {
    const auto found = levenberg_marquardt(
        *this, look(start),
        {.first = 1e-2, .less = 1.0 / 6, .more = 5, .floor = 1e-10, .iterations = 60, .enough = 2e-5, .enough_relative = 0});
    fitted_law best;
    best.law = found.at.law, best.parameters = parameters_, best.in_proportion = proportion_;
    finish(best, found.at);
    return best;
  }

  /// What a further parameter at this law would do.
  template <class Real = double>
  [[nodiscard]] law_score score_at(const pickup_law& l) const {
    const view state = look(l);
    const Eigen::VectorX<Real> root = state.weight.cwiseSqrt();
    const Eigen::MatrixX<Real> j = jacobian(l).array().colwise() * root.array();
    return {root, j, state.residual.cwiseProduct(root)};
  }
  [[nodiscard]] Eigen::VectorXd predicted(const pickup_law& l) const { return predicted_lines(table_, l); }

private:
  template <class Real = double>
  [[nodiscard]] view look(const pickup_law& l) const {
    const auto left = left_by_law(table_, predicted(l), proportion_);
    view v{l, Eigen::VectorX<Real>(2 * rows_), Eigen::VectorX<Real>(2 * rows_)};
    const auto half = std::max<Eigen::Index>(1, static_cast<Eigen::Index>(parameters_.size()) / 2);
    for (Eigen::Index b = 0; b < 2; ++b) {
      const auto& d = left[static_cast<std::size_t>(b)];
      double& scatter = b == 0 ? v.scatter_Hz : v.scatter_decay;
      scatter = scatter_of(d, d.y, half, law_loss);
      const Eigen::VectorX<Real> sigma = spread_of(d, scatter);
      v.residual.segment(b * rows_, rows_) = d.y;
      for (Eigen::Index i = 0; i < rows_; ++i)
        v.weight[b * rows_ + i] = law_loss.weight(d.y[i] / sigma[i]) / (sigma[i] * sigma[i]);
      v.log_likelihood += robust_log_likelihood(d.y, sigma);
    }
    return v;
  }
  template <class Real = double>
  [[nodiscard]] Eigen::MatrixXd jacobian(const pickup_law& l) const {
    Eigen::MatrixX<Real> j(2 * rows_, static_cast<Eigen::Index>(parameters_.size()));
    for (std::size_t k = 0; k < parameters_.size(); ++k) {
      const auto& p = parameters_[k];
      pickup_law up = l, down = l;
      const double x = l.*p.member, h = p.logarithmic ? 1e-5 : 1e-5 * std::max(std::abs(x), 1e-3 * (p.high - p.low));
      up.*p.member = p.logarithmic ? x * std::exp(h) : x + h;
      down.*p.member = p.logarithmic ? x * std::exp(-h) : x - h;
      j.col(static_cast<Eigen::Index>(k)) = (predicted(up) - predicted(down)) / (2 * h);
    }
    return j;
  }
  template <class Real = double>
  void finish(fitted_law& f, const view& v) const {
    f.log_likelihood = v.log_likelihood, f.scatter_Hz = v.scatter_Hz, f.scatter_decay = v.scatter_decay;
    const Eigen::MatrixX<Real> j = jacobian(f.law).array().colwise() * v.weight.cwiseSqrt().array();
    const Eigen::VectorX<Real> size = j.colwise().norm().transpose().cwiseMax(1e-300);
    const Eigen::MatrixX<Real> unit = j * size.cwiseInverse().asDiagonal();
    const Eigen::MatrixX<Real> inverse = (unit.transpose() * unit).completeOrthogonalDecomposition().pseudoInverse();
    const double free = static_cast<double>(2 * rows_) - static_cast<double>(parameters_.size());
    f.sd = (inverse.diagonal() * (free > 2.5 ? free / (free - 2) : 5.0)).cwiseMax(0.0).cwiseSqrt().cwiseQuotient(size);
    for (std::size_t k = 0; k < parameters_.size(); ++k)
      if (parameters_[k].logarithmic) f.sd[static_cast<Eigen::Index>(k)] *= f.law.*parameters_[k].member;
  }

  const line_table& table_;
  const std::vector<law_parameter>& parameters_;
  bool proportion_;
  Eigen::Index rows_;
};

}  // namespace detail

/// From `start` on, with the scatter of the likelier shape. Precondition: at least four lines.
template <class = void>
[[nodiscard]] fitted_law fit_law(const line_table& table, const std::vector<law_parameter>& parameters, const pickup_law& start) {
  fitted_law alike = detail::law_problem(table, parameters, false).fit(start);
  fitted_law scaled = detail::law_problem(table, parameters, true).fit(start);
  return scaled.log_likelihood > alike.log_likelihood ? scaled : alike;
}

/// ln L of other partials of the same string (another pitch is allowed) by a law that was fitted elsewhere, with the scatter that
/// they themselves have about it.
template <class Real = double>
[[nodiscard]] double predicted_log_likelihood(const line_table& table, const fitted_law& fit) {
  const auto n = static_cast<Eigen::Index>(table.lines.size());
  Eigen::VectorX<Real> y = detail::predicted_lines(table, fit.law), off(n);
  for (Eigen::Index i = 0; i < n; ++i) off[i] = std::log(table.lines[static_cast<std::size_t>(i)].frequency_Hz / y[i]);
  y.head(n) *= std::exp(median_of(off));
  double sum = 0;
  for (const auto& d : detail::left_by_law(table, y, fit.in_proportion))
    sum += detail::robust_log_likelihood(d.y, detail::spread_of(d, detail::scatter_of(d, d.y, 1, detail::law_loss)));
  return sum;
}
ROSIN_INSTANTIATE(double predicted_log_likelihood(const line_table&, const fitted_law&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
