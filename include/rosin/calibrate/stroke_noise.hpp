// tier: hosted
// SPDX-License-Identifier: MIT
//
// Noise of both channels from what a fit of strokes leaves. In each bin the mismatch e of the two ends is Gaussian with the power
//
//     E |e|^2 = s_1^2 a + s_2^2 b + d^2 c,    a, b = |sinh(g_j)|^2,   c = what the signal itself has there,
//
// and a and b have their zeros and their peaks at other frequencies, so that both channels' noise is told apart; c is large at the
// partials only. By maximum likelihood: regression of |e|^2 with weights E |e|^2 ^ -2, to and fro (Fisher's scoring).
//
#pragma once

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Noise of the recorded channels, rms over all samples, and the relative error of the model.
struct stroke_noise {
  std::array<double, 2> sensor_N{1e-3, 1e-3};
  double model = 1e-3;
};

/// What is left of each bin of a take, |e|^2, and what a newton of noise in either channel, and the signal, would leave.
struct stroke_leftover {
  std::vector<double> power, near, far, signal;
  double independence = 1;  ///< of the bins: information over their number

  [[nodiscard]] double expected(std::size_t k, const stroke_noise& n) const noexcept {
    return n.sensor_N[0] * n.sensor_N[0] * near[k] + n.sensor_N[1] * n.sensor_N[1] * far[k] + n.model * n.model * signal[k];
  }
  /// Power against what is expected, mean over the bins.
  [[nodiscard]] double misfit(const stroke_noise& n) const noexcept {
    double sum = 0;
    for (std::size_t k = 0; k < power.size(); ++k) sum += power[k] / expected(k, n);
    return power.empty() ? 0.0 : sum / static_cast<double>(power.size());
  }
  [[nodiscard]] double independent_bins() const noexcept { return independence * static_cast<double>(power.size()); }
};

/// Over all takes; `least_model`: d is no less.
template <class Real = double>
[[nodiscard]] stroke_noise estimate_noise(const std::vector<stroke_leftover>& takes, stroke_noise from,
                                          double least_model = 1e-6) {
  for (int pass = 0; pass < 12; ++pass) {
    Eigen::Matrix<Real, 3, 3> H = Eigen::Matrix<Real, 3, 3>::Zero();
    Eigen::Vector<Real, 3> g = Eigen::Vector<Real, 3>::Zero();
    for (const stroke_leftover& take : takes)
      for (std::size_t k = 0; k < take.power.size(); ++k) {
        const Eigen::Vector<Real, 3> row =
            Eigen::Vector<Real, 3>(take.near[k], take.far[k], take.signal[k]) / take.expected(k, from);
        H += row * row.transpose(), g += row * (take.power[k] / take.expected(k, from));
      }
    const Eigen::Vector<Real, 3> unit = H.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::Vector<Real, 3> found =
        unit.cwiseProduct((unit.asDiagonal() * H * unit.asDiagonal()).eval().ldlt().solve(unit.cwiseProduct(g)));
    const auto next = [](Real square, Real before, Real least) {  // no more than to a third at a time, for it must stay above 0
      return std::max(std::sqrt(std::max(square, before * before / 9)), least);
    };
    from.sensor_N = {next(found[0], from.sensor_N[0], 1e-9), next(found[1], from.sensor_N[1], 1e-9)};
    from.model = next(found[2], from.model, least_model);
  }
  return from;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
