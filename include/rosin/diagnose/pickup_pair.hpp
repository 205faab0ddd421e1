// tier: hosted
// SPDX-License-Identifier: MIT
//
// Two polarizations as one channel hears them: every partial is a pair of lines, f and f (1 + detuning), with one decay and with
// amplitudes of their own. The detuning is common to all partials where the supports are rigid; supports that yield differently
// in the two planes make each pair its own (partial_choice.hpp tells these). Amplitudes are eliminated for each detuning, which
// is sought on a grid and refined.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pickup_ringing.hpp>
#include <rosin/math/levenberg_marquardt.hpp>

#include <array>
#include <complex>
#include <limits>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// c1 exp(s t) + c2 exp(s' t), s = -decay + i w, s' = -decay + i (w + shift).
struct line_pair {
  std::array<std::complex<double>, 2> amplitude{};
  double decay_per_s = 0, detuning_rad_s = 0, shift_rad_s = 0, residual = 0;
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();  ///< re, im of both, decay, detuning
};

namespace detail {

/// Where a likelihood of one number is highest, and how high.
struct likelihood_peak {
  double at = 0, gain = 0;
};

/// From there on, with smaller steps as soon as neither neighbour is higher.
template <class Gain>
likelihood_peak climbed(const Gain& gain, likelihood_peak top, double step, double precision) {
  for (int i = 0; i < 24 && step > precision * top.at; ++i) {
    const double here = top.at;
    for (const double x : {here - step, here + step})
      if (const double g = gain(x); g > top.gain) top = {x, g};
    if (top.at == here) step /= 2;
  }
  return top;
}

/// Standard deviation, by the curvature over a distance at which half a unit is lost (from `h` to at most `widest`); without one:
/// infinite.
template <class Gain>
double sd_at(const Gain& gain, likelihood_peak top, double h, double widest) {
  while (h < widest && top.gain - gain(top.at + h) < 0.5) h *= 2;
  const double curve = (gain(top.at + h) - 2 * top.gain + gain(top.at - h)) / (h * h);
  return curve < 0 ? 1 / std::sqrt(-curve) : std::numeric_limits<double>::infinity();
}

/// Pairs of lines to a track; the shift is `relative` times the frequency of the first line.
struct pair_descent {
  complex_span z;
  double rate_Hz = 1, centre_rad_s = 0, relative = 0;

  template <class = void>
  [[nodiscard]] normal_equations<double, 6> linearise(const line_pair& p) const {
    constexpr std::complex<double> i{0, 1};
    auto n = normal_equations<double, 6>::zero();
    const auto step = std::exp(std::complex<double>{-p.decay_per_s, p.detuning_rad_s} / rate_Hz),
               other = std::polar(1.0, p.shift_rad_s / rate_Hz);
    std::complex<double> e = 1, turned = 1;
    for (std::size_t j = 0; j < z.size(); ++j, e *= step, turned *= other) {
      const double t = static_cast<double>(j) / rate_Hz;
      const auto a = p.amplitude[0] * e, b = p.amplitude[1] * e * turned;
      const Eigen::Vector<std::complex<double>, 6> row{
          {e, i * e, e * turned, i * e * turned, -t * (a + b), i * t * (a + (1 + relative) * b)}};
      n.add(row, z[j] - a - b);
    }
    n.mirror();
    return n;
  }
  template <class = void>
  [[nodiscard]] line_pair moved(line_pair p, const Eigen::Vector<double, 6>& by) const {
    p.amplitude[0] += std::complex{by[0], by[1]};
    p.amplitude[1] += std::complex{by[2], by[3]};
    return at(p, p.decay_per_s + by[4], p.detuning_rad_s + by[5]);
  }
  [[nodiscard]] line_pair at(line_pair p, double decay_per_s, double detuning_rad_s) const {
    p.decay_per_s = decay_per_s, p.detuning_rad_s = detuning_rad_s;
    p.shift_rad_s = relative * (centre_rad_s + detuning_rad_s);
    return p;
  }
  /// The amplitudes by themselves.
  template <class Real = double>
  void set_amplitudes(line_pair& p) const {
    p.amplitude = {};
    const auto n = linearise(p);
    const Eigen::Vector4<Real> c = n.hessian.template topLeftCorner<4, 4>().ldlt().solve(n.gradient.template head<4>());
    p.amplitude = {std::complex{c[0], c[1]}, std::complex{c[2], c[3]}};
  }
};

/// From decay and detuning on.
template <class = void>
line_pair fit_pair_from(const partial_track& t, const line_pair& start, double relative) {
  const pair_descent problem{complex_span{t.samples}, t.rate_Hz, full_turn * t.fit.model.centre_Hz, relative};
  line_pair from = problem.at(start, start.decay_per_s, start.detuning_rad_s);
  problem.set_amplitudes(from);
  auto found =
      levenberg_marquardt(problem, from, {.less = 1.0 / 8, .more = 8, .ceiling = 1e7, .iterations = 25, .enough_relative = 1e-7});
  found.at.residual = found.cost, found.at.information = found.equations.hessian;
  return found.at;
}

}  // namespace detail

/// The best pair with that relative distance: the line that was fitted alone may be either of the two.
template <class = void>
[[nodiscard]] line_pair fit_pair(const partial_track& t, double relative) {
  const damped_part& one = t.fit.model.parts[0];
  const double shift = relative * (detail::full_turn * t.fit.model.centre_Hz + one.detuning_rad_s);
  line_pair start;
  start.decay_per_s = one.decay_per_s, start.detuning_rad_s = one.detuning_rad_s;
  const line_pair lower = detail::fit_pair_from(t, start, relative);
  start.detuning_rad_s -= shift;
  const line_pair upper = detail::fit_pair_from(t, start, relative);
  return upper.residual < lower.residual ? upper : lower;
}

/// By how much a pair is likelier than one line; none where two lines are large only to cancel each other.
[[nodiscard]] inline double gain_of_pair(const partial_track& t, const line_pair& p) {
  const double lasts = static_cast<double>(t.samples.size()) / t.rate_Hz, energy = detail::energy_of(t.samples) / t.rate_Hz;
  if (!(damped_part{p.amplitude[0], p.decay_per_s, 0}.energy(lasts) +
            damped_part{p.amplitude[1], p.decay_per_s, 0}.energy(lasts) <
        4 * energy))
    return 0;
  return log_likelihood(t, p.residual) - log_likelihood(t, t.fit.residual);
}

/// One distance for all partials of all ringings.
struct pair_found {
  double detuning = 0, sd = 0, gain = 0;
  double coupling = 0, coupling_sd = 0;  ///< of the weaker line to the stronger, the same phase at the start
  double agreeing = 0;                   ///< part of the partials that gain more than four amplitudes of noise would
};

namespace detail {

template <class = void>
double pair_gain(const std::vector<const partial_track*>& tracks, double relative) {
  double sum = 0;
  for (const auto* t : tracks) sum += gain_of_pair(*t, fit_pair(*t, relative));
  return sum;
}

/// The other line against the main one as they are in the recording: the track's window passes what is off its centre by less.
inline std::complex<double> ratio_of(const partial_track& t, const line_pair& p, std::size_t main) {
  const auto recorded = [&](std::size_t which) {
    const double detuning = p.detuning_rad_s + (which == 1 ? p.shift_rad_s : 0);
    return p.amplitude[which] / t.window(std::complex<double>{detuning, p.decay_per_s} / full_turn);
  };
  return recorded(1 - main) / recorded(main);
}

/// The weaker line against the stronger at the release, some time before the tracks begin: the delay that makes their ratio real.
template <class Real = double>
void describe_coupling(const std::vector<const partial_track*>& tracks, const std::vector<line_pair>& pairs, std::size_t main,
                       pair_found& p) {
  const auto n = static_cast<Eigen::Index>(pairs.size());
  robust_data each{Eigen::VectorX<Real>(n), Eigen::VectorX<Real>(n), Eigen::VectorX<Real>::Ones(n)}, best = each;
  const auto constant = [](const Eigen::VectorX<Real>& theta, Eigen::VectorX<Real>& y, Eigen::MatrixX<Real>& J) {
    y.setConstant(theta[0]), J.setOnes();
  };
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> sharpness;  // what an amplitude's variance is, per noise
  std::vector<std::complex<double>> ratios;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Eigen::MatrixX<Real> information = pairs[k].information;
    ratios.push_back(ratio_of(*tracks[k], pairs[k], main));
    sharpness.push_back(noise_of(*tracks[k]).away / 2 * information.completeOrthogonalDecomposition().pseudoInverse()(2, 2));
  }
  for (double delay = 0.01; delay < 0.4; delay += 0.0005) {
    double off = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double turn = (main == 0 ? -1 : 1) * pairs[k].shift_rad_s * delay, power = std::norm(pairs[k].amplitude[main]);
      const auto ratio = ratios[k] * std::polar(1.0, turn);
      each.y[i] = ratio.real();
      each.variance[i] = sharpness[k] / std::max(power, 1e-300) + 1e-6;
      off += std::min(std::pow(ratio.imag(), 2) / each.variance[i], 1e3);
    }
    if (off < least) least = off, best = each;
  }
  const robust_fit fit = robust_regression(best, constant, Eigen::VectorX<Real>::Constant(1, median_of(best.y)));
  p.coupling = fit.value[0], p.coupling_sd = std::sqrt(fit.covariance(0, 0));
}

/// Which line is the string's own in the sensor's plane: the stronger; and how strong the other is against it.
template <class = void>
void describe_pair(const std::vector<const partial_track*>& tracks, pair_found& p) {
  double lower = 0, upper = 0;
  std::vector<line_pair> pairs;
  for (const auto* t : tracks) {
    pairs.push_back(fit_pair(*t, p.detuning));
    const double whole = energy_of(t->samples);
    lower += std::norm(pairs.back().amplitude[0]) / whole, upper += std::norm(pairs.back().amplitude[1]) / whole;
    p.agreeing += gain_of_pair(*t, pairs.back()) > 4 ? 1.0 / static_cast<double>(tracks.size()) : 0;
  }
  const std::size_t main = upper > lower ? 1 : 0;
  describe_coupling(tracks, pairs, main, p);
  if (main == 1) p.sd /= std::pow(1 + p.detuning, 2), p.detuning = 1 / (1 + p.detuning) - 1;
}

}  // namespace detail

/// Sought from 3e-5 to 0.02.
template <class = void>
[[nodiscard]] pair_found find_pair(const std::vector<const partial_track*>& tracks) {
  const auto gain = [&](double x) { return detail::pair_gain(tracks, x); };
  detail::likelihood_peak top;
  for (double x = 3e-5; x < 0.02; x *= 1.09)
    if (const double g = gain(x); g > top.gain) top = {x, g};
  if (top.gain <= 0) return {};
  top = detail::climbed(gain, top, 0.04 * top.at, 1e-5);
  pair_found p{top.at, 0, top.gain};
  p.sd = detail::sd_at(gain, top, 1e-4 * top.at, 0.3 * top.at);
  if (!std::isfinite(p.sd)) p.sd = p.detuning;
  detail::describe_pair(tracks, p);
  return p;
}
ROSIN_INSTANTIATE(pair_found find_pair(const std::vector<const partial_track*>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
