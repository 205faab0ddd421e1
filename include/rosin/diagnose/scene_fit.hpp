// tier: hosted
// SPDX-License-Identifier: MIT
//
// Plucks fitted with effects of the catalogue, all parameters free together: the pitch is followed from the first periods to the
// whole record, as in pluck_fit.hpp, so that a strong effect does not lock the fit onto a wrong period.
//
#pragma once

#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_score.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct scene_fit {
  std::vector<pluck_effect> effects;
  Eigen::VectorXd value, sd;
  Eigen::MatrixXd covariance;
  std::vector<double> score_sd;  ///< of parameters found by score steps
  assessment quality;
  double horizon_periods = 0;  ///< how much of the decay was used
  double losses_price = 0;     ///< of modes with losses of their own (own_losses.hpp), part of -2 ln(evidence)
  int iterations = 0;
  bool converged = false;

  /// Index of an effect's first parameter; its physical values.
  [[nodiscard]] Eigen::Index first_of(std::size_t which) const {
    Eigen::Index at = value.size();
    for (std::size_t i = which; i < effects.size(); ++i) at -= static_cast<Eigen::Index>(effects[i].parameters.size());
    return at;
  }
  [[nodiscard]] std::vector<double> values_of(std::size_t which) const {
    std::vector<double> out;
    Eigen::Index at = first_of(which);
    for (const effect_parameter& p : effects[which].parameters) out.push_back(to_physical(p, value[at++]));
    return out;
  }
  [[nodiscard]] bool is_ordinary(std::size_t which) const {
    return effects[which].is_ordinary && effects[which].is_ordinary(values_of(which));
  }
  /// Holds for the first periods only, though none of its effects is so limited: what comes later is a mismatch.
  [[nodiscard]] bool falls_short() const {
    return horizon_periods < 1e8 &&
           std::none_of(effects.begin(), effects.end(), [](const pluck_effect& e) { return e.horizon_periods < 1e8; });
  }
};

/// How much of the recordings one descent looks at.
struct fit_stage {
  int partials = 1000;
  double periods = 1e9;
  bool filtered = true;  ///< all partials inside the band; else only so many, and the rest is taken for noise
  freedom free = freedom::no_corrections;
};

/// What all fits of one rig have in common.
struct scene_data {
  std::vector<pluck_take> takes;
  pluck_guess guess;
  pluck_options options;
  pluck_layout layout;
  band_kernels kernels{};
  double most_periods = 1e9;  ///< of each recording that any fit looks at
  double least_temper = 1;    ///< power of the noise at the first partials over white noise: evidence weighs that much less

  /// The same of a fit with these effects, whose own models may hold for less.
  [[nodiscard]] double most_periods_with(const std::vector<pluck_effect>& effects) const {
    double most = most_periods;
    for (const pluck_effect& e : effects) most = std::min(most, e.horizon_periods);
    return most;
  }

  /// What is free in a fit that a fit with everything free is compared with: ends were moved along with an effect that is then
  /// taken out.
  [[nodiscard]] freedom compared() const { return layout.has_ends() ? freedom::all : freedom::no_corrections; }

  /// The recordings without what effects that are not linear have put in.
  template <class = void>
  [[nodiscard]] std::vector<pluck_take> undone(const std::vector<pluck_effect>& effects, const Eigen::VectorXd& value) const {
    std::vector<pluck_take> out = takes;
    Eigen::Index at = layout.size();
    for (const pluck_effect& e : effects) {
      if (e.undo && value[at] != 0)
        e.undo(out, scene_plucks(layout, guess.ac_coupled_Hz, effects).scene(value, 0), layout, value, value[at]);
      at += static_cast<Eigen::Index>(e.parameters.size());
    }
    return out;
  }
  template <class = void>
  [[nodiscard]] line_problem<scene_plucks> problem(const std::vector<pluck_effect>& effects, const Eigen::VectorXd& value,
                                                   const fit_stage& stage, std::array<double, 2> noise) const {
    return {undone(effects, value),
            scene_plucks(layout, guess.ac_coupled_Hz, effects, stage.free),
            options,
            guess,
            value,
            stage.partials,
            stage.periods,
            stage.filtered,
            noise,
            kernels};
  }
};

/// What a fit makes of string, ends, wire and sensors, as the first take shows them.
template <class = void>
[[nodiscard]] pluck_scene scene_of(const scene_data& data, const scene_fit& fit) {
  return scene_plucks(data.layout, data.guess.ac_coupled_Hz, fit.effects).scene(fit.value, 0);
}

namespace detail {

/// The residual of a fit in the ringing part of a take.
template <class Real = double>
std::array<Eigen::VectorXd, 2> residual_of(const line_problem<scene_plucks>& p, const Eigen::VectorXd& v, std::size_t take) {
  const auto& s = p.part(take, 1);
  const std::vector<damped_line> lines = p.lines(v, take, 1);
  const Eigen::MatrixX<Real> model = line_runner(lines, 1 / p.rate_Hz(take)).sum(lines, s.count());
  return {s.data[0] - model.col(0), s.data[1] - model.col(1)};
}
ROSIN_INSTANTIATE(std::array<Eigen::VectorXd, 2> residual_of(const line_problem<scene_plucks>&, const Eigen::VectorXd&,
                                                             std::size_t))

/// One score step for every effect that shows in the recordings alone; returns the largest step in standard deviations.
template <class Real = double>
double score_steps(const scene_data& data, scene_fit& fit, const fit_stage& stage, std::array<double, 2> noise) {
  double largest = 0;
  Eigen::Index at = data.layout.size();
  for (const pluck_effect& e : fit.effects) {
    if (e.parameters[0].by_score) {
      const line_problem<scene_plucks> here = data.problem(fit.effects, fit.value, stage, noise);
      Eigen::VectorX<Real> moved = fit.value;
      const double h = e.parameters[0].step;
      moved[at] += h;
      const line_problem<scene_plucks> there = data.problem(fit.effects, moved, stage, noise);
      std::vector<std::array<Eigen::VectorX<Real>, 2>> columns(here.takes());
      for (std::size_t t = 0; t < here.takes(); ++t) {
        columns[t] = residual_of(here, fit.value, t);
        const auto changed = residual_of(there, moved, t);
        for (std::size_t c = 0; c < 2; ++c) columns[t][c] = (columns[t][c] - changed[c]) / h;
      }
      const auto found = pluck_score(here, fit.value).of_columns(columns);
      fit.value[at] = std::clamp(fit.value[at] + found.mix, e.parameters[0].low, e.parameters[0].high);
      fit.score_sd.push_back(found.sd);
      largest = std::max(largest, found.sd > 0 ? std::abs(found.mix) / found.sd : 0.0);
    }
    at += static_cast<Eigen::Index>(e.parameters.size());
  }
  return largest;
}

/// Whether modes have losses of their own, and a fit moves them.
template <class = void>
[[nodiscard]] bool is_free_own_loss(const line_problem<scene_plucks>& problem) {
  return problem.model().own_losses() > 0 && problem.model().is_free(problem.model().first_of_own());
}

/// Quality and covariance of a fit that has settled.
template <class Real = double>
void conclude(scene_fit& fit, const scene_data& data, const line_problem<scene_plucks>& problem) {
  fit.quality = problem.assess(fit.value);
  fit.losses_price = is_free_own_loss(problem) ? scatter_of(problem, fit.value).price : 0.0;
  const pluck_equations end = problem.linearise(fit.value);
  const Eigen::MatrixX<Real> inverse = invert_free(problem.model(), end.hessian);
  fit.covariance = inverse * (end.prior + fit.quality.inflation() * problem.scatter(fit.value)) * inverse;
  Eigen::Index at = data.layout.size();
  std::size_t i = 0;
  for (const pluck_effect& e : fit.effects) {
    if (e.parameters[0].by_score && i < fit.score_sd.size())
      fit.covariance(at, at) = fit.quality.inflation() * std::pow(fit.score_sd[i++], 2);
    at += static_cast<Eigen::Index>(e.parameters.size());
  }
  fit.sd = fit.covariance.diagonal().cwiseMax(0).cwiseSqrt();
}

}  // namespace detail

/// `value`: starting values of all parameters (scene_plucks); the noise weighs the channels. Assessed after the last stage.
template <class = void>
[[nodiscard]] scene_fit fit_scene(const scene_data& data, const std::vector<pluck_effect>& effects, const Eigen::VectorXd& value,
                                  std::vector<fit_stage> stages, std::array<double, 2> noise) {
  scene_fit fit{effects, value, {}, {}, {}, {}, 0, 0, 0, false};
  bool again = false;  // what is taken out of the recordings depends on the fit
  for (const pluck_effect& e : effects) again = again || e.undo;
  for (fit_stage& s : stages) s.periods = std::min(s.periods, data.most_periods_with(effects));
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const bool last = i + 1 == stages.size();
    for (int round = 0; round < (again ? (last ? 8 : 2) : 1); ++round) {
      const line_problem<scene_plucks> problem = data.problem(effects, fit.value, stages[i], noise);
      const int before = fit.iterations;
      const auto settle = [&](Eigen::VectorXd& at) {
        fit.converged = detail::descend(problem, problem.model(), value, at, last ? 25 : 10, last ? 1e-2 : 1.0, fit.iterations);
      };
      if (last && stages[i].periods > 1e8 && detail::is_free_own_loss(problem))
        detail::settle_scatter(problem, fit.value, settle, 2);
      else settle(fit.value);
      fit.score_sd.clear();
      if (again && detail::score_steps(data, fit, stages[i], noise) < 0.05 && fit.iterations <= before + 2) break;
    }
    fit.horizon_periods = stages[i].periods;
  }
  if (!stages.empty()) detail::conclude(fit, data, data.problem(effects, fit.value, stages.back(), noise));
  return fit;
}
ROSIN_INSTANTIATE(scene_fit fit_scene(const scene_data&, const std::vector<pluck_effect>&, const Eigen::VectorXd&,
                                      std::vector<fit_stage>, std::array<double, 2>))

namespace detail {

/// A fit that leaves more than noise with a loss of its own for each mode, where that accounts for most of it; else as it is.
template <class Real = double>
[[nodiscard]] scene_fit or_with_own_losses(const scene_data& data, scene_fit fit, std::array<double, 2> noise) {
  const pluck_layout& layout = data.layout;
  if (fit.quality.inflation() == 1 || fit.horizon_periods < 1e8 || layout.own_losses() == 0 || layout.has_own_losses(fit.value))
    return fit;
  Eigen::VectorX<Real> value = fit.value;
  value[layout.loss_scatter()] = usual_loss_scatter;
  scene_fit other = fit_scene(data, fit.effects, value, {{1000, fit.horizon_periods, true, freedom::all}}, noise);
  const bool less = other.quality.inflation() - 1 < (fit.quality.inflation() - 1) / 2;
  const std::span own(other.value.data() + layout.first_of_own(), static_cast<std::size_t>(layout.own_losses()));
  return less && scatters_from_mode_to_mode(own) ? std::move(other) : std::move(fit);
}
ROSIN_INSTANTIATE(scene_fit or_with_own_losses(const scene_data&, scene_fit, std::array<double, 2>))

}  // namespace detail

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
