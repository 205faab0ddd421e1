// tier: hosted
// SPDX-License-Identifier: MIT
//
// How far the modes' losses scatter about their law, by the evidence (own_losses.hpp): what a fit with a loss of its own for each mode
// does besides.
//
#pragma once

#include <rosin/calibrate/pluck_problem.hpp>

#include <algorithm>
#include <cmath>
#include <span>

namespace rosin::detail {

/// Where a search for the scatter begins, and below what it counts as none.
inline constexpr double usual_loss_scatter = 0.1, least_loss_scatter = 2e-3;

/// How many modes a recording may tell the losses of.
[[nodiscard]] inline int modes_heard(const ringing_string& string, const band& limits, int most) {
  int n = 0;
  while (n < most && string.partial_Hz(n + 1) < limits.stop_Hz) ++n;
  return n;
}

/// Whether losses differ from mode to mode, as their prior has it: independently. A trend over many modes is something else that the
/// model lacks, a slow release, say, which they took up. The sum of products of neighbours is held against three times what it is by
/// chance where their signs are, its root mean square over all signs.
[[nodiscard]] inline bool scatters_from_mode_to_mode(std::span<const double> ln_loss) noexcept {
  double sum = 0, squares = 0;
  for (std::size_t n = 1; n < ln_loss.size(); ++n) {
    const double product = ln_loss[n - 1] * ln_loss[n];
    sum += product, squares += product * product;
  }
  return sum <= 3 * std::sqrt(squares);
}

/// The scatter that the evidence asks for, and what own losses cost of it: sum d_n^2 / s^2 + ln(s^2 / v_n).
struct loss_scatter {
  double value = 0, price = 0;
};
template <class Problem, class Real = double>
[[nodiscard]] loss_scatter scatter_of(const Problem& problem, const Eigen::VectorXd& v, double temper = 1) {
  const auto& layout = problem.model();
  if (!layout.has_own_losses(v)) return {};
  const pluck_equations eq = problem.linearise(v);
  const Eigen::MatrixX<Real> inverse = invert_free(layout, (eq.hessian - eq.prior) / temper + eq.prior);
  const double variance = std::pow(v[layout.loss_scatter()], 2);
  double squares = 0, told = 0, price = 0;
  for (Eigen::Index p = layout.first_of_own(); p < layout.first_of_ends(); ++p) {
    const double left = std::clamp(inverse(p, p) / variance, 1e-12, 1.0);
    squares += v[p] * v[p], told += 1 - left, price += v[p] * v[p] / variance - std::log(left);
  }
  return {told > 0 ? std::sqrt(squares / told) : 0.0, price};
}

/// Losses and scatter at their best, from where they are on.
template <class Descend>
void settle_scatter(const auto& problem, Eigen::VectorXd& v, Descend&& descend_once, int passes = 4) {
  const auto& layout = problem.model();
  for (int pass = 0; pass < passes; ++pass) {
    descend_once(v);
    const double was = v[layout.loss_scatter()], now = std::clamp(scatter_of(problem, v).value, 1e-4, 1.0);
    v[layout.loss_scatter()] = now;
    if (std::abs(now - was) < 0.02 * was) break;
  }
  descend_once(v);
}

}  // namespace rosin::detail
