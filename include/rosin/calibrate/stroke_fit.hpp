// tier: hosted
// SPDX-License-Identifier: MIT
//
// Calibration from strokes alone: pitch, stiffness and loss of the string, mode by mode, the ratio of the gains, the skew between the
// channels, and the place of the contact in each take, from the mismatch of the two ends over whole records (stroke_problem.hpp).
// Transients, double slips and noisy strokes help: they excite more than the harmonics of one period.
//
// The phase of the mismatch turns many times up to the edge of the band, so the fit begins with the first partials and takes in
// twice as many hertz from stage to stage. What the takes scatter by, in tension, and modes about a smooth law of loss, has a normal
// prior whose spread the data choose: the update of MacKay (Neural Computation 4, 415, 1992),
//
//     spread^2 = sum value^2 / sum (1 - sd^2 / spread^2),
//
// finds the greatest evidence. So nothing scatters that need not, and a string of even loss costs no precision. Noise of both
// channels and what the model leaves are estimated between the descents (stroke_noise.hpp); the covariance counts them all.
//
// The mismatch says nothing of what is common to both channels: their common gain, the impedance, a common filter; nor of the
// friction. A take that contradicts the others (another string, a gain that changed, a contact that is not one place) spoils what
// all are fitted to: where more is left than a good model leaves, each take is left out once, and the one without which the rest
// agrees is named.
//
#pragma once

#include <rosin/calibrate/stroke_problem.hpp>
#include <rosin/calibrate/stroke_start.hpp>
#include <rosin/core/finite_math.hpp>

#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What a fit of strokes found. Order of parameters and covariance: stroke_layout.
struct stroke_fit_result {
  stroke_layout layout;
  Eigen::VectorXd value, sd;
  Eigen::MatrixXd covariance;
  stroke_noise noise;                     ///< of the recorded channels; `model`: what the model leaves, relative to the signal
  double q_scatter = 0;                   ///< spread of ln Q of the modes about the law
  double drift_spread = 0;                ///< of ln f0 from take to take
  std::vector<double> misfit;             ///< per take: power of the mismatch against what noise and model explain; 1: as much
  std::vector<std::string> unidentified;  ///< parameters that these strokes cannot tell
  std::optional<std::size_t> odd;         ///< the take that contradicts the others: not fitted, its position as declared
  double edge_Hz = 0;
  int iterations = 0;
  bool converged = false;

  [[nodiscard]] uneven_string string() const { return layout.string(value); }
  [[nodiscard]] uneven_string string(std::size_t take) const { return layout.string(value, take); }
  [[nodiscard]] double position(std::size_t take) const { return value[layout.position(take)]; }
  /// One model of string and sensors accounts for all but a hundredth of what the ends tell of each other.
  [[nodiscard]] bool holds() const noexcept { return noise.model < most_model; }
  static constexpr double most_model = 0.01;
  /// ln of f0 in a take over the mean of all fitted takes, with its standard deviation.
  struct drift_of_take {
    double value = 0, sd = 0;
  };
  template <class Real = double>
  [[nodiscard]] drift_of_take drift(std::size_t take) const {
    Eigen::VectorX<Real> contrast = Eigen::VectorX<Real>::Zero(layout.size());
    const double others = static_cast<double>(layout.takes() - (odd ? 1 : 0));
    for (std::size_t t = 0; t < layout.takes(); ++t)
      if (!odd || t != *odd) contrast[layout.drift(t)] = -1 / others;
    contrast[layout.drift(take)] += 1;
    return {contrast.dot(value), std::sqrt(std::max(0.0, contrast.dot(covariance * contrast)))};
  }
  /// Beyond five standard deviations, of a spread that is no rounding.
  template <class = void>
  [[nodiscard]] bool drifted(std::size_t take) const {
    const auto d = drift(take);
    return (!odd || *odd != take) && drift_spread > 2e-6 && std::abs(d.value) > 5 * d.sd;
  }
};

namespace detail {

/// Of drift and of u_n: what the data choose.
struct stroke_spreads {
  double scatter = 0.1, drift = 1e-3;
};

template <class Real = double>
[[nodiscard]] stroke_prior prior_of(const stroke_layout& layout, const std::vector<stroke_take>& takes, const stroke_guess& guess,
                                    const stroke_options& options, double pitch_Hz, const stroke_spreads& spreads) {
  using L = stroke_layout;
  stroke_prior p{Eigen::VectorX<Real>::Zero(layout.size()), Eigen::VectorX<Real>::Zero(layout.size())};
  p.mean[L::fundamental] = pitch_Hz, p.sd[L::fundamental] = std::max(0.005, guess.fundamental_tolerance / 2) * pitch_Hz;
  p.mean[L::inharmonicity] = guess.inharmonicity;
  p.sd[L::inharmonicity] = guess.inharmonicity > 0 ? guess.inharmonicity_tolerance / 2 * guess.inharmonicity : 1e-4;
  p.mean[L::ln_inverse_quality] = -std::log(guess.quality), p.sd[L::ln_inverse_quality] = 1;
  p.sd[L::internal_loss] = 0.5 / (guess.quality * options.edge_Hz);
  p.sd[L::ln_gain_ratio] = std::max(1e-9, std::hypot(guess.gain_tolerance[0], guess.gain_tolerance[1]) / 2);
  p.sd[L::skew] = std::max(1e-12, options.skew_sd_s);
  for (std::size_t t = 0; t < takes.size(); ++t) {
    p.mean[layout.position(t)] = takes[t].position, p.sd[layout.position(t)] = std::max(1e-6, guess.position_tolerance / 2);
    p.sd[layout.drift(t)] = spreads.drift;
  }
  for (std::size_t m = 0; m < layout.modes(); ++m) p.sd[layout.own_q(m)] = spreads.scatter;
  return p;
}

/// The evidence's next spread of some parameters.
template <class = void>
[[nodiscard]] double next_spread(const Eigen::VectorXd& value, const Eigen::MatrixXd& covariance, Eigen::Index first,
                                 std::size_t count, double spread, double least, double most) {
  double told = 0, squares = 0;
  for (Eigen::Index p = first; p < first + static_cast<Eigen::Index>(count); ++p)
    told += 1 - covariance(p, p) / (spread * spread), squares += value[p] * value[p];
  return std::clamp(std::sqrt(squares / std::max(told, 0.2)), least, most);
}

/// Inverse of a Hessian whose prior makes it definite, whatever the units.
template <class Real = double>
[[nodiscard]] Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& hessian) {
  const Eigen::VectorX<Real> unit = hessian.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixX<Real> scaled = unit.asDiagonal() * hessian * unit.asDiagonal();
  return unit.asDiagonal() * scaled.ldlt().solve(Eigen::MatrixX<Real>::Identity(hessian.rows(), hessian.cols())) *
         unit.asDiagonal();
}

/// Stages: edges of the band, each twice the one before; the whole band more than once, until spreads and noise have settled.
[[nodiscard]] inline std::vector<double> stroke_edges(double pitch_Hz, double edge_Hz) {
  std::vector<double> edges;
  for (double edge = 6 * pitch_Hz; edge < 0.8 * edge_Hz; edge *= 2) edges.push_back(edge);
  edges.insert(edges.end(), 3, edge_Hz);
  return edges;
}

/// All stages with these takes.
template <class Real = double>
[[nodiscard]] stroke_fit_result fit_stages(const std::vector<stroke_take>& takes, const stroke_guess& guess,
                                           const stroke_options& options, double pitch_Hz) {
  using L = stroke_layout;
  stroke_fit_result r;
  r.edge_Hz = options.edge_Hz, r.noise.model = 1e-2;
  for (const stroke_take& take : takes) r.edge_Hz = std::min(r.edge_Hz, 0.4 * take.rate_Hz);
  stroke_spreads spreads;
  std::vector<stroke_spectra> spectra;
  double made_for = 0;
  for (const double edge : stroke_edges(pitch_Hz, r.edge_Hz)) {
    if (edge != made_for) {
      spectra.clear();
      for (const stroke_take& take : takes) spectra.emplace_back(take, 0.5 * pitch_Hz, made_for = edge, 0.5 / pitch_Hz);
    }
    r.layout = L(takes.size(), std::max<std::size_t>(2, static_cast<std::size_t>(edge / pitch_Hz) + 1));
    stroke_prior prior = prior_of(r.layout, takes, guess, options, pitch_Hz, spreads);
    Eigen::VectorX<Real> start = prior.mean;
    if (r.value.size() > 0)
      start.head(std::min(r.value.size(), start.size())) = r.value.head(std::min(r.value.size(), start.size()));
    const stroke_problem problem(r.layout, spectra, std::move(prior), r.noise);
    auto found =
        levenberg_marquardt(problem, Eigen::VectorXd(start),
                            {.first = 1e-6, .more = 30, .restart = 1e-6, .iterations = 25, .enough = 0.05, .enough_relative = 0});
    r.value = std::move(found.at), r.iterations += found.iterations, r.converged = found.converged();
    r.covariance = scaled_inverse(found.equations.hessian);

    std::vector<stroke_leftover> left;
    for (std::size_t t = 0; t < takes.size(); ++t) left.push_back(problem.left(r.value, t));
    r.noise = estimate_noise(left, r.noise);
    r.misfit.clear();
    for (const stroke_leftover& l : left) r.misfit.push_back(l.misfit(r.noise));
    r.q_scatter = spreads.scatter = next_spread(r.value, r.covariance, r.layout.own_q(0), r.layout.modes(), spreads.scatter,
                                                options.least_scatter, options.most_scatter);
    r.drift_spread = spreads.drift = takes.size() < 2 ? options.least_drift
                                                      : next_spread(r.value, r.covariance, r.layout.drift(0), takes.size(),
                                                                    spreads.drift, options.least_drift, options.most_drift);
  }
  r.sd = r.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  const stroke_prior before = prior_of(r.layout, takes, guess, options, pitch_Hz, spreads);
  for (Eigen::Index p = 0; p < r.layout.drift(0); ++p)
    if (r.sd[p] > 0.7 * before.sd[p]) r.unidentified.push_back(r.layout.name(p));
  return r;
}
ROSIN_INSTANTIATE(stroke_fit_result fit_stages(const std::vector<stroke_take>&, const stroke_guess&, const stroke_options&,
                                               double))

/// A fit without one take, with the room for it: its position as declared, what is known of it no better than before.
template <class Real = double>
[[nodiscard]] stroke_fit_result with_room_for(const stroke_fit_result& fit, std::size_t odd, const stroke_take& take,
                                              const stroke_guess& guess) {
  stroke_fit_result r = fit;
  r.layout = stroke_layout(fit.layout.takes() + 1, fit.layout.modes()), r.odd = odd;
  std::vector<Eigen::Index> from(static_cast<std::size_t>(r.layout.size()), -1);
  for (Eigen::Index p = 0; p < stroke_layout::first_position; ++p) from[static_cast<std::size_t>(p)] = p;
  for (std::size_t t = 0; t < fit.layout.takes(); ++t) {
    const std::size_t to = t < odd ? t : t + 1;
    from[static_cast<std::size_t>(r.layout.position(to))] = fit.layout.position(t);
    from[static_cast<std::size_t>(r.layout.drift(to))] = fit.layout.drift(t);
  }
  for (std::size_t m = 0; m < fit.layout.modes(); ++m) from[static_cast<std::size_t>(r.layout.own_q(m))] = fit.layout.own_q(m);
  const Eigen::Index n = r.layout.size();
  r.value = Eigen::VectorX<Real>::Zero(n), r.covariance = Eigen::MatrixX<Real>::Zero(n, n);
  r.value[r.layout.position(odd)] = take.position;
  for (Eigen::Index p = 0; p < n; ++p) {
    const Eigen::Index i = from[static_cast<std::size_t>(p)];
    if (i < 0) continue;
    r.value[p] = fit.value[i];
    for (Eigen::Index q = 0; q < n; ++q)
      if (const Eigen::Index j = from[static_cast<std::size_t>(q)]; j >= 0) r.covariance(p, q) = fit.covariance(i, j);
  }
  r.covariance(r.layout.position(odd), r.layout.position(odd)) = std::pow(guess.position_tolerance / 2, 2);
  r.covariance(r.layout.drift(odd), r.layout.drift(odd)) = std::pow(fit.drift_spread, 2);
  r.sd = r.covariance.diagonal().cwiseMax(0).cwiseSqrt();
  r.misfit.insert(r.misfit.begin() + static_cast<std::ptrdiff_t>(odd), std::numeric_limits<double>::infinity());
  return r;
}
ROSIN_INSTANTIATE(stroke_fit_result with_room_for(const stroke_fit_result&, std::size_t, const stroke_take&, const stroke_guess&))

}  // namespace detail

/// Fits `takes` together. Fails, with the take and the reason, where a record cannot be used.
template <class = void>
[[nodiscard]] outcome<stroke_fit_result> fit_strokes(const std::vector<stroke_take>& takes, const stroke_guess& guess,
                                                     const stroke_options& options = {}) {
  if (const std::string why = problem_with(takes, guess); !why.empty()) return failure{why};
  const double pitch_Hz = starting_pitch_Hz(takes, guess);
  stroke_fit_result all = detail::fit_stages(takes, guess, options, pitch_Hz);
  constexpr double suspicious = 5e-3, much_less = 3;
  if (takes.size() < 3 || !options.one_by_one || all.noise.model < suspicious) return all;
  std::optional<stroke_fit_result> best;
  std::size_t odd = 0;
  for (std::size_t t = 0; t < takes.size(); ++t) {
    std::vector<stroke_take> others = takes;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(t));
    stroke_fit_result rest = detail::fit_stages(others, guess, options, pitch_Hz);
    if (!best || rest.noise.model < best->noise.model) best = std::move(rest), odd = t;
  }
  if (best->noise.model * much_less > all.noise.model) return all;
  return detail::with_room_for(*best, odd, takes[odd], guess);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
