// tier: hosted
// SPDX-License-Identifier: MIT
//
// AC-coupled sensors lose the constant part of the force. A law of friction that is fitted to the slips has that constant as one
// more parameter of each stroke: with friction f + level = N mu(x), what is recorded has to meet the law at the stroke's normal
// force.
//
// What can be known of it so depends on the law. A curve of the slip speed, mu(|v_r|), fits with any number added to mu: the
// levels of the strokes follow against each other, and the one number they share comes from where the friction of rosin is known
// to lie (loop's middle at 0.65 +- 0.15 of the normal force; reconstruct/dc_level.hpp). Heat is made by the force itself, |f
// v_r|, and so the thermal law knows where zero is: too low a level heats too little where much is asked. There the number is
// fitted along with the contact's layer and area (contact_heat.hpp), and the usual range is no more than a prior.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/friction_laws.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// To be added to the force of one stroke.
struct lost_level {
  double level_N = 0, sd_N = 0;
};

struct lost_levels {
  contact_law law = contact_law::velocity_curve;  ///< that gave them
  std::vector<lost_level> takes{};                ///< in the order of the strokes
  double common_sd = 0;                           ///< of what all share, as a coefficient of friction
  double gain = 0;                                ///< of the thermal law over the curve, nats
  double left = 0;                                ///< by the thermal law, as a coefficient of friction
};

namespace detail {

/// Friction of rosin at the middle of its loop, and how sure that is.
inline constexpr double usual_middle = 0.65, usual_doubt = 0.15;

/// The strokes with levels added, and what laws leave of them: each stroke but the first may still be off by a constant.
class level_search {
public:
  template <class = void>
  explicit level_search(std::vector<slip_record> records)
      : records_{std::move(records)}, sign_(records_.size()), shift_(records_.size(), 0.0) {
    for (std::size_t t = 0; t < records_.size(); ++t) {
      const auto& s = records_[t].slips;
      sign_[t] = s.friction.size() > 0 && s.friction[0] * records_[t].force_N[s.sample[0]] < 0 ? -1.0 : 1.0;
      add(t, usual_middle - middle(t));
    }
  }

  /// Adds to the friction coefficient of a stroke.
  template <class = void>
  void add(std::size_t t, double mu) {
    auto& r = records_[t];
    for (double& f : r.force_N) f += sign_[t] * mu * r.normal_N;
    r.slips.friction.array() += mu;
    shift_[t] += mu;
  }
  template <class = void>
  void add_to_all(double mu) {
    for (std::size_t t = 0; t < records_.size(); ++t) add(t, mu);
  }

  /// The strokes' loops, on the average, where they usually are.
  template <class = void>
  void centre() {
    double sum = 0;
    for (std::size_t t = 0; t < records_.size(); ++t) sum += middle(t);
    add_to_all(usual_middle - sum / static_cast<double>(records_.size()));
  }

  template <class Real = double>
  [[nodiscard]] stick_design curve() const {
    std::vector<Eigen::VectorX<Real>> x;
    for (const auto& r : records_) x.push_back(r.slips.speed_m_s);
    return with_levels(law_design(records_, x, stride()));
  }
  template <class = void>
  [[nodiscard]] stick_design heated(const contact_heat_parameters<double>& heat) const {
    return with_levels(memory_design(
        records_, [&](std::size_t t) { return heat_along(records_[t], heat); }, stride()));
  }
  /// Sets the strokes against the first as a fit finds them.
  template <class = void>
  void settle(const design_fit& fit) {
    for (std::size_t t = 1; t < records_.size(); ++t) add(t, -fit.solution.own[t][0]);
  }
  [[nodiscard]] const std::vector<slip_record>& records() const noexcept { return records_; }
  [[nodiscard]] lost_level of(std::size_t t, double sd) const {
    return {sign_[t] * shift_[t] * records_[t].normal_N, sd * records_[t].normal_N};
  }

private:
  /// Of the whole slips, from the first sample to the last: that is where the usual range holds.
  [[nodiscard]] double middle(std::size_t t) const {
    const auto& r = records_[t];
    std::vector<double> mu;
    for (const auto& slip : r.phases.slips)
      for (std::size_t i = slip.begin; i < slip.end; ++i) mu.push_back(sign_[t] * r.force_N[i] / r.normal_N);
    std::sort(mu.begin(), mu.end());
    const auto at = [&](double q) { return mu[static_cast<std::size_t>(q * static_cast<double>(mu.size() - 1))]; };
    return (at(0.02) + at(0.98)) / 2;
  }
  [[nodiscard]] std::size_t stride() const {
    std::size_t samples = 0;
    for (const auto& r : records_) samples += r.slips.sample.size();
    return std::max<std::size_t>(2, samples / 3000);
  }
  template <class = void>
  [[nodiscard]] static stick_design with_levels(stick_design d) {
    free_levels(d);
    return d;
  }

  std::vector<slip_record> records_;
  std::vector<double> sign_, shift_;
};

/// ln layer, ln area, and what is added to all; minus the log-likelihood with the usual ranges as priors (a layer of 2 um within
/// a factor of 4.5, an area of 1e-7 m2 a newton within a factor of 2.7).
struct heat_objective {
  level_search search;
  double independent = 1, floor = 0.003;
  double usual = 0;  ///< what would have to be added to lie in the middle of the usual range

  template <class = void>
  [[nodiscard]] double operator()(const Eigen::Vector3d& at) const {
    if (!(std::abs(at[0] - std::log(2e-6)) < 4 && std::abs(at[1] - std::log(1e-7)) < 3 &&
          std::abs(at[2] - usual) < 4 * usual_doubt))
      return 1e300;
    level_search moved = search;
    moved.add_to_all(at[2]);
    const double left = quick_residual(moved.heated({.layer_m = std::exp(at[0]), .area_per_newton_m2 = std::exp(at[1])}), floor);
    const double guess = std::pow((at[0] - std::log(2e-6)) / 1.5, 2) + std::pow(at[1] - std::log(1e-7), 2);
    return independent * std::log(left) + 0.5 * std::pow((at[2] - usual) / usual_doubt, 2) + 0.5 * guess;
  }
};

/// Pattern search, the steps halved as soon as none helps.
template <class = void>
[[nodiscard]] Eigen::Vector3d descend(const heat_objective& objective, Eigen::Vector3d at, Eigen::Vector3d step, int halvings) {
  double best = objective(at);
  for (int left = halvings; left > 0;) {
    const Eigen::Vector3d from = at;
    for (Eigen::Index k = 0; k < 3; ++k)
      for (const double way : {1.0, -1.0}) {
        Eigen::Vector3d next = at;
        next[k] += way * step[k];
        const double value = objective(next);
        if (value < best) {
          best = value, at = next;
          break;
        }
      }
    const Eigen::Vector3d along = at - from;
    if (along.isZero()) step /= 2, --left;
    else if (const double value = objective(at + along); value < best) best = value, at += along;
  }
  return at;
}
ROSIN_INSTANTIATE(Eigen::Vector3d descend(const heat_objective&, Eigen::Vector3d, Eigen::Vector3d, int))

/// Coarsely over all three, the two best of them a little on their way: there is more than one valley.
template <class = void>
[[nodiscard]] Eigen::Vector3d best_start(const heat_objective& objective) {
  std::vector<std::pair<double, Eigen::Vector3d>> tried;
  for (const double layer : {6e-7, 4e-6})
    for (const double area : {0.6e-7, 1.4e-7})
      for (const double mu : {-0.2, -0.05, 0.1}) {
        const Eigen::Vector3d at(std::log(layer), std::log(area), objective.usual + mu);
        tried.emplace_back(objective(at), at);
      }
  std::sort(tried.begin(), tried.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const Eigen::Vector3d step(0.4, 0.2, 0.04), a = descend(objective, tried[0].second, step, 2),
                                              b = descend(objective, tried[1].second, step, 2);
  return objective(a) < objective(b) ? a : b;
}

/// From the inverse of the second derivatives, never more than the prior's width.
template <class = void>
[[nodiscard]] double sd_of_common(const heat_objective& objective, const Eigen::Vector3d& at) {
  const Eigen::Vector3d step(0.25, 0.1, 0.04);
  const double here = objective(at);
  Eigen::Matrix3d h;
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const Eigen::Vector3d a = step[i] * Eigen::Vector3d::Unit(i), b = step[j] * Eigen::Vector3d::Unit(j);
      const double second =
          i == j ? objective(at + a) + objective(at - a) - 2 * here
                 : (objective(at + a + b) - objective(at + a - b) - objective(at - a + b) + objective(at - a - b)) / 4;
      h(i, j) = h(j, i) = second / (step[i] * step[j]);
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(h);
  if (solver.info() != Eigen::Success) return usual_doubt;
  const Eigen::Vector3d curvature = solver.eigenvalues().cwiseMax(1e-3 * solver.eigenvalues()[2]),
                        across = solver.eigenvectors().row(2);
  return std::min(usual_doubt, std::sqrt(across.cwiseAbs2().dot(curvature.cwiseInverse())));
}

}  // namespace detail

/// Levels of strokes whose mean force is unknown. Precondition: each has 100 slip samples and a normal force. `law_error`: by how
/// much the level of a thermal law is off, as a coefficient of friction, where it leaves no more than `floor`. A thermal law that
/// leaves much more is not that of the contact to the point, and what it says of zero is worse than the usual range: then that is
/// used. One stroke alone bends layer and area to what it needs: 19 strokes of 8 random rigs were off by -0.08 on the average,
/// 0.09 rms. Its error is taken as 2.5 times as large.
template <class = void>
[[nodiscard]] lost_levels find_lost_levels(const std::vector<slip_record>& records, double floor = 0.003,
                                           double law_error = 0.04) {
  detail::level_search search(records);
  for (int pass = 0; pass < 2; ++pass) search.settle(fit_design(search.curve(), floor));
  search.centre();
  lost_levels out;
  const auto curve = fit_design(search.curve(), floor);
  out.common_sd = detail::usual_doubt;
  detail::heat_objective objective{search, curve.solution.effective, floor, 0};
  if (curve.solution.scale > 2 * floor) {
    Eigen::Vector3d at = detail::best_start(objective);
    for (int round = 0; round < 2; ++round) {
      at = detail::descend(objective, at, round == 0 ? Eigen::Vector3d(0.2, 0.1, 0.02) : Eigen::Vector3d(0.1, 0.1, 0.02), 4);
      objective.search.add_to_all(at[2]);
      objective.usual -= at[2], at[2] = 0;
      objective.search.settle(
          fit_design(objective.search.heated({.layer_m = std::exp(at[0]), .area_per_newton_m2 = std::exp(at[1])}), floor));
    }
    const auto fit =
        fit_design(objective.search.heated({.layer_m = std::exp(at[0]), .area_per_newton_m2 = std::exp(at[1])}), floor);
    out.gain = objective.independent * std::log(curve.solution.scale / fit.solution.scale);
    out.left = fit.solution.scale;
    const double alone = records.size() > 1 ? 1 : 2.5;
    const double sd = std::hypot(detail::sd_of_common(objective, at), alone * law_error * out.left / floor);
    if (out.gain > 30 && out.left < 1.4 * floor && sd < detail::usual_doubt) {
      out.law = contact_law::thermal;
      out.common_sd = sd;
      search = objective.search;
    }
  }
  for (std::size_t t = 0; t < records.size(); ++t) out.takes.push_back(search.of(t, out.common_sd));
  return out;
}
ROSIN_INSTANTIATE(lost_levels find_lost_levels(const std::vector<slip_record>&, double, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
