// tier: hosted
// SPDX-License-Identifier: MIT
//
// Calibration from plucks made by a breaking wire: pitch, position, stiffness and loss of the string, instant and strength of
// each release, and the gains of both channels, from one pluck or several together, by maximum likelihood.
//
//     recording = gain * (pluck model) + offset + white noise, inside a band
//
// Levenberg-Marquardt on the closed form of pluck_model.hpp. The pitch is known to a per cent at first and to a part in 1e8 in
// the end, so the fit starts with the first partials of the first periods and takes in more as it grows sure (stages()).
// Gains and strengths only enter as products; nominal values with their tolerances decide between them (priors), and
// what that leaves open is one common scale, reported apart.
//
// How much the loss disperses (loss_law) is a matter of convention where modes are damped one by one, and of physics in a string. It
// is sought where the model leaves more than noise, and kept where it accounts for most of that.
//
#pragma once

#include <rosin/calibrate/loss_scatter.hpp>
#include <rosin/core/instantiate.hpp>

#include <Eigen/Dense>

#include <string>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What a fit of plucks found. Order of parameters and covariance: pluck_layout.
struct pluck_fit_result {
  pluck_layout layout;
  Eigen::VectorXd value, sd;
  Eigen::MatrixXd covariance;
  std::array<double, 2> noise_N{};        ///< white noise per channel, rms over the whole band to half the sampling rate
  double misfit = 1;                      ///< power at the partials against what noise explains; 1: the model is complete
  bool more_than_noise = false;           ///< the misfit is no chance
  std::vector<double> residual_ratio;     ///< per take: rms(recorded - model) / rms(recorded), inside the band
  std::vector<std::string> unidentified;  ///< parameters that these plucks cannot tell
  band limits{0, 0};
  double horizon_periods = 0;  ///< how much of the decay was used; all of it where the model holds
  int iterations = 0;
  bool converged = false;
  double loss_scatter = 0;         ///< of ln 1/Q of the modes about the law; 0: none was needed
  std::vector<double> own_losses;  ///< of each mode, ln of 1/Q over what the law says

  template <class = void>
  [[nodiscard]] ringing_string string() const {
    return layout.string(value);
  }
  template <class = void>
  [[nodiscard]] rosin::own_losses own() const {
    return {string(), Eigen::VectorXd::Map(own_losses.data(), static_cast<Eigen::Index>(own_losses.size()))};
  }
};

namespace detail {

struct stage {
  int partials;
  double periods;
};

/// From the first partials and periods on; what follows takes in all partials of the band.
inline constexpr std::array<stage, 4> approach{{{4, 5}, {6, 12}, {12, 30}, {24, 80}}};
/// The whole record; less of it where the model does not hold for so long.
inline constexpr std::array<double, 3> horizon_periods{1e9, 30, 8};

/// Plucks as a fit may take them: not far from where it began.
template <class Problem, class Layout>
struct pluck_descent {
  const Problem& problem;
  const Layout& layout;
  const Eigen::VectorXd& start;

  [[nodiscard]] pluck_equations linearise(const Eigen::VectorXd& value) const { return problem.linearise(value); }
  [[nodiscard]] bool plausible(const Eigen::VectorXd& value) const {
    return layout.plausible(value, start, problem.limits().stop_Hz);
  }
};

/// One descent at fixed weights. Returns whether it settled.
template <class Problem, class Layout>
bool descend(const Problem& problem, const Layout& layout, const Eigen::VectorXd& start, Eigen::VectorXd& value, int most,
             double enough, int& iterations) {
  auto found = levenberg_marquardt(
      pluck_descent<Problem, Layout>{problem, layout, start}, value,
      {.first = 1e-6, .more = 30, .restart = 1e-6, .iterations = most, .enough = enough, .enough_relative = 0});
  value = std::move(found.at), iterations += found.iterations;
  return found.converged();
}

/// Names of the parameters that the data leave open: those in the directions in which the scaled Hessian vanishes.
template <class Real = double>
std::vector<std::string> unidentified(const Eigen::MatrixXd& data_hessian, const pluck_layout& layout) {
  const Eigen::VectorX<Real> diagonal = data_hessian.diagonal();
  const Eigen::VectorX<Real> scale = diagonal.cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixX<Real>> modes(scale.asDiagonal() * data_hessian * scale.asDiagonal());
  std::vector<std::string> names;
  for (Eigen::Index p = 0; p < diagonal.size(); ++p) {
    if (!layout.is_free(p) || layout.is_scale(p)) continue;  // one common scale is always left to the nominal values
    double open = diagonal[p] > 0 ? 0 : 1;
    for (Eigen::Index m = 0; m < modes.eigenvalues().size(); ++m)
      if (modes.eigenvalues()[m] < 1e-9) open = std::max(open, std::abs(modes.eigenvectors()(p, m)));
    if (open > 0.1) names.push_back(layout.name(p));
  }
  return names;
}

template <class Assessed>
double worst(const Assessed& result) {
  return *std::max_element(result.residual_ratio.begin(), result.residual_ratio.end());
}

/// The last descents, over all partials, with the weights that the residual itself shows; then covariance and verdict.
template <class Real = double>
void finish(const std::vector<pluck_take>& takes, const pluck_guess& guess, const pluck_options& options,
            const Eigen::VectorXd& begin, double periods, pluck_fit_result& result) {
  std::array<double, 2> noise{1e-2, 1e-2};
  for (const double within : {400.0, 1e9})  // the second descent starts sure of the pitch
    if (periods > 400 || within > 400) {
      const pluck_problem problem(takes, {result.layout, guess.ac_coupled_Hz}, options, guess, result.value,
                                  options.most_partials, std::min(periods, within), true, noise);
      result.converged = descend(problem, result.layout, begin, result.value, 25, 1e-2, result.iterations);
    }
  pluck_problem problem(takes, {result.layout, guess.ac_coupled_Hz}, options, guess, result.value, options.most_partials, periods,
                        true, noise);
  for (int pass = 0; pass < 2; ++pass) {
    noise = problem.assess(result.value).noise;
    problem.set_noise(noise);
    result.converged = descend(problem, result.layout, begin, result.value, 25, 1e-3, result.iterations);
  }
  const assessment found = problem.assess(result.value);
  result.noise_N = found.noise;
  result.misfit = found.misfit, result.more_than_noise = found.inflation() != 1;
  result.residual_ratio = found.residual_ratio;
  const pluck_equations end = problem.linearise(result.value);
  const Eigen::MatrixX<Real> inverse = invert_free(result.layout, end.hessian);
  result.covariance = inverse * (end.prior + found.inflation() * problem.scatter(result.value)) * inverse;
  result.sd = result.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  result.unidentified = unidentified(end.hessian - end.prior, result.layout);
}
ROSIN_INSTANTIATE(void finish(const std::vector<pluck_take>&, const pluck_guess&, const pluck_options&, const Eigen::VectorXd&,
                              double, pluck_fit_result&))

/// All stages from a starting point on.
template <class Real = double>
void approach_and_finish(const std::vector<pluck_take>& takes, const pluck_guess& guess, const pluck_options& options,
                         pluck_fit_result& result) {
  const Eigen::VectorX<Real> begin = result.value;
  for (const stage& s : approach) {
    const pluck_problem problem(takes, {result.layout, guess.ac_coupled_Hz}, options, guess, result.value, s.partials, s.periods,
                                false, {1e-2, 1e-2});
    descend(problem, result.layout, begin, result.value, 12, 1e-2, result.iterations);
  }
  const Eigen::VectorX<Real> near = result.value;
  for (const double periods : horizon_periods) {
    result.value = near;
    finish(takes, guess, options, begin, periods, result);
    result.horizon_periods = periods;
    if (worst(result) < 0.1) break;
  }
}

/// Whether dispersion that was found may be loss that is causal, and not something else that disperses, or what was known before.
inline bool is_causal(double causality, double sd, double most_sd = 0.1) {
  return sd < most_sd && causality > 0.2 && causality < 1.5;
}

/// Whether freeing the dispersion of the loss could leave so little: what a few steps from a fit that follows the whole record do.
template <class Real = double>
bool may_be_causal(const std::vector<pluck_take>& takes, const pluck_guess& guess, const pluck_options& freed,
                   const pluck_fit_result& result) {
  if (result.horizon_periods < horizon_periods.front()) return true;
  const pluck_layout layout(takes, freed);
  Eigen::VectorX<Real> value = result.value;
  pluck_problem problem(takes, {layout, guess.ac_coupled_Hz}, freed, guess, value, freed.most_partials, result.horizon_periods,
                        true, result.noise_N);
  int iterations = 0;
  descend(problem, layout, result.value, value, 6, 1.0, iterations);
  const assessment seen = problem.assess(value);
  return seen.misfit - 1 < (result.misfit - 1) / 2 || worst(seen) < worst(result) / 2;
}

/// The same fit with loss that may disperse, where that follows more of the record, or as much and leaves a third of the excess at
/// the partials or of the signal.
template <class = void>
void try_causality(const std::vector<pluck_take>& takes, const pluck_guess& guess, pluck_options options,
                   const Eigen::VectorXd& begin, pluck_fit_result& result) {
  if (options.causality || !result.more_than_noise) return;
  options.causality = true;
  if (!may_be_causal(takes, guess, options, result)) return;
  pluck_fit_result other;
  other.layout = pluck_layout(takes, options), other.limits = result.limits, other.value = begin;
  approach_and_finish(takes, guess, options, other);
  const bool less = other.misfit - 1 < (result.misfit - 1) / 3 || worst(other) < worst(result) / 3;
  const bool fits = other.horizon_periods > result.horizon_periods || (other.horizon_periods == result.horizon_periods && less);
  if (fits && is_causal(other.value[pluck_layout::causality], other.sd[pluck_layout::causality])) result = std::move(other);
}

/// Two layouts of the same takes, one of which has losses of the modes' own: where the other's parameters stand in it.
[[nodiscard]] inline std::vector<Eigen::Index> besides_own_losses(const pluck_layout& layout) {
  std::vector<Eigen::Index> out;
  for (Eigen::Index p = 0; p < layout.size(); ++p)
    if (p < layout.loss_scatter() || p >= layout.first_of_ends()) out.push_back(p);
  return out;
}

/// The same fit with a loss of its own for each mode; in the result these are set apart.
template <class Real = double>
[[nodiscard]] pluck_fit_result with_own_losses(const std::vector<pluck_take>& takes, const pluck_guess& guess,
                                               pluck_options options, const pluck_fit_result& from) {
  pluck_fit_result out = from;
  options.causality = from.layout.is_free(pluck_layout::causality);
  options.own_losses = modes_heard(from.string(), from.limits, options.most_partials);
  const pluck_layout layout(takes, options);
  const std::vector<Eigen::Index> rest = besides_own_losses(layout);
  Eigen::VectorX<Real> v = Eigen::VectorX<Real>::Zero(layout.size());
  v(rest) = from.value;
  v[layout.loss_scatter()] = usual_loss_scatter;
  const Eigen::VectorX<Real> begin = v;
  pluck_problem problem(takes, {layout, guess.ac_coupled_Hz}, options, guess, v, options.most_partials, from.horizon_periods,
                        true, from.noise_N);
  const auto settle = [&](Eigen::VectorX<Real>& at) {
    out.converged = descend(problem, problem.model(), begin, at, 25, 1e-3, out.iterations);
  };
  settle(v);
  problem.set_noise(problem.assess(v).noise);
  settle_scatter(problem, v, settle);
  const assessment found = problem.assess(v);
  out.noise_N = found.noise, out.misfit = found.misfit, out.more_than_noise = found.inflation() != 1;
  out.residual_ratio = found.residual_ratio;
  const pluck_equations end = problem.linearise(v);
  const Eigen::MatrixX<Real> inverse = invert_free(problem.model(), end.hessian);
  const Eigen::MatrixX<Real> all = inverse * (end.prior + found.inflation() * problem.scatter(v)) * inverse;
  out.value = v(rest), out.covariance = all(rest, rest), out.sd = out.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  out.loss_scatter = v[layout.loss_scatter()];
  out.own_losses.assign(v.data() + layout.first_of_own(), v.data() + layout.first_of_own() + layout.own_losses());
  return out;
}
ROSIN_INSTANTIATE(pluck_fit_result with_own_losses(const std::vector<pluck_take>&, const pluck_guess&, pluck_options,
                                                   const pluck_fit_result&))

/// Where more than noise is left and most of it is due to modes that lose each in its own way.
template <class = void>
void try_own_losses(const std::vector<pluck_take>& takes, const pluck_guess& guess, const pluck_options& options,
                    pluck_fit_result& result) {
  if (!options.asks_own_losses || !result.more_than_noise || result.horizon_periods < horizon_periods.front()) return;
  pluck_fit_result other = with_own_losses(takes, guess, options, result);
  if (other.misfit - 1 < (result.misfit - 1) / 2 && scatters_from_mode_to_mode(other.own_losses)) result = std::move(other);
}

}  // namespace detail

/// Fits `takes` together. Fails, with the take and the reason, where no release is found or the string does not ring as declared,
/// that is, where more than `most_residual` of the signal (rms) is left.
template <class Real = double>
[[nodiscard]] outcome<pluck_fit_result> fit_plucks(const std::vector<pluck_take>& takes, const pluck_guess& guess,
                                                   const pluck_options& options = {}, double most_residual = 0.6) {
  outcome<pluck_start> start = find_start(takes, guess);
  if (!start) return failure{start.error()};
  pluck_fit_result result;
  result.layout = pluck_layout(takes, options);
  result.limits = options.limits_for(takes.front().rate_Hz);
  result.value = result.layout.initial(takes, guess, start->fundamental_Hz, start->release_s, start->position);

  const Eigen::VectorX<Real> begin = result.value;
  detail::approach_and_finish(takes, guess, options, result);
  const pluck_fit_result smooth = result;
  detail::try_own_losses(takes, guess, options, result);
  if (result.more_than_noise) {
    pluck_fit_result causal = smooth;
    detail::try_causality(takes, guess, options, begin, causal);
    detail::try_own_losses(takes, guess, options, causal);
    if (causal.misfit < result.misfit || causal.loss_scatter == 0) result = std::move(causal);
  }
  const double worst = detail::worst(result);
  if (worst > most_residual)
    return failure{takes.front().name + ": the plucks do not ring as the declared string should (residual " +
                   std::to_string(static_cast<int>(100 * worst)) + " % of the signal): check pitch, position, channels and rate"};
  return result;
}
ROSIN_INSTANTIATE(outcome<pluck_fit_result> fit_plucks(const std::vector<pluck_take>&, const pluck_guess&, const pluck_options&,
                                                       double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
