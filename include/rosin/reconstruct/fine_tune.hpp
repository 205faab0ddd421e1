// tier: hosted
// SPDX-License-Identifier: MIT
//
// The paper's fine tuning (section III A): the two delays and the relative gain are moved a little, take by take, so that the two
// versions of the force differ least. Between the plucks and the stroke the tension may have drifted and the rod may touch a
// little beside the wire; how far that can go is stated (`allowed`) and weighed against what the plucks say, so that a search
// that finds nothing changes nothing. Without damping (Gauss-Newton), since the difference is all but linear in the three.
//
//     minimise  |e - S d|^2 / noise^2 + d' (C + allowed^2)^-1 d,    e = f_near - f_far
//
#pragma once

#include <rosin/math/levenberg_marquardt.hpp>
#include <rosin/reconstruct/consistency.hpp>
#include <rosin/reconstruct/sensitivity.hpp>

#include <Eigen/Dense>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// How far a stroke may lie from the plucks: one standard deviation each.
struct drift_allowance {
  double stretch = 3e-3;     ///< relative change of both delays (half of the change of tension)
  double position = 1e-3;    ///< shift of the contact, fraction of the length
  double gain_ratio = 5e-3;  ///< relative
};

/// A calibration tuned to one take.
struct fine_tuning {
  calibration tuned;
  waveform_vector shift = waveform_vector::Zero();  ///< of delays (s) and ln gain ratio; the others are 0
  double sigmas = 0;  ///< size of the shift, in standard deviations of the plucks' calibration and of the stroke's data
  double delta_before = 0, delta_after = 0;  ///< Eq. (12), of the two versions of the force
  int iterations = 0;
};

namespace detail {

inline constexpr std::array<Eigen::Index, 3> tuned_parameters{0, 1, 5};

template <class = void>
[[nodiscard]] Eigen::Matrix3d allowed_covariance(const calibration& c, const drift_allowance& allowed) {
  const double one_way = c.at.delay_s[0] + c.at.delay_s[1];
  const Eigen::Vector3d stretch{c.at.delay_s[0] * allowed.stretch, c.at.delay_s[1] * allowed.stretch, 0};
  const Eigen::Vector3d shift{one_way * allowed.position, -one_way * allowed.position, 0};
  const Eigen::Vector3d gain{0, 0, allowed.gain_ratio};
  return stretch * stretch.transpose() + shift * shift.transpose() + gain * gain.transpose();
}

/// Recorded nominal newtons to newtons.
template <std::size_t Inputs>
[[nodiscard]] std::array<std::vector<double>, Inputs> calibrated(const calibration& c,
                                                                 const std::array<std::span<const double>, Inputs>& recorded) {
  std::array<std::vector<double>, Inputs> out;
  for (std::size_t i = 0; i < Inputs; ++i) {
    out[i].assign(recorded[i].begin(), recorded[i].end());
    for (double& x : out[i]) x /= c.gain[i % 2];
  }
  return out;
}
[[nodiscard]] inline std::array<std::vector<double>, 2> calibrated(const calibration& c, std::span<const double> near,
                                                                   std::span<const double> far) {
  return calibrated<2>(c, {near, far});
}
template <std::size_t Inputs>
[[nodiscard]] std::array<std::span<const double>, Inputs> views_of(const std::array<std::vector<double>, Inputs>& signals) {
  std::array<std::span<const double>, Inputs> out;
  std::copy(signals.begin(), signals.end(), out.begin());
  return out;
}

/// How far the calibration is moved, and what the versions of the force tell there. The squares of the drift are added to those of
/// the difference, which has as much noise as it shows: of `independent` samples, -2 ln L = independent ln(mean square).
struct tuning {
  calibration tuned;
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  waveform_vector shift = waveform_vector::Zero();
  double delta = 0;
  Eigen::Index samples = 0;
  normal_equations<double, 3> equations = normal_equations<double, 3>::zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of the take alone
};

template <class Physics>
struct tuning_problem {
  const calibration& from;
  const end_signals<double, Physics>& recorded;
  band limits;
  double rate_Hz;
  Eigen::Matrix3d known;  ///< inverse covariance of the drift

  [[nodiscard]] tuning at(const Eigen::Vector3d& moved) const {
    tuning t{.tuned = from, .moved = moved};
    for (std::size_t i = 0; i < 3; ++i) t.shift[tuned_parameters[i]] = moved[static_cast<Eigen::Index>(i)];
    t.tuned = from.moved(t.shift);
    const auto force = calibrated(t.tuned, recorded);
    const auto in = views_of(force);
    const bow_motion<double> motion = reconstructor<double, Physics>(t.tuned.at, limits, rate_Hz, 1e-4)(in);
    t.delta = consistency_delta(motion.force_near_N, motion.force_far_N);
    const auto begin = static_cast<Eigen::Index>(motion.known.begin);
    t.samples = static_cast<Eigen::Index>(motion.known.end) - begin;
    if (t.samples < 100) return t;
    Eigen::MatrixXd S =
        difference_sensitivity<Physics>(t.tuned, in, limits, rate_Hz, tuned_parameters).middleRows(begin, t.samples);
    Eigen::VectorXd e = Eigen::VectorXd::Map(motion.force_near_N.data() + begin, t.samples) -
                        Eigen::VectorXd::Map(motion.force_far_N.data() + begin, t.samples);
    S.rowwise() -= S.colwise().mean().eval();
    e.array() -= e.mean();
    const double per_sample = (limits.pass_Hz + limits.stop_Hz) / rate_Hz,
                 mean_square = std::max(1e-24, e.squaredNorm() / static_cast<double>(t.samples)),
                 recorded_samples = static_cast<double>(recorded[0].size());
    t.information = S.transpose() * S * (per_sample / mean_square);
    t.equations.hessian = t.information + known;
    t.equations.gradient = -S.transpose() * e * (per_sample / mean_square) - known * moved;
    t.equations.cost = recorded_samples * per_sample * std::log(mean_square) + moved.dot(known * moved);
    return t;
  }
  [[nodiscard]] const normal_equations<double, 3>& linearise(const tuning& t) const { return t.equations; }
  [[nodiscard]] tuning moved(const tuning& t, const Eigen::Vector3d& by) const { return at(t.moved + by); }
  [[nodiscard]] bool plausible(const tuning& t) const { return t.samples >= 100; }
};

}  // namespace detail

/// Recorded forces (and motion of the ends) in nominal newtons, gains not yet taken out.
template <class Physics = full_physics>
[[nodiscard]] fine_tuning fine_tune(const calibration& from, const end_signals<double, Physics>& recorded, const band& limits,
                                    double rate_Hz, const drift_allowance& allowed = {}) {
  const auto& which = detail::tuned_parameters;
  const Eigen::Matrix3d plucked = from.covariance(which, which), prior = plucked + detail::allowed_covariance(from, allowed),
                        known = prior.inverse();
  const detail::tuning_problem<Physics> problem{from, recorded, limits, rate_Hz, known};
  const detail::tuning start = problem.at(Eigen::Vector3d::Zero());
  fine_tuning out{.tuned = from, .delta_before = start.delta, .delta_after = start.delta};
  out.tuned.covariance(which, which) = prior;
  if (!problem.plausible(start)) return out;
  // Without damping as long as that helps, up to a hundredth of a standard deviation.
  const auto found = levenberg_marquardt(
      problem, start,
      {.first = 0, .floor = 0, .restart = 1e-3, .iterations = 6, .enough = 1e-4, .enough_relative = 0, .negligible = 1e-4});
  const detail::tuning& end = found.at;
  out.tuned = end.tuned, out.shift = end.shift, out.delta_after = end.delta, out.iterations = found.iterations;
  out.tuned.covariance(which, which) = end.equations.hessian.inverse();
  const Eigen::Matrix3d from_data = (end.information + 1e-12 * known).inverse();
  out.sigmas = std::sqrt(std::max(0.0, end.moved.dot((plucked + from_data).inverse() * end.moved)));
  return out;
}

template <class Physics = full_physics>
[[nodiscard]] fine_tuning fine_tune(const calibration& from, std::span<const double> near_N, std::span<const double> far_N,
                                    const band& limits, double rate_Hz, const drift_allowance& allowed = {}) {
  return fine_tune<Physics>(from, end_signals<double, Physics>{near_N, far_N}, limits, rate_Hz, allowed);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
