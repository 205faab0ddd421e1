// tier: hosted
// SPDX-License-Identifier: MIT
//
// A string that swings widely is stretched, so it starts sharp and comes down with its energy: the same fraction for every
// partial, and gone like exp(-kappa t), kappa twice the decay rate of the loud partials. Left alone it would make the pitch too
// high, by more for high partials, which are heard early only. So each partial is fitted with the glide free, the glides are
// combined robustly (beats look like glides, but not the same in all), and what is sure is taken out of all partials.
//
#pragma once

#include <rosin/calibrate/partials.hpp>
#include <rosin/calibrate/pickup_regression.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace rosin {

/// The pitch is sharp by relative * exp(-decay t), t from the first sample fitted.
struct glide_estimate {
  pitch_glide glide{};           ///< to be taken out; nothing where none is sure
  double sd = 0;                 ///< what is left: of the relative glide at the start
  std::vector<double> share_Hz;  ///< for each track: by how much a relative glide of 1 moves its frequency
};

namespace detail {

inline double glide_decay(const std::vector<partial_track>& tracks) {
  double energy = 0, sum = 0;
  for (const partial_track& t : tracks) {
    const double lasts = static_cast<double>(t.samples.size()) / t.rate_Hz;
    const damped_part& p = strongest(t.fit.model, lasts);
    energy += p.energy(lasts);
    sum += p.energy(lasts) * std::max(p.decay_per_s, 0.2 / lasts);
  }
  return 2 * sum / std::max(energy, 1e-300);
}

}  // namespace detail

/// Precondition: at least one track.
[[nodiscard]] inline glide_estimate estimate_glide(const std::vector<partial_track>& tracks) {
  const double kappa = detail::glide_decay(tracks);
  const auto n = static_cast<Eigen::Index>(tracks.size());
  robust_data d{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd::Ones(n)};
  glide_estimate found;
  for (Eigen::Index i = 0; i < n; ++i) {
    partial_track t = tracks[static_cast<std::size_t>(i)];
    line_model one{{detail::strongest(t.fit.model, static_cast<double>(t.samples.size()) / t.rate_Hz)}, t.fit.model.centre_Hz, {0, kappa}};
    t.fit = fit_line(t.samples, t.rate_Hz, one, true);
    const Eigen::MatrixXd covariance = detail::line_covariance(t.fit, noise_of(t).at_line);
    d.y[i] = t.fit.model.glide.relative;
    d.variance[i] = std::max(covariance(4, 4), 1e-20);
    found.share_Hz.push_back(-covariance(3, 4) / covariance(4, 4) / detail::turn);
  }
  const auto constant = [](const Eigen::VectorXd& theta, Eigen::VectorXd& y, Eigen::MatrixXd& J) {
    y.setConstant(theta[0]);
    J.setOnes();
  };
  const robust_fit fit = robust_regression(d, constant, Eigen::VectorXd::Constant(1, detail::median_of(d.y)));
  const double value = fit.value[0], sd = std::sqrt(fit.covariance(0, 0));
  const bool sure = n >= 4 && value > 2.5 * sd && value < 0.02;
  found.glide = {sure ? value : 0.0, kappa};
  found.sd = n < 4 ? 0.0 : sure ? sd : std::min(std::hypot(sd, value), 0.01);
  return found;
}

/// The same tracks with the glide taken out: one line or two is decided anew.
inline void take_out_glide(std::vector<partial_track>& tracks, const pitch_glide& glide, double tolerance_Hz) {
  for (partial_track& t : tracks) {
    const double lasts = static_cast<double>(t.samples.size()) / t.rate_Hz;
    const line_model one{{detail::strongest(t.fit.model, lasts)}, t.fit.model.centre_Hz, glide};
    t.fit = one_or_two_lines(t.samples, t.rate_Hz, fit_line(t.samples, t.rate_Hz, one), tolerance_Hz, 2 * t.flat_to_Hz / t.rate_Hz);
  }
}

}  // namespace rosin
