// tier: hosted
// SPDX-License-Identifier: MIT
//
// The paper's fine tuning (section III A): the two delays and the relative gain are moved a little, take by take, so that the two
// versions of the force differ least. Between the plucks and the stroke the tension may have drifted and the rod may touch a
// little beside the wire; how far that can go is stated (`allowed`) and weighed against what the plucks say, so that a search
// that finds nothing changes nothing. Gauss-Newton, since the difference is all but linear in the three.
//
//     minimise  |e - S d|^2 / noise^2 + d' (C + allowed^2)^-1 d,    e = f_near - f_far
//
#pragma once

#include <rosin/reconstruct/consistency.hpp>
#include <rosin/reconstruct/sensitivity.hpp>

#include <Eigen/Dense>

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

}  // namespace detail

/// Recorded forces (and motion of the ends) in nominal newtons, gains not yet taken out.
template <class Physics = full_physics>
[[nodiscard]] fine_tuning fine_tune(const calibration& from, const end_signals<double, Physics>& recorded, const band& limits,
                                    double rate_Hz, const drift_allowance& allowed = {}) {
  fine_tuning out{from};
  const auto& which = detail::tuned_parameters;
  const Eigen::Matrix3d plucked = from.covariance(which, which), prior = plucked + detail::allowed_covariance(from, allowed);
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  Eigen::Matrix3d posterior = prior, from_data = prior;

  for (out.iterations = 0; out.iterations < 6; ++out.iterations) {
    const auto force = detail::calibrated(out.tuned, recorded);
    const auto in = detail::views_of(force);
    const bow_motion<double> motion = reconstructor<double, Physics>(out.tuned.at, limits, rate_Hz, 1e-4)(in);
    const double delta = consistency_delta(motion.force_near_N, motion.force_far_N);
    if (out.iterations == 0) out.delta_before = delta;
    out.delta_after = delta;
    const auto begin = static_cast<Eigen::Index>(motion.known.begin), count = static_cast<Eigen::Index>(motion.known.end) - begin;
    if (count < 100) break;
    Eigen::MatrixXd S = difference_sensitivity<Physics>(out.tuned, in, limits, rate_Hz, which).middleRows(begin, count);
    Eigen::VectorXd e = Eigen::VectorXd::Map(motion.force_near_N.data() + begin, count) -
                        Eigen::VectorXd::Map(motion.force_far_N.data() + begin, count);
    S.rowwise() -= S.colwise().mean().eval();
    e.array() -= e.mean();
    const double white =
        std::max(1e-24, e.squaredNorm() / static_cast<double>(count)) * rate_Hz / (limits.pass_Hz + limits.stop_Hz);
    const Eigen::Matrix3d information = S.transpose() * S / white;
    posterior = (information + prior.inverse()).inverse();
    const Eigen::Vector3d step = posterior * (-S.transpose() * e / white - prior.inverse() * moved);
    if (!step.allFinite()) break;
    moved += step;
    from_data = (information + 1e-12 * prior.inverse()).inverse();
    out.shift = waveform_vector::Zero();
    for (std::size_t i = 0; i < 3; ++i) out.shift[which[i]] = moved[static_cast<Eigen::Index>(i)];
    out.tuned = from.moved(out.shift);
    if (step.dot(posterior.inverse() * step) < 1e-4) break;
  }
  out.tuned.covariance(which, which) = posterior;
  out.sigmas = std::sqrt(std::max(0.0, moved.dot((plucked + from_data).inverse() * moved)));
  return out;
}

template <class Physics = full_physics>
[[nodiscard]] fine_tuning fine_tune(const calibration& from, std::span<const double> near_N, std::span<const double> far_N,
                                    const band& limits, double rate_Hz, const drift_allowance& allowed = {}) {
  return fine_tune<Physics>(from, end_signals<double, Physics>{near_N, far_N}, limits, rate_Hz, allowed);
}

}  // namespace rosin
