// tier: hosted
// SPDX-License-Identifier: MIT
//
// The equation of sticking (contact_stick.hpp) as rows and columns: columns are added to it by whoever has a hypothesis, their
// coefficients kept within bounds, and every fit knows how well each take is predicted from the others.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/torsion/stick_regression.hpp>

#include <array>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The equation's rows, ready for more columns.
struct stick_design {
  std::vector<stick_rows> rows;
  std::vector<std::array<double, 2>> bounds;  ///< of the shared coefficients

  template <class = void>
  void add_shared(std::size_t take, const std::vector<double>& samples) {
    append(rows[take].shared, rows[take].sample, samples);
  }
  template <class = void>
  void add_own(std::size_t take, const std::vector<double>& samples) {
    append(rows[take].own, rows[take].sample, samples);
  }
  void add_bound(double low, double high) { bounds.push_back({low, high}); }

private:
  template <class = void>
  static void append(Eigen::MatrixXd& to, const std::vector<std::size_t>& at, const std::vector<double>& samples) {
    const Eigen::Index c = to.cols();
    to.conservativeResize(static_cast<Eigen::Index>(at.size()), c + 1);
    for (std::size_t i = 0; i < at.size(); ++i) to(static_cast<Eigen::Index>(i), c) = samples[at[i]];
  }
};

/// A regression with its likelihoods: of everything, and of each part as predicted from the others.
struct design_fit {
  stick_solution solution{};
  double density = 0, held_out = 0;  ///< sums of log densities over all rows, as if these were independent
  double share = 1;                  ///< independent rows / rows
};

namespace detail {

/// Takes cut in halves if there is only one.
template <class = void>
[[nodiscard]] std::vector<stick_rows> at_least_two(const std::vector<stick_rows>& rows) {
  if (rows.size() != 1) return rows;
  const auto& r = rows.front();
  const Eigen::Index half = r.target.size() / 2, rest = r.target.size() - half;
  const auto middle = r.sample.begin() + half;
  return {{r.target.head(half), r.shared.topRows(half), r.own.topRows(half), {r.sample.begin(), middle}},
          {r.target.tail(rest), r.shared.bottomRows(rest), r.own.bottomRows(rest), {middle, r.sample.end()}}};
}

/// The rows that are marked.
template <class = void>
[[nodiscard]] stick_rows rows_of(const stick_rows& all, const std::vector<char>& marked) {
  std::vector<Eigen::Index> kept;
  stick_rows out;
  for (std::size_t i = 0; i < marked.size(); ++i)
    if (marked[i]) kept.push_back(static_cast<Eigen::Index>(i)), out.sample.push_back(all.sample[i]);
  const auto of_rows = [&](const auto& m) { return m(kept, Eigen::seqN(0, m.cols())).eval(); };
  out.target = all.target(kept), out.shared = of_rows(all.shared), out.own = of_rows(all.own);
  return out;
}
ROSIN_INSTANTIATE(stick_rows rows_of(const stick_rows&, const std::vector<char>&))

/// Log density of one part under the shared coefficients of the others; its own coefficients and the size of what is left are its
/// own. `marked`: the rows that count; empty: all.
template <class = void>
[[nodiscard]] double predict_part(const std::vector<stick_rows>& parts, std::size_t which, double floor, const stick_prior& prior,
                                  const std::vector<char>& marked = {}) {
  std::vector<stick_rows> others;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (i != which && parts[i].target.size() > parts[i].own.cols() + parts[i].shared.cols()) others.push_back(parts[i]);
  stick_rows left = marked.empty() ? parts[which] : rows_of(parts[which], marked);
  if (others.empty() || left.target.size() <= left.own.cols()) return 0;
  const auto trained = stick_regression(others, floor, prior);
  left.target -= left.shared * trained.shared;
  left.shared.resize(left.target.size(), 0);
  const auto seen = stick_regression({left}, floor);
  double sum = 0;
  for (const double r : seen.residual.front()) sum += student_log_density(r, seen.scale);
  return sum;
}

}  // namespace detail

/// The regression with coefficients that would leave their bounds held there.
template <class Real = double>
[[nodiscard]] stick_solution bounded_regression(const stick_design& design, double floor, stick_prior& held) {
  const auto n = static_cast<Eigen::Index>(design.bounds.size());
  held = {Eigen::VectorX<Real>::Zero(n), Eigen::VectorX<Real>::Zero(n)};
  stick_solution s = stick_regression(design.rows, floor);
  for (int pass = 0; pass < 4; ++pass) {
    bool inside = true;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto [low, high] = design.bounds[static_cast<std::size_t>(i)];
      const double slack = 1e-6 * (1 + std::abs(low) + std::abs(high));
      if (held.precision[i] > 0 || (s.shared[i] >= low - slack && s.shared[i] <= high + slack)) continue;
      held.centre[i] = s.shared[i] < low ? low : high;
      held.precision[i] = 1e14;
      inside = false;
    }
    if (inside) break;
    s = stick_regression(design.rows, floor, held);
  }
  return s;
}
ROSIN_INSTANTIATE(stick_solution bounded_regression(const stick_design&, double, stick_prior&))

template <class = void>
[[nodiscard]] design_fit fit_design(const stick_design& design, double floor) {
  stick_prior held;
  design_fit fit{};
  fit.solution = bounded_regression(design, floor, held);
  fit.share = fit.solution.effective / std::max(1.0, fit.solution.rows);
  fit.density = fit.solution.log_likelihood / fit.share;
  const auto parts = detail::at_least_two(design.rows);
  for (std::size_t i = 0; i < parts.size(); ++i) fit.held_out += detail::predict_part(parts, i, floor, held);
  return fit;
}
ROSIN_INSTANTIATE(design_fit fit_design(const stick_design&, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
