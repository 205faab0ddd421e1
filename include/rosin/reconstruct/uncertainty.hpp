// tier: hosted
// SPDX-License-Identifier: MIT
//
// One standard deviation of force and velocity, sample by sample, from four sources that do not know of each other:
//
//     var f(t) = sum_j noise_j^2 sum_n h_j[n]^2            sensor noise through the kernels
//              + s(t)' C s(t)                              the calibration's covariance, s = d f / d theta
//              + max(0, var(f_near - f_far) - expected)/4  what the two versions differ by beyond both
//              + var(f) / (2 Q)^2                          what conventions of damping differ in: neither version shows it
//
// These are random: they change the waveform. The common scale (strength of the wires, impedance) is systematic and is kept
// apart as a relative standard deviation.
//
#pragma once

#include <rosin/reconstruct/sensitivity.hpp>

#include <cmath>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Standard deviations of a reconstruction; vectors are as long as the take.
struct reconstruction_uncertainty {
  std::vector<double> force_sd_N, velocity_sd_m_s;
  double force_noise_N = 0, velocity_noise_m_s = 0;  ///< from sensor noise alone
  double force_model_N = 0, velocity_model_m_s = 0;  ///< from what the two versions disagree in, and the convention of damping
  double force_scale = 0, velocity_scale = 0;        ///< systematic, relative
};

namespace detail {

/// Taps of a weighted sum of the four outputs' kernels from one input.
template <class Real = double>
[[nodiscard]] Eigen::VectorXd combined_taps(const std::vector<fir>& kernels, const std::array<double, 4>& weight,
                                            std::size_t input) {
  const std::size_t inputs = kernels.size() / 4;
  int first = 0, last = 0;
  for (std::size_t p = 0; p < 4; ++p) {
    first = std::min(first, kernels[inputs * p + input].first);
    last = std::max(last, kernels[inputs * p + input].last());
  }
  Eigen::VectorX<Real> sum = Eigen::VectorX<Real>::Zero(last - first + 1);
  for (std::size_t p = 0; p < 4; ++p) {
    const fir& k = kernels[inputs * p + input];
    const auto count = static_cast<Eigen::Index>(k.taps.size());
    sum.segment(k.first - first, count) += weight[p] * Eigen::VectorX<Real>::Map(k.taps.data(), count);
  }
  return sum;
}

/// Standard deviation of a weighted sum of the outputs for white noise in both inputs.
template <class = void>
[[nodiscard]] double noise_through(const std::vector<fir>& kernels, const std::array<double, 4>& weight,
                                   const std::array<double, 2>& noise) {
  return std::hypot(noise[0] * combined_taps(kernels, weight, 0).norm(), noise[1] * combined_taps(kernels, weight, 1).norm());
}

/// rms over the known samples of a + sign b, mean aside.
[[nodiscard]] inline double rms_of(const std::vector<double>& a, double sign, const std::vector<double>& b, sample_range known) {
  double power = 0, mean = 0;
  const double count = std::max<double>(1, static_cast<double>(known.end - known.begin));
  for (std::size_t i = known.begin; i < known.end; ++i) {
    const double x = a[i] + sign * b[i];
    power += x * x;
    mean += x;
  }
  return std::sqrt(std::max(0.0, power / count - (mean / count) * (mean / count)));
}

}  // namespace detail

/// `noise_N`: of the calibrated channels. `motion` is what the reconstructor made of the same take. `covariance`: of the columns
/// of `s`; empty: the calibration's.
template <class Physics = full_physics>
[[nodiscard]] reconstruction_uncertainty uncertainty(const calibration& c, const bow_motion<double>& motion,
                                                     const reconstruction_sensitivity& s, const std::array<double, 2>& noise_N,
                                                     const band& limits, double rate_Hz, const Eigen::MatrixXd& covariance = {}) {
  const Eigen::MatrixXd C = covariance.size() > 0 ? covariance : Eigen::MatrixXd(c.covariance);
  const std::vector<fir> kernels = bow_point_kernels<Physics>(c.at, limits, rate_Hz, 1e-4);
  reconstruction_uncertainty out;
  out.force_noise_N = detail::noise_through(kernels, {0.5, 0.5, 0, 0}, noise_N);
  out.velocity_noise_m_s = detail::noise_through(kernels, {0, 0, 0.5, 0.5}, noise_N);
  out.force_scale = c.scale_relative_sd;
  out.velocity_scale = std::hypot(c.scale_relative_sd, c.impedance_relative_sd);

  const Eigen::VectorXd of_force = (s.force * C).cwiseProduct(s.force).rowwise().sum();
  const Eigen::VectorXd of_velocity = (s.velocity * C).cwiseProduct(s.velocity).rowwise().sum();
  const auto known = [&](const Eigen::VectorXd& v) {
    return v
        .segment(static_cast<Eigen::Index>(motion.known.begin), static_cast<Eigen::Index>(motion.known.end - motion.known.begin))
        .mean();
  };
  const Eigen::VectorXd of_difference = (s.difference * C).cwiseProduct(s.difference).rowwise().sum();
  const double seen = detail::rms_of(motion.force_near_N, -1, motion.force_far_N, motion.known);
  const double noise = detail::noise_through(kernels, {1, -1, 0, 0}, noise_N);
  if (motion.known.end > motion.known.begin) {
    // Half of what the versions differ by beyond noise and calibration: each is wrong by about that, either way.
    out.force_model_N = 0.5 * std::sqrt(std::max(0.0, seen * seen - noise * noise - known(of_difference)));
    const double seen_v = detail::rms_of(motion.velocity_near_m_s, -1, motion.velocity_far_m_s, motion.known);
    out.velocity_model_m_s = seen > 0 ? out.force_model_N * seen_v / seen : 0.0;
    const double turn = c.at.loss.inverse_q(0.5 / (c.at.delay_s[0] + c.at.delay_s[1])) / 2;
    out.force_model_N =
        std::hypot(out.force_model_N, turn / 2 * detail::rms_of(motion.force_near_N, 1, motion.force_far_N, motion.known));
    out.velocity_model_m_s = std::hypot(
        out.velocity_model_m_s, turn / 2 * detail::rms_of(motion.velocity_near_m_s, 1, motion.velocity_far_m_s, motion.known));
  }
  const auto n = static_cast<std::size_t>(of_force.size());
  out.force_sd_N.resize(n);
  out.velocity_sd_m_s.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    out.force_sd_N[i] =
        std::sqrt(out.force_noise_N * out.force_noise_N + out.force_model_N * out.force_model_N + std::max(0.0, of_force[k]));
    out.velocity_sd_m_s[i] = std::sqrt(out.velocity_noise_m_s * out.velocity_noise_m_s +
                                       out.velocity_model_m_s * out.velocity_model_m_s + std::max(0.0, of_velocity[k]));
  }
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
