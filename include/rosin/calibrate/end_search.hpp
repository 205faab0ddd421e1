// tier: hosted
// SPDX-License-Identifier: MIT
//
// Which further mode, at which end, would explain most of what a fit of plucks leaves? A mode enters the admittance linearly, so
// that to first order its effect on the recordings is d = (dA / dz_j) m(s), and the score test (Rao 1948)
//
//     mix = (d'r - d'J H^-1 J'r) / (d'd - d'J H^-1 J'd),      gain of ln L = mix^2 (...) / 2
//
// tells how heavy it would be and what it would be worth, everything else readjusted, for thousands of frequencies and Qs in one
// sweep.
//
#pragma once

#include <rosin/calibrate/end_problem.hpp>
#include <rosin/core/instantiate.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct mode_candidate {
  std::size_t end = 0;
  admittance_mode mode;  ///< with the mass that the score proposes
  double gain = 0;       ///< of ln L
};

namespace detail {

/// A grid as fine as the resonances are wide.
inline std::vector<mode_candidate> mode_grid(const std::array<bool, 2>& free_ends, double from_Hz, double to_Hz) {
  std::vector<mode_candidate> all;
  for (const double q : {2.0, 6.0, 18.0, 50.0})
    for (double f = from_Hz; f < to_Hz; f *= 1 + 0.6 / q)
      for (const std::size_t e : {0U, 1U})
        if (free_ends[e]) all.push_back({e, {f, q, 1}, 0});
  return all;
}

/// What one channel of one take says of a batch of candidates.
struct score_sums {
  Eigen::VectorXd with_residual, square;
  Eigen::MatrixXd with_jacobian;
};

template <class Real = double>
void add_scores(const end_problem::rows& r, const damped_line_of_frequencies& line, std::span<const mode_candidate> batch,
                score_sums& sums) {
  const auto bins = static_cast<Eigen::Index>(line.bins());
  Eigen::MatrixX<Real> columns(2 * bins, static_cast<Eigen::Index>(batch.size()));
  for (std::size_t k = 0; k < batch.size(); ++k)
    for (Eigen::Index i = 0; i < bins; ++i) {
      const std::complex<double> d =
          r.by_admittance[batch[k].end][static_cast<std::size_t>(i)] * batch[k].mode(line.at(static_cast<std::size_t>(i)));
      columns(i, static_cast<Eigen::Index>(k)) = d.real(), columns(bins + i, static_cast<Eigen::Index>(k)) = d.imag();
    }
  sums.with_residual += columns.transpose() * r.residual;
  sums.square += columns.colwise().squaredNorm().transpose();
  sums.with_jacobian += r.jacobian.transpose() * columns;
}

}  // namespace detail

/// The candidates with their gains, the best first. `hessian`: of data and prior at `v`.
template <class Real = double>
[[nodiscard]] std::vector<mode_candidate> search_modes(const end_problem& problem, const end_model& m, const Eigen::VectorXd& v,
                                                       const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                                                       const std::array<bool, 2>& free_ends, double from_Hz, double to_Hz) {
  constexpr std::size_t at_once = 64;
  std::vector<mode_candidate> all = detail::mode_grid(free_ends, from_Hz, to_Hz);
  std::vector<detail::score_sums> sums;
  for (std::size_t k = 0; k < all.size(); k += at_once) {
    const auto n = static_cast<Eigen::Index>(std::min(at_once, all.size() - k));
    sums.push_back({Eigen::VectorX<Real>::Zero(n), Eigen::VectorX<Real>::Zero(n), Eigen::MatrixX<Real>::Zero(m.size(), n)});
  }
  for (std::size_t t = 0; t < problem.takes(); ++t)
    for (std::size_t c = 0; c < 2; ++c) {
      const end_problem::rows r = problem.at(m, v, t, c, true);
      for (std::size_t b = 0; b < sums.size(); ++b)
        detail::add_scores(r, problem.line(t), std::span(all).subspan(b * at_once, std::min(at_once, all.size() - b * at_once)),
                           sums[b]);
    }
  const Eigen::MatrixX<Real> inverse = invert_free(m, hessian);
  const Eigen::VectorX<Real> step = inverse * gradient;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const detail::score_sums& s = sums[k / at_once];
    const auto i = static_cast<Eigen::Index>(k % at_once);
    const Eigen::VectorX<Real> dJ = s.with_jacobian.col(i);
    const double free = s.square[i] - dJ.dot(inverse * dJ), excess = s.with_residual[i] - dJ.dot(step);
    if (!(free > 1e-9 * s.square[i]) || !(excess > 0)) continue;
    all[k].gain = 0.5 * excess * excess / free;
    all[k].mode.per_mass_per_s = excess / free;
  }
  std::sort(all.begin(), all.end(), [](const mode_candidate& a, const mode_candidate& b) { return a.gain > b.gain; });
  return all;
}
ROSIN_INSTANTIATE(std::vector<mode_candidate> search_modes(const end_problem&, const end_model&, const Eigen::VectorXd&,
                                                           const Eigen::MatrixXd&, const Eigen::VectorXd&,
                                                           const std::array<bool, 2>&, double, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
