// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a stroke shows of the law of friction while it slips: force against slip speed, or against what the law remembers.
// A law predicts f = N mu(x) from one number x at each instant: the slip speed (velocity curve), or the temperature that the
// slips so far have left (thermal law). Whatever mu is, it is smooth; so both are fitted with the same number of smooth
// functions of x, and what is left over says which x the force follows. Nothing runs freely: the law is driven by the
// reconstructed motion, which it cannot leave.
//
// Force and motion are limited to the same band, the law is not: f = N mu(x) is exact for slow changes only. Samples within a
// kernel's reach of sticking are of use to robust estimates alone.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/friction/contact_heat.hpp>
#include <rosin/friction/slip_phases.hpp>

#include <Eigen/Dense>

#include <array>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Slips of one take: rows in time's order.
struct slip_samples {
  std::vector<std::size_t> sample;  ///< index into the arrays that they were taken from
  Eigen::VectorXd speed_m_s;        ///< |v_r|
  Eigen::VectorXd friction;         ///< force against the slip / normal force
};

/// Samples `margin` inside the slips. The arrays (force, surface less rod) have one length.
template <class = void>
[[nodiscard]] slip_samples slips_of(std::span<const double> force_N, std::span<const double> relative_m_s,
                                    const contact_phases& phases, double rod_speed_m_s, double normal_N, std::size_t begin,
                                    std::size_t margin) {
  slip_samples out;
  const double way = rod_speed_m_s < 0 ? -1.0 : 1.0;
  const auto inside = interior(phases.slips, relative_m_s.size(), margin);
  for (std::size_t i = begin; i < relative_m_s.size(); ++i)
    if (inside[i] && way * (relative_m_s[i] - phases.level_m_s) < 0) out.sample.push_back(i);
  const auto n = static_cast<Eigen::Index>(out.sample.size());
  out.speed_m_s.resize(n);
  out.friction.resize(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t i = out.sample[static_cast<std::size_t>(k)];
    out.speed_m_s[k] = std::abs(relative_m_s[i] - phases.level_m_s);
    out.friction[k] = way * force_N[i] / normal_N;
  }
  return out;
}
ROSIN_INSTANTIATE(slip_samples slips_of(std::span<const double>, std::span<const double>, const contact_phases&, double, double,
                                        std::size_t, std::size_t))

/// Samples that stand in for what happened before the first slip that is known: as many as lie before it, from there on. A
/// contact that was taken to be cold there would need several periods to be as warm as it is.
[[nodiscard]] inline std::pair<std::size_t, std::size_t> before_the_slips(const contact_phases& phases, std::size_t samples) {
  const std::size_t first = phases.slips.empty() ? 0 : phases.slips.front().begin;
  return {first, std::min(samples, 2 * first)};
}

/// Temperature of the contact at every sample (above its surroundings), heated by the reconstructed force along the reconstructed
/// slips. `load`: normal force over `normal_N` at every sample; empty: it is steady.
[[nodiscard]] inline std::vector<double> temperature_along(std::span<const double> force_N, std::span<const double> relative_m_s,
                                                           const contact_phases& phases, double normal_N, double rate_Hz,
                                                           const contact_heat_parameters<double>& heat,
                                                           std::span<const double> load = {}) {
  std::vector<double> rise(relative_m_s.size(), 0.0);
  const auto slipping = interior(phases.slips, relative_m_s.size(), 0);
  contact_heat<double> contact(heat);
  const auto step = [&](std::size_t i) {
    const double slip = slipping[i] ? std::abs(relative_m_s[i] - phases.level_m_s) : 0.0;
    return contact(slip * std::abs(force_N[i]), slip, load.empty() ? normal_N : load[i] * normal_N, 1 / rate_Hz);
  };
  const auto [first, last] = before_the_slips(phases, rise.size());
  for (std::size_t i = first; i < last; ++i) step(i);
  for (std::size_t i = first; i < rise.size(); ++i) rise[i] = step(i);
  return rise;
}

/// Cubic B-splines: smooth functions of x that add up to 1, closer together where there are more samples.
class smooth_functions {
public:
  static constexpr int order = 4;

  /// Knots half-way between even steps and quantiles of x. Precondition: x is not empty. `functions` >= 4.
  explicit smooth_functions(std::vector<double> x, int functions = 11) : functions_{functions} {
    const auto [least_x, most_x] = std::minmax_element(x.begin(), x.end());
    const double low = *least_x, high = *most_x;
    const int inner = functions - order + 1;
    for (int k = 0; k < order - 1; ++k) knots_.push_back(low);
    auto from = x.begin();  // what lies before it is no larger than what follows
    for (int k = 0; k <= inner; ++k) {
      const double share = static_cast<double>(k) / inner;
      const auto quantile = x.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(x.size() - 1) * share);
      std::nth_element(from, quantile, x.end());
      from = quantile;
      knots_.push_back((low + share * (high - low) + *quantile) / 2);
    }
    for (int k = 0; k < order - 1; ++k) knots_.push_back(high);
    const double least = std::max(1e-12, (high - low) * 1e-3);
    for (std::size_t k = order; k + order <= knots_.size(); ++k) knots_[k] = std::max(knots_[k], knots_[k - 1] + least);
    for (std::size_t k = knots_.size() - order + 1; k < knots_.size(); ++k) knots_[k] = knots_[knots_.size() - order];
  }

  /// One row for each x; what lies outside the knots is taken at their ends.
  template <class Real = double>
  [[nodiscard]] Eigen::MatrixXd operator()(const Eigen::VectorXd& x) const {
    Eigen::MatrixX<Real> out = Eigen::MatrixX<Real>::Zero(x.size(), functions_);
    for (Eigen::Index i = 0; i < x.size(); ++i) fill(x[i], [&](int k, double value) { out(i, k) = value; });
    return out;
  }

private:
  template <class Put>
  void fill(double x, const Put& put) const {
    const auto first = knots_.begin() + order - 1, last = knots_.end() - order;
    x = std::clamp(x, *first, *last);
    const auto above = std::upper_bound(first + 1, last, x);
    const auto at = static_cast<std::size_t>(above - knots_.begin()) - 1;  // knots_[at] <= x
    std::array<double, order> n{1};
    for (std::size_t d = 1; d < order; ++d) {  // Cox and de Boor
      double carry = 0;
      for (std::size_t r = 0; r < d; ++r) {
        const double right = knots_[at + r + 1] - x, left = x - knots_[at + 1 + r - d], share = n[r] / (right + left);
        n[r] = carry + right * share;
        carry = left * share;
      }
      n[d] = carry;
    }
    for (std::size_t r = 0; r < order; ++r) put(static_cast<int>(at - order + 1 + r), n[r]);
  }

  int functions_;
  std::vector<double> knots_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
