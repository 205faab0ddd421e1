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

#include <numeric>
#include <span>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Columns: one waveform parameter each, then what else is uncertain (end_sensitivity.hpp). Rows: samples of the take.
struct reconstruction_sensitivity {
  Eigen::MatrixXd force, difference, velocity;
};

namespace detail {

/// Steps for central differences, in the units of the waveform parameters.
template <class = void>
[[nodiscard]] waveform_vector derivative_steps(const calibration& c) {
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

/// Kernels of the derivatives of some quantities (0: force, 1: difference, 2: velocity) by some parameters: rows (parameter,
/// quantity), columns as in end_signals: near and far.
template <class Physics, std::size_t Quantities>
[[nodiscard]] std::vector<fir> sensitivity_kernels(const calibration& c, const band& limits, double rate_Hz,
                                                   std::span<const Eigen::Index> parameters,
                                                   const std::array<std::size_t, Quantities>& quantities) {
  const waveform_vector step = detail::derivative_steps(c);
  const passage_lags lags = lags_of_passage(std::max(c.at.delay_s[0], c.at.delay_s[1]), c.at.stiffness_s2, limits, rate_Hz);
  std::vector<fir> kernels;
  for (const Eigen::Index p : parameters) {
    const bool is_gain = p == static_cast<Eigen::Index>(waveform_parameter::gain_ratio);
    waveform_vector by = waveform_vector::Zero();
    by[p] = step[p];
    const bow_point_transfer<Physics> above(c.moved(by).at, limits, rate_Hz), below(c.moved(-by).at, limits, rate_Hz);
    constexpr std::size_t inputs = bow_point_transfer<Physics>::inputs;
    const auto slopes = [&](double f) {
      const auto up = above(f), down = is_gain ? up : below(f);
      std::array<std::complex<double>, Quantities * inputs> out;
      for (std::size_t input = 0; input < inputs; ++input) {
        const auto more = detail::combine(up, input), less = detail::combine(down, input);
        for (std::size_t i = 0; i < Quantities; ++i) {
          const std::size_t q = quantities[i];
          out[i * inputs + input] = is_gain ? more[q] * (input % 2 == 0 ? -0.5 : 0.5) : (more[q] - less[q]) / (2 * step[p]);
        }
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
  std::array<Eigen::Index, waveform_parameters> all;
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  block_convolver<double> convolver(in.size(),
                                    sensitivity_kernels<Physics>(c, limits, rate_Hz, all, std::array<std::size_t, 3>{0, 1, 2}));
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

/// Of the difference of the two versions of the force alone, by some parameters: a column each.
template <class Physics>
[[nodiscard]] Eigen::MatrixXd difference_sensitivity(const calibration& c, const end_signals<double, Physics>& in,
                                                     const band& limits, double rate_Hz,
                                                     std::span<const Eigen::Index> parameters) {
  block_convolver<double> convolver(in.size(),
                                    sensitivity_kernels<Physics>(c, limits, rate_Hz, parameters, std::array<std::size_t, 1>{1}));
  const auto n = in[0].size();
  Eigen::MatrixXd out(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(parameters.size()));
  std::vector<std::span<double>> rows;
  for (Eigen::Index k = 0; k < out.cols(); ++k) rows.emplace_back(out.col(k).data(), n);
  convolver.process(in, rows);
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
