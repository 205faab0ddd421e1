// tier: hosted
// SPDX-License-Identifier: MIT
//
// What plucks leave behind for the reconstruction of everything else that this rig records: the string as seen from the contact,
// the gains, and how sure of them one may be. Errors come in two kinds and are kept apart:
//
//   random      delays, dispersion, loss and the ratio of the gains: they change the waveform;
//   systematic  one common factor, the wires' strength against the converters' newtons: it scales everything.
//
#pragma once

#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/propagate/bow_point.hpp>

#include <Eigen/Core>

#include <array>
#include <cmath>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What the waveform of a reconstruction depends on. Order of all vectors and matrices that bear this name.
enum class waveform_parameter { delay_near, delay_far, stiffness, inverse_quality, internal_loss, gain_ratio, count };
inline constexpr int waveform_parameters = static_cast<int>(waveform_parameter::count);
using waveform_vector = Eigen::Matrix<double, waveform_parameters, 1>;
using waveform_matrix = Eigen::Matrix<double, waveform_parameters, waveform_parameters>;

/// A calibrated rig, for one position of the contact.
struct calibration {
  bow_point at;
  double position = 0;                    ///< fraction of the length from the near end
  std::array<double, 2> gain{1, 1};       ///< recorded / true, near and far
  std::array<double, 2> noise_N{};        ///< white noise of the sensors, rms up to half the sampling rate
  std::array<double, 2> ac_coupled_Hz{};  ///< 0: DC coupled
  /// of delays (s), epsilon (s^2), 1/Q, loss (s), ln(gain near / gain far)
  waveform_matrix covariance = waveform_matrix::Zero();
  double scale_relative_sd = 0;      ///< of the common factor of both gains
  double impedance_relative_sd = 0;  ///< scales the velocity, besides

  /// The same with the waveform parameters moved by `by`.
  [[nodiscard]] calibration moved(const waveform_vector& by) const {
    calibration c = *this;
    c.at.delay_s[0] += by[0];
    c.at.delay_s[1] += by[1];
    c.at.stiffness_s2 += by[2];
    c.at.loss.quality = 1 / (1 / c.at.loss.quality + by[3]);
    c.at.loss.internal_s += by[4];
    c.gain[0] *= std::exp(by[5] / 2);
    c.gain[1] *= std::exp(-by[5] / 2);
    return c;
  }
};

namespace detail {

/// The take whose declared position is nearest.
[[nodiscard]] inline std::size_t take_nearest(const pluck_fit_result& fit, double declared) {
  std::size_t take = 0;
  for (std::size_t t = 1; t < fit.layout.takes(); ++t) {
    const auto apart = [&](std::size_t i) { return std::abs(fit.layout.declared_position(i) - declared); };
    if (apart(t) < apart(take)) take = t;
  }
  return take;
}

}  // namespace detail

/// Waveform parameters by fitted parameters: 6 x size of the layout, for the position nearest to `declared`.
template <class Real = double>
[[nodiscard]] Eigen::MatrixXd waveform_jacobian(const pluck_fit_result& fit, double declared) {
  using layout = pluck_layout;
  const Eigen::Index at = fit.layout.position(detail::take_nearest(fit, declared));
  const double f0 = fit.value[layout::fundamental], p = fit.value[at], one_way = 0.5 / f0;
  Eigen::MatrixX<Real> to = Eigen::MatrixX<Real>::Zero(waveform_parameters, fit.layout.size());
  to(0, at) = one_way;
  to(0, layout::fundamental) = -p * one_way / f0;
  to(1, at) = -one_way;
  to(1, layout::fundamental) = -(1 - p) * one_way / f0;
  to(2, layout::inharmonicity) = std::pow(2 * std::numbers::pi * f0, -2);
  to(2, layout::fundamental) = -2 * fit.string().stiffness_s2() / f0;
  to(3, layout::inverse_quality) = 1;
  to(4, layout::internal_loss) = 1;
  to(5, layout::gain_near) = 1;
  to(5, layout::gain_far) = -1;
  return to;
}
ROSIN_INSTANTIATE(Eigen::MatrixXd waveform_jacobian(const pluck_fit_result&, double))

/// Reads a calibration out of a fit of plucks, for the fitted position whose declared value is nearest to `declared`.
/// impedance_Ns_m and its relative sd come from the rig: forces alone cannot tell them.
template <class Real = double>
[[nodiscard]] calibration calibration_from(const pluck_fit_result& fit, double declared, double impedance_Ns_m,
                                           double impedance_relative_sd, std::array<double, 2> ac_coupled_Hz = {}) {
  using layout = pluck_layout;
  const Eigen::Index at = fit.layout.position(detail::take_nearest(fit, declared));
  const double f0 = fit.value[layout::fundamental], p = fit.value[at];
  const ringing_string string = fit.string();

  calibration c;
  c.at = {{p / (2 * f0), (1 - p) / (2 * f0)}, string.stiffness_s2(), string.loss, impedance_Ns_m};
  c.position = p;
  c.gain = {std::exp(fit.value[layout::gain_near]), std::exp(fit.value[layout::gain_far])};
  c.noise_N = fit.noise_N;
  c.ac_coupled_Hz = ac_coupled_Hz;
  c.impedance_relative_sd = impedance_relative_sd;

  const Eigen::MatrixX<Real> to = waveform_jacobian(fit, declared);
  c.covariance = to * fit.covariance * to.transpose();
  Eigen::VectorX<Real> common = Eigen::VectorX<Real>::Zero(fit.layout.size());
  common[layout::gain_near] = common[layout::gain_far] = 0.5;
  c.scale_relative_sd = std::sqrt(std::max(0.0, common.dot(fit.covariance * common)));
  return c;
}
ROSIN_INSTANTIATE(calibration calibration_from(const pluck_fit_result&, double, double, double, std::array<double, 2>))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
