// tier: hosted
// SPDX-License-Identifier: MIT
//
// How a reconstruction answers to the modes of its terminations: further columns beside those of the waveform parameters
// (sensitivity.hpp), d/d ln f, d/d ln Q, d/d ln(Z/M) of each mode. The motion of the end is differentiated and sent through the
// kernels that its motion takes. With the joint covariance of a fit (end_fit.hpp) error bars grow where the terminations are
// uncertain.
//
#pragma once

#include <rosin/reconstruct/end_motion.hpp>
#include <rosin/reconstruct/sensitivity.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One mode, and the end that it belongs to: 0 near, 1 far.
struct mode_of_end {
  std::size_t end = 0;
  admittance_mode mode;
};

namespace detail {

/// Motion's derivative by parameter 0: ln f, 1: ln Q, 2: ln(Z/M).
[[nodiscard]] inline std::vector<double> motion_slope(const admittance_mode& mode, int parameter, std::span<const double> force_N,
                                                      const band& limits, double rate_Hz) {
  if (parameter == 2) return motion_of_end(modal_termination{{mode}}, force_N, limits, rate_Hz).times_impedance_N;
  const double step = parameter == 0 ? 1e-3 / mode.q : 1e-2;
  admittance_mode up = mode, down = mode;
  double& more = parameter == 0 ? up.frequency_Hz : up.q;
  double& less = parameter == 0 ? down.frequency_Hz : down.q;
  more *= std::exp(step), less *= std::exp(-step);
  std::vector<double> slope = motion_of_end(modal_termination{{up}}, force_N, limits, rate_Hz).times_impedance_N;
  const std::vector<double> below = motion_of_end(modal_termination{{down}}, force_N, limits, rate_Hz).times_impedance_N;
  for (std::size_t n = 0; n < slope.size(); ++n) slope[n] = (slope[n] - below[n]) / (2 * step);
  return slope;
}

/// Force, difference and velocity from the motion of one end.
template <class Physics>
[[nodiscard]] std::vector<fir> kernels_of_motion(const bow_point& at, std::size_t end, const band& limits, double rate_Hz) {
  const bow_point_transfer<Physics> transfer(at, limits, rate_Hz);
  const passage_lags lags = lags_of_passage(std::max(at.delay_s[0], at.delay_s[1]), at.stiffness_s2, limits, rate_Hz);
  const auto kernels =
      sample_responses([&](double f) { return combine(transfer(f), 2 + end); }, limits, rate_Hz, -lags.last, lags.last);
  return {kernels.begin(), kernels.end()};
}

}  // namespace detail

/// Appends three columns for each mode. `in`: the signals that the reconstruction had.
template <class Physics>
requires(Physics::moving_ends) void append_end_sensitivity(reconstruction_sensitivity& s, const bow_point& at,
                                                           std::span<const mode_of_end> modes,
                                                           const end_signals<double, Physics>& in, const band& limits,
                                                           double rate_Hz) {
  const Eigen::Index first = s.force.cols(), n = s.force.rows();
  for (auto* part : {&s.force, &s.difference, &s.velocity})
    part->conservativeResize(n, first + 3 * static_cast<Eigen::Index>(modes.size()));
  std::array<block_convolver<double>, 2> through{
      block_convolver<double>(1, detail::kernels_of_motion<Physics>(at, 0, limits, rate_Hz)),
      block_convolver<double>(1, detail::kernels_of_motion<Physics>(at, 1, limits, rate_Hz))};
  for (std::size_t k = 0; k < modes.size(); ++k)
    for (int parameter = 0; parameter < 3; ++parameter) {
      const std::vector<double> slope = detail::motion_slope(modes[k].mode, parameter, in[modes[k].end], limits, rate_Hz);
      const Eigen::Index column = first + 3 * static_cast<Eigen::Index>(k) + parameter;
      std::array<std::span<double>, 3> out;
      for (std::size_t q = 0; auto* part : {&s.force, &s.difference, &s.velocity})
        out[q++] = {part->col(column).data(), static_cast<std::size_t>(n)};
      const std::array<std::span<const double>, 1> one{slope};
      through[modes[k].end].process(one, out);
    }
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
