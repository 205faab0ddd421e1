// tier: hosted
// SPDX-License-Identifier: MIT
//
// A stroke that starts from rest: how its rod reaches the speed that is declared, told by the motion alone. For most of every
// period the string sticks to the rod, so that the median of the velocity over a period is the rod's, but for a constant. What is
// fitted to these medians is the approach of a carriage that is held back by drag, and of a servo,
//
//     v(t) = v (1 - share e^(-t / time)),
//
// by Cauchy's likelihood, which bears the periods in which the string does not stick; every time on a grid, share and level by least
// squares. A rod that is as fast as declared when the samples begin to count, or cannot be told from one, approaches nothing.
// Medians rise, too, while a string that has not settled slips for less and less of its periods: the two are not told apart
// (the fastest samples do not tell them: an attack is faster than its rod).
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/math/median.hpp>
#include <rosin/math/reweighted_regression.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Counted from a take's first sample.
struct rod_approach {
  double share = 0, time_s = 1;

  [[nodiscard]] bool seen() const noexcept { return share > 0; }
  /// What is missing of the steady speed, relative to it.
  [[nodiscard]] double lag(double at_s) const noexcept { return seen() ? share * std::exp(-at_s / time_s) : 0; }
  /// From when on no more than that is missing.
  [[nodiscard]] double within_s(double missing) const noexcept {
    return share > missing ? time_s * std::log(share / missing) : 0;
  }
  /// The same, counted from a later sample.
  [[nodiscard]] rod_approach from(double later_s) const noexcept { return {lag(later_s), time_s}; }
};

namespace detail {

/// Medians over periods, and when.
struct period_medians {
  std::vector<double> at_s, relative;

  template <class = void>
  period_medians(std::span<const double> velocity_m_s, double rate_Hz, double period_s, double rod_speed_m_s, double after_s) {
    const auto length = static_cast<std::size_t>(std::max(1.0, std::round(period_s * rate_Hz)));
    for (auto first = static_cast<std::size_t>(after_s * rate_Hz); first + length <= velocity_m_s.size(); first += length) {
      const auto one = velocity_m_s.subspan(first, length);
      if (!std::all_of(one.begin(), one.end(), [](double v) { return std::isfinite(v); })) continue;
      at_s.push_back((static_cast<double>(first) + 0.5 * static_cast<double>(length)) / rate_Hz);
      relative.push_back(median_of(one) / rod_speed_m_s);
    }
  }
  [[nodiscard]] Eigen::Index size() const noexcept { return static_cast<Eigen::Index>(at_s.size()); }
};

/// A line through medians against one column, by Cauchy's likelihood; the cost at its least.
struct approach_line {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();  ///< level, factor of the column
  double cost = 0;
  Eigen::VectorXd left;

  template <class = void>
  approach_line(const Eigen::VectorXd& target, const Eigen::VectorXd& column, double scale) {
    constexpr cauchy_loss<> loss;
    value[0] = target.maxCoeff();
    const auto row = [&](Eigen::Index i) { return regression_row<double, 2>{{1, column[i]}, target[i]}; };
    for (int pass = 0; pass < 12; ++pass) reweighted_pass(loss, scale, 0, target.size(), row, value);
    left = target.array() - value[0] - value[1] * column.array();
    for (const double r : left) cost += 2 * loss.rho(r / scale);
  }
  template <class = void>
  [[nodiscard]] double scatter() const {
    return median_of(left.cwiseAbs());
  }
};

}  // namespace detail

/// Of the string's centre under the bow (NaN: unknown) of a stroke at this steady speed. `after_s`: until when nothing counts.
template <class Real = double>
[[nodiscard]] rod_approach find_rod_approach(std::span<const double> velocity_m_s, double rate_Hz, double period_s,
                                             double rod_speed_m_s, double after_s) {
  constexpr std::size_t least = 12;        // medians
  constexpr double least_lag = 0.02;       // at after_s
  constexpr double least_evidence = 12;    // natural logarithm
  constexpr double least_scatter = 0.002;  // of medians, of the speed
  constexpr double shortest_s = 0.004;
  const detail::period_medians medians(velocity_m_s, rate_Hz, period_s, rod_speed_m_s, after_s);
  if (medians.at_s.size() < least || !(rod_speed_m_s != 0)) return {};
  const Eigen::VectorX<Real> target = Eigen::VectorX<Real>::Map(medians.relative.data(), medians.size());
  const Eigen::ArrayX<Real> since = Eigen::ArrayX<Real>::Map(medians.at_s.data(), medians.size()) - after_s;
  const double longest_s = 0.5 * since.maxCoeff();
  const auto column = [&](double time_s) -> Eigen::VectorX<Real> { return -(-since / time_s).exp(); };
  double time_s = shortest_s, scale = 0.05;
  for (int pass = 0; pass < 4; ++pass) {
    double least_cost = 1e300, scatter = scale;
    for (double t = shortest_s; t < longest_s; t *= 1.06)
      if (const detail::approach_line tried(target, column(t), scale); tried.cost < least_cost)
        least_cost = tried.cost, time_s = t, scatter = tried.scatter();
    scale = std::max(least_scatter, scatter);
  }
  const detail::approach_line found(target, column(time_s), scale),
      steady(target, Eigen::VectorX<Real>::Zero(medians.size()), scale);
  const double lag = found.value[1] / found.value[0];
  if (!(found.value[0] > 0.3 && lag > least_lag && lag < 1.5 && steady.cost - found.cost > least_evidence)) return {};
  return {lag * std::exp(after_s / time_s), time_s};
}
ROSIN_INSTANTIATE(rod_approach find_rod_approach(std::span<const double>, double, double, double, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
