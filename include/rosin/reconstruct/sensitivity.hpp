// tier: hosted
// SPDX-License-Identifier: MIT
//
// How a reconstruction answers to the calibration: d/d theta of force, of the difference of its two versions, and of velocity,
// sample by sample, for each waveform parameter. Transfer functions are differentiated, not records; the gain's derivative is
// exact: half of it divides one channel, half multiplies the other.
//
#pragma once

#include <rosin/calibrate/calibration.hpp>
#include <rosin/reconstruct/reconstructor.hpp>

#include <Eigen/Core>

namespace rosin {

/// Columns: one waveform parameter each, then what else is uncertain (end_sensitivity.hpp). Rows: samples of the take.
struct reconstruction_sensitivity {
  Eigen::MatrixXd force, difference, velocity;
};

namespace detail {

/// Steps for central differences, in the units of the waveform parameters.
[[nodiscard]] inline waveform_vector derivative_steps(const calibration& c) {
  const double longest = std::max(c.at.delay_s[0], c.at.delay_s[1]);
  waveform_vector step;
  step << 1e-5 * longest, 1e-5 * longest, std::max(1e-4 * c.at.stiffness_s2, 1e-18), 1e-6, 1e-12, 0;
  return step;
}

/// force, difference, velocity from the four outputs of the transfer: for one input column of `Inputs`.
template <std::size_t Size, std::size_t Inputs = Size / 4>
[[nodiscard]] std::array<std::complex<double>, 3> combine(const std::array<std::complex<double>, Size>& h, std::size_t input) {
  return {(h[input] + h[Inputs + input]) / 2.0, h[input] - h[Inputs + input],
          (h[2 * Inputs + input] + h[3 * Inputs + input]) / 2.0};
}

}  // namespace detail

/// Kernels of the derivatives: rows (parameter, quantity), columns as in end_signals: near and far.
template <class Physics>
[[nodiscard]] std::vector<fir> sensitivity_kernels(const calibration& c, const band& limits, double rate_Hz) {
  const waveform_vector step = detail::derivative_steps(c);
  const passage_lags lags = lags_of_passage(std::max(c.at.delay_s[0], c.at.delay_s[1]), c.at.stiffness_s2, limits, rate_Hz);
  std::vector<fir> kernels;
  for (int p = 0; p < waveform_parameters; ++p) {
    const bool is_gain = p == static_cast<int>(waveform_parameter::gain_ratio);
    waveform_vector by = waveform_vector::Zero();
    by[p] = step[p];
    const bow_point_transfer<Physics> above(c.moved(by).at, limits, rate_Hz), below(c.moved(-by).at, limits, rate_Hz);
    constexpr std::size_t inputs = bow_point_transfer<Physics>::inputs;
    const auto slopes = [&](double f) {
      const auto up = above(f), down = below(f);
      std::array<std::complex<double>, 3 * inputs> out;
      for (std::size_t input = 0; input < inputs; ++input) {
        const auto more = detail::combine(up, input), less = detail::combine(down, input);
        for (std::size_t quantity = 0; quantity < 3; ++quantity)
          out[quantity * inputs + input] =
              is_gain ? more[quantity] * (input % 2 == 0 ? -0.5 : 0.5) : (more[quantity] - less[quantity]) / (2 * step[p]);
      }
      return out;
    };
    const auto made = sample_responses(slopes, limits, rate_Hz, -lags.last, lags.last);
    kernels.insert(kernels.end(), made.begin(), made.end());
  }
  return kernels;
}

/// Sensitivities over a take of calibrated forces (newtons), equally long. Samples near the ends count what lies beyond as zero.
template <class Physics = full_physics>
[[nodiscard]] reconstruction_sensitivity sensitivity(const calibration& c, const end_signals<double, Physics>& in,
                                                     const band& limits, double rate_Hz) {
  const std::size_t n = in[0].size();
  block_convolver<double> convolver(in.size(), sensitivity_kernels<Physics>(c, limits, rate_Hz));
  reconstruction_sensitivity out;
  for (auto* part : {&out.force, &out.difference, &out.velocity}) part->resize(static_cast<Eigen::Index>(n), waveform_parameters);
  std::vector<std::span<double>> rows;
  for (int p = 0; p < waveform_parameters; ++p)
    for (auto* part : {&out.force, &out.difference, &out.velocity}) rows.emplace_back(part->col(p).data(), n);
  convolver.process(in, rows);
  return out;
}
template <class Physics = full_physics>
[[nodiscard]] reconstruction_sensitivity sensitivity(const calibration& c, std::span<const double> near_N,
                                                     std::span<const double> far_N, const band& limits, double rate_Hz) {
  return sensitivity<Physics>(c, end_signals<double, Physics>{near_N, far_N}, limits, rate_Hz);
}

}  // namespace rosin
