// tier: hosted
// SPDX-License-Identifier: MIT
//
// Tension modulation as one channel hears it (Kirchhoff and Carrier): a string that swings is longer, so that every partial is
// sharp,
//
//     df_m / f_m = g(t) = relative sum_n p_n (1 + d_nm / 2) exp(-2 a_n t),     sum p_n = 1,
//
// p_n the powers of the partials as slopes of the string, a_n their decay; a mode stretches itself half as much again. Where the
// sensor's place is not known the p_n are those of the recording, or all is one exponential of unknown rate: what leaves less is
// taken. With slopes in absolute units relative = E A / (16 T) sum slope_n^2.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pickup_pair.hpp>

#include <complex>
#include <optional>

namespace rosin {

/// g(t) of one ringing but for its strength.
struct glide_shape {
  std::vector<double> power, rate_per_s;  ///< power adds up to 1
  std::vector<int> number;                ///< of the partial; 0: of none

  /// Integral over (0, t) for partial m.
  [[nodiscard]] double path_s(int m, double t) const {
    double sum = 0;
    for (std::size_t i = 0; i < power.size(); ++i)
      sum += (number[i] == m ? 1.5 : 1.0) * power[i] * -std::expm1(-rate_per_s[i] * t) / rate_per_s[i];
    return sum;
  }
};

/// As the sensor's place and the decays have it.
[[nodiscard]] inline glide_shape shape_by_power(const pickup_ringing& r) {
  glide_shape s;
  const double sum = r.strength();
  for (std::size_t i = 0; i < r.tracks.size(); ++i) {
    s.power.push_back(r.power[i] / sum);
    s.rate_per_s.push_back(2 * detail::as_one(r.tracks[i]).decay_per_s);
    s.number.push_back(r.tracks[i].number);
  }
  return s;
}
[[nodiscard]] inline glide_shape shape_by_rate(double rate_per_s) { return {{1}, {rate_per_s}, {0}}; }

/// The track with a glide of that strength taken out: one line is fitted anew.
template <class = void>
[[nodiscard]] partial_track without_glide(const partial_track& t, const std::vector<double>& path_s, double relative,
                                          double tolerance_Hz) {
  partial_track out = t;
  const double turn = -detail::full_turn * t.fit.model.centre_Hz * relative;
  for (std::size_t j = 0; j < out.samples.size(); ++j) out.samples[j] *= std::polar(1.0, turn * path_s[j]);
  out.fit = fit_one_line(out.samples, out.rate_Hz, t.fit.model.centre_Hz, tolerance_Hz);
  return out;
}

[[nodiscard]] inline std::vector<double> path_along(const glide_shape& shape, const partial_track& t) {
  std::vector<double> path;
  for (std::size_t j = 0; j < t.samples.size(); ++j) path.push_back(shape.path_s(t.number, static_cast<double>(j) / t.rate_Hz));
  return path;
}

/// The glide of one ringing, and what it is worth.
struct glide_found {
  glide_shape shape;
  double relative = 0, sd = 0, gain = 0;  ///< sharp by that at the start; by how much ln L rises
  double agreeing = 0;                    ///< part of the partials that are better off
};

namespace detail {

/// Strength of a glide by likelihood in the clearest partials, each of them one line or a pair of a known distance.
class glide_search {
public:
  template <class = void>
  glide_search(const pickup_ringing& r, const glide_shape& shape, double detuning)
      : r_{r}, shape_{shape}, detuning_{detuning}, which_{clearest(r, 24)} {
    for (const std::size_t i : which_) {
      path_.push_back(path_along(shape, r.tracks[i]));
      plain_.push_back(value(path_.size() - 1, 0));
    }
  }
  /// By how much ln L rises.
  template <class = void>
  [[nodiscard]] double operator()(double relative) const {
    double sum = 0;
    for (std::size_t k = 0; k < which_.size(); ++k) sum += value(k, relative) - plain_[k];
    return sum;
  }
  /// From `about` on, or anywhere.
  template <class = void>
  [[nodiscard]] glide_found best(double about = 0) const {
    likelihood_peak top{about, about > 0 ? (*this)(about) : 0};
    if (!(about > 0))
      for (double g = 4e-6; g < 0.02; g *= 1.35)
        if (const double v = (*this)(g); v > top.gain) top = {g, v};
    return described(climbed(*this, top, (about > 0 ? 0.02 : 0.16) * top.at, 2e-4));
  }

private:
  template <class = void>
  [[nodiscard]] double value(std::size_t k, double relative) const {
    const partial_track& t = r_.tracks[which_[k]];
    const partial_track still = without_glide(t, path_[k], relative, 1.5 * r_.tolerance_Hz);
    return log_likelihood(t, detuning_ == 0 ? still.fit.residual : fit_pair(still, detuning_).residual);
  }
  template <class = void>
  [[nodiscard]] glide_found described(likelihood_peak top) const {
    glide_found out{shape_, top.at, std::numeric_limits<double>::infinity(), top.gain, 0};
    if (!(top.at > 0)) return out;
    out.sd = sd_at(*this, top, 0.001 * top.at, 0.5 * top.at);
    for (std::size_t k = 0; k < which_.size(); ++k) out.agreeing += value(k, top.at) > plain_[k] ? 1 : 0;
    out.agreeing /= static_cast<double>(which_.size());
    return out;
  }

  const pickup_ringing& r_;
  glide_shape shape_;
  double detuning_;
  std::vector<std::size_t> which_;
  std::vector<std::vector<double>> path_;
  std::vector<double> plain_;
};

}  // namespace detail

namespace detail {

/// A line that glides looks as if it died sooner: the powers fall as the lines do without the glide, and that makes it another
/// one.
template <class = void>
glide_found with_own_rates(const pickup_ringing& r, glide_found g, double detuning) {
  constexpr int rounds = 2;
  for (int round = 0; round < rounds && g.relative > 0; ++round) {
    glide_shape shape = g.shape;
    for (std::size_t k = 0; k < r.tracks.size(); ++k) {
      const partial_track& t = r.tracks[k];
      const double decay =
          without_glide(t, path_along(g.shape, t), g.relative, 1.5 * r.tolerance_Hz).fit.model.parts[0].decay_per_s;
      if (decay > 0) shape.rate_per_s[k] = 2 * decay;
    }
    g = glide_search(r, shape, detuning).best(g.relative);
  }
  return g;
}

}  // namespace detail

/// The likelier of the shapes; `power_known`: the sensor tells the powers, and no other shape is asked for. detuning: of pairs,
/// or 0.
template <class = void>
[[nodiscard]] glide_found find_glide(const pickup_ringing& r, bool power_known, double detuning = 0) {
  glide_found best = detail::with_own_rates(r, detail::glide_search(r, shape_by_power(r), detuning).best(), detuning);
  if (power_known) return best;
  const double rate = detail::glide_decay(r.tracks);
  for (const double factor : {1.0, 0.4, 2.5}) {
    const glide_found other = detail::glide_search(r, shape_by_rate(rate * factor), detuning).best();
    if (other.gain > best.gain + 3) best = other;
    if (best.gain < 5) break;
  }
  return best;
}
ROSIN_INSTANTIATE(glide_found find_glide(const pickup_ringing&, bool, double))

}  // namespace rosin
