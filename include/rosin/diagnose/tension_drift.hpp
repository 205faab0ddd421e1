// tier: hosted
// SPDX-License-Identifier: MIT
//
// Did the tension change between the plucks and the strokes? Then both delays are stretched alike, d tau / tau = -dT / (2 T), and
// the two versions of the force part (docs/explain/catalogue.md). One number for all takes; how well a moved contact
// would do instead is tried beside it.
//
#pragma once

#include <rosin/reconstruct/fine_tune.hpp>

#include <boost/math/tools/minima.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One bowed take: recorded nominal newtons, and the calibration that the plucks gave.
struct bowed_recording {
  std::span<const double> near_N, far_N;
  calibration from;
};

struct tension_drift {
  double relative = 0, sd = 0;                                        ///< tension in the strokes / in the plucks - 1
  double delta_before = 0, delta_after = 0, delta_moved_contact = 0;  ///< Eq. (12), rms over the takes
  double scatter = 0;                                                 ///< between takes, of `relative`
};

namespace detail {

/// Delays, stiffness (epsilon = B m / T^2) and impedance follow the tension.
template <class Point>
void tighten(Point& at, double relative) {
  const double slower = 1 / std::sqrt(1 + relative);
  for (double& d : at.delay_s) d *= slower;
  at.stiffness_s2 *= std::pow(slower, 4);
  at.impedance_Ns_m /= slower;
}

}  // namespace detail

/// The calibration at another tension.
[[nodiscard]] inline calibration at_tension(calibration c, double relative) {
  detail::tighten(c.at, relative);
  return c;
}

namespace detail {

/// Mean and doubt of what was found in each take; the sums of squares of delta become rms values.
inline void summarise(tension_drift& out, const std::vector<double>& found, const std::vector<double>& weight) {
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < found.size(); ++i) sum += weight[i] * found[i], weights += weight[i];
  const double n = std::max<double>(1, static_cast<double>(found.size()));
  out.relative = weights > 0 ? sum / weights : 0;
  for (const double r : found) out.scatter = std::max(out.scatter, std::abs(r - out.relative));
  out.sd = std::hypot(weights > 0 ? 1 / std::sqrt(weights) : 0, out.scatter / std::sqrt(n));
  for (double* d : {&out.delta_before, &out.delta_after, &out.delta_moved_contact}) *d = std::sqrt(*d / n);
}

}  // namespace detail

template <class Physics = full_physics>
[[nodiscard]] tension_drift find_tension_drift(const std::vector<bowed_recording>& takes, const band& limits, double rate_Hz) {
  tension_drift out;
  std::vector<double> found, weight;
  for (const bowed_recording& t : takes) {
    calibration c = t.from;
    c.covariance *= 1e-6;  // the plucks' own errors are not what is sought
    double relative = 0, sd = 1;
    fine_tuning last{c};
    double stretch = 1;
    for (int round = 0; round < 10 && std::abs(stretch) > 1e-7;
         ++round) {  // tuning stretches delays; the stiffness follows from round to round
      const calibration here = at_tension(c, relative);
      last = fine_tune<Physics>(here, t.near_N, t.far_N, limits, rate_Hz, {1e-2, 1e-9, 1e-9});
      if (round == 0) out.delta_before += last.delta_before * last.delta_before;
      stretch = (last.shift[0] + last.shift[1]) / (here.at.delay_s[0] + here.at.delay_s[1]);
      relative = (1 + relative) / std::pow(1 + stretch, 2) - 1;
      sd = 2 * std::sqrt(last.tuned.covariance(0, 0)) / c.at.delay_s[0];
    }
    const auto moved = fine_tune<Physics>(c, t.near_N, t.far_N, limits, rate_Hz, {1e-9, 1e-2, 1e-2});
    out.delta_after += last.delta_after * last.delta_after;
    out.delta_moved_contact += moved.delta_after * moved.delta_after;
    found.push_back(relative);
    weight.push_back(1 / (sd * sd));
  }
  detail::summarise(out, found, weight);
  return out;
}

namespace detail {

/// Where a function of one number is least, and what it is there: steps to either side of `middle`, then Brent's way around the best.
template <class Function>
[[nodiscard]] std::pair<double, double> least_around(Function&& f, double middle, int steps, double step) {
  constexpr int bits = 20;
  double start = middle, least = f(middle);
  for (int k = -steps; k <= steps; ++k)
    if (const double y = f(middle + k * step); y < least) least = y, start = middle + k * step;
  return boost::math::tools::brent_find_minima(f, start - step, start + step, bits);
}

}  // namespace detail

/// The same for any way to reconstruct: delta(take, relative) is Eq. (12) of a take at that tension. Searched within 6.4 %.
template <class Delta>
[[nodiscard]] tension_drift search_tension_drift(std::size_t takes, Delta&& delta) {
  tension_drift out;
  std::vector<double> found;
  for (std::size_t t = 0; t < takes; ++t) {
    const auto at = [&](double relative) { return delta(t, relative); };
    const double before = at(0);
    out.delta_before += before * before;
    const auto [relative, after] = detail::least_around(at, 0, 16, 0.004);  // the valley is about a hundredth wide
    out.delta_after += after * after;
    found.push_back(relative);
  }
  out.delta_moved_contact = out.delta_before;  // not tried
  detail::summarise(out, found, std::vector<double>(found.size(), 1e10));
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
