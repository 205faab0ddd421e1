// tier: hosted
// SPDX-License-Identifier: MIT
//
// A string that swings widely is stretched, so it starts sharp and comes down with its energy: the same fraction for every
// partial, and gone like exp(-kappa t), kappa twice the decay rate of the loud partials. Left alone it would make the pitch too
// high, by more for high partials, which are heard early only. So each partial is fitted with the glide free, the glides are
// combined robustly (beats look like glides, but not the same in all), and what is sure is taken out of all partials. kappa
// itself is sought in the clearest partials. A twentieth of the glide stays in the error: it is not quite exponential.
//
#pragma once

#include <rosin/calibrate/partials.hpp>
#include <rosin/calibrate/pickup_regression.hpp>
#include <rosin/core/instantiate.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The pitch is sharp by relative * exp(-decay t), t from the first sample fitted.
struct glide_estimate {
  pitch_glide glide{};           ///< to be taken out; nothing where none is sure
  double sd = 0;                 ///< what is left: of the relative glide at the start
  std::vector<double> share_Hz;  ///< for each track: by how much a relative glide of 1 moves its frequency
};

namespace detail {

/// The track as one line, whatever it was fitted as (a glide looks like two): decay from the energies of its halves.
inline damped_part as_one(const partial_track& t) {
  const double lasts = static_cast<double>(t.samples.size()) / t.rate_Hz;
  const complex_span z{t.samples};
  const double first = energy_of(z.first(z.size() / 2)), second = energy_of(z.subspan(z.size() / 2));
  double energy = 0, detuning = 0;
  for (const damped_part& p : t.fit.model.parts) {
    energy += p.energy(lasts);
    detuning += p.energy(lasts) * p.detuning_rad_s;
  }
  return {1.0, std::max(std::log(first / std::max(second, 1e-300)), 0.05) / lasts, detuning / energy};
}

inline double glide_decay(const std::vector<partial_track>& tracks) {
  double energy = 0, sum = 0;
  for (const partial_track& t : tracks) {
    energy += energy_of(t.samples);
    sum += energy_of(t.samples) * as_one(t).decay_per_s;
  }
  return 2 * sum / std::max(energy, 1e-300);
}

}  // namespace detail

namespace detail {

/// A track as one line with the glide free, gone at the rate kappa. Many turns of phase may lie in a glide: two starts are tried.
template <class = void>
line_fit gliding(const partial_track& t, double kappa, double expected) {
  const double lasts = static_cast<double>(t.samples.size()) / t.rate_Hz;
  damped_part part = as_one(t);
  line_fit best = fit_line(t.samples, t.rate_Hz, {{part}, t.fit.model.centre_Hz, {0, kappa}}, true);
  if (expected == 0) return best;
  const double heard = std::min(lasts, 0.7 / std::max(part.decay_per_s, 1e-3));  // where the energy is
  part.detuning_rad_s -= full_turn * t.fit.model.centre_Hz * expected * pitch_glide{expected, kappa}.path_s(heard) / heard;
  line_fit other = fit_line(t.samples, t.rate_Hz, {{part}, t.fit.model.centre_Hz, {expected, kappa}}, true);
  return other.residual < best.residual ? other : best;
}

struct glides {
  robust_data each;
  std::vector<double> share_Hz;
  double value, sd;  ///< of all together
};

template <class Real = double>
glides combined_glide(const std::vector<partial_track>& tracks, double kappa) {
  const auto n = static_cast<Eigen::Index>(tracks.size());
  glides g{{Eigen::VectorX<Real>(n), Eigen::VectorX<Real>(n), Eigen::VectorX<Real>::Ones(n)}, {}, 0, 0};
  for (Eigen::Index i = 0; i < n; ++i) {
    partial_track t = tracks[static_cast<std::size_t>(i)];
    const Eigen::Index known = std::min<Eigen::Index>(i, 5);  // lower partials lead: their phase turns less
    t.fit = gliding(t, kappa, known < 2 ? 0.0 : median_of(g.each.y.segment(i - known, known)));
    const Eigen::MatrixX<Real> covariance = line_covariance(t.fit, noise_of(t).at_line);
    g.each.y[i] = t.fit.model.glide.relative;
    g.each.variance[i] = std::max(covariance(4, 4), 1e-20);
    g.share_Hz.push_back(-covariance(3, 4) / std::max(covariance(4, 4), 1e-300) / full_turn);
  }
  const auto constant = [](const Eigen::VectorX<Real>& theta, Eigen::VectorX<Real>& y, Eigen::MatrixX<Real>& J) {
    y.setConstant(theta[0]);
    J.setOnes();
  };
  const robust_fit fit = robust_regression(g.each, constant, Eigen::VectorX<Real>::Constant(1, median_of(g.each.y)));
  g.value = fit.value[0];
  g.sd = std::sqrt(fit.covariance(0, 0));
  return g;
}

/// The rate at which the glide dies away, between a fifth and five times a first guess: the one that leaves least over in the
/// clearest partials.
template <class = void>
double likeliest_glide_decay(const std::vector<partial_track>& tracks, double guess, double expected) {
  std::vector<std::pair<double, const partial_track*>> clearest;
  for (const partial_track& t : tracks) clearest.emplace_back(-energy_of(t.samples) / noise_of(t).at_line, &t);
  std::sort(clearest.begin(), clearest.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  clearest.resize(std::min<std::size_t>(clearest.size(), 6));
  const auto cost = [&](double factor) {
    double sum = 0;
    for (const auto& [order, t] : clearest)
      sum += static_cast<double>(t->samples.size()) * std::log(std::max(gliding(*t, guess * factor, expected).residual, 1e-300));
    return sum;
  };
  double step = std::sqrt(3.0), best = 1, least = cost(1);
  for (int i = 0; i < 12 && step > 1.02; ++i) {
    const double here = best;
    for (const double factor : {here / step, here * step}) {
      if (factor < 0.2 || factor > 5.1) continue;
      if (const double c = cost(factor); c < least) least = c, best = factor;
    }
    if (best == here) step = std::sqrt(step);
  }
  return guess * best;
}

}  // namespace detail

/// Precondition: at least one track.
template <class = void>
[[nodiscard]] glide_estimate estimate_glide(const std::vector<partial_track>& tracks) {
  double kappa = detail::glide_decay(tracks);
  detail::glides all = detail::combined_glide(tracks, kappa);
  const auto sure = [&] { return tracks.size() >= 4 && all.value > 2.5 * all.sd && all.value < 0.02; };
  if (sure()) all = detail::combined_glide(tracks, kappa = detail::likeliest_glide_decay(tracks, kappa, all.value));
  glide_estimate found{{sure() ? all.value : 0.0, kappa}, 0, all.share_Hz};
  if (tracks.size() < 4) return found;
  found.sd = sure() ? std::hypot(all.sd, 0.05 * all.value) : std::min(std::hypot(all.sd, all.value), 0.01);
  return found;
}
ROSIN_INSTANTIATE(glide_estimate estimate_glide(const std::vector<partial_track>&))

/// The same tracks with the glide taken out: one line or two is decided anew.
template <class = void>
void take_out_glide(std::vector<partial_track>& tracks, const pitch_glide& glide, double tolerance_Hz) {
  for (partial_track& t : tracks) {
    const line_fit one = fit_line(
        t.samples, t.rate_Hz, {detail::gliding(t, glide.decay_per_s, glide.relative).model.parts, t.fit.model.centre_Hz, glide});
    t.fit = one_or_two_lines(t.samples, t.rate_Hz, one, tolerance_Hz, detail::filled_with_noise(t.window, t.rate_Hz));
  }
}
ROSIN_INSTANTIATE(void take_out_glide(std::vector<partial_track>&, const pitch_glide&, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
