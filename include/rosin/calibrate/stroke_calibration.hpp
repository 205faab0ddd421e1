// tier: hosted
// SPDX-License-Identifier: MIT
//
// A calibration, as reconstruction takes it, out of a fit of strokes: for the place and the tension of one take. Its loss is the law of
// the fit; what each mode loses on its own is in the fit's string (uneven_string.hpp), for reconstructions that take any propagation
// (reconstruct/whole_record.hpp).
//
#pragma once

#include <rosin/calibrate/calibration.hpp>
#include <rosin/calibrate/stroke_fit.hpp>

namespace rosin {

/// Waveform parameters by fitted parameters: 6 x size of the layout.
template <class Real = double>
[[nodiscard]] Eigen::MatrixXd waveform_jacobian(const stroke_fit_result& fit, std::size_t take) {
  using layout = stroke_layout;
  const uneven_string string = fit.string(take);
  const double f0 = string.fundamental_Hz, p = fit.position(take), one_way = 0.5 / f0;
  const Eigen::Index at = fit.layout.position(take), drift = fit.layout.drift(take);
  Eigen::MatrixX<Real> to = Eigen::MatrixX<Real>::Zero(waveform_parameters, fit.layout.size());
  for (const int end : {0, 1}) {
    const double delay = (end == 0 ? p : 1 - p) * one_way;
    to(end, at) = end == 0 ? one_way : -one_way;
    to(end, layout::fundamental) = -delay / fit.value[layout::fundamental];
    to(end, drift) = -delay;
  }
  to(2, layout::inharmonicity) =
      std::exp(-4 * fit.value[drift]) / std::pow(2 * std::numbers::pi * fit.value[layout::fundamental], 2);
  to(2, layout::fundamental) = -2 * string.stiffness_s2 / fit.value[layout::fundamental];
  to(2, drift) = -4 * string.stiffness_s2;
  to(3, layout::ln_inverse_quality) = 1 / string.loss.quality;
  to(4, layout::internal_loss) = 1;
  to(5, layout::ln_gain_ratio) = 1;
  return to;
}
ROSIN_INSTANTIATE(Eigen::MatrixXd waveform_jacobian(const stroke_fit_result&, std::size_t))

/// For one take. The scale of both gains stays nominal, with the relative standard deviation given.
template <class Real = double>
[[nodiscard]] calibration calibration_from(const stroke_fit_result& fit, std::size_t take, double impedance_Ns_m,
                                           double impedance_relative_sd, double scale_relative_sd) {
  calibration c;
  c.position = fit.position(take);
  c.at = fit.string(take).seen_from(c.position, impedance_Ns_m);
  const double half = fit.value[stroke_layout::ln_gain_ratio] / 2;
  c.gain = {std::exp(half), std::exp(-half)};
  c.noise_N = fit.noise.sensor_N;
  const Eigen::MatrixX<Real> to = waveform_jacobian(fit, take);
  c.covariance = to * fit.covariance * to.transpose();
  c.scale_relative_sd = scale_relative_sd, c.impedance_relative_sd = impedance_relative_sd;
  return c;
}
ROSIN_INSTANTIATE(calibration calibration_from(const stroke_fit_result&, std::size_t, double, double, double))

}  // namespace rosin
