// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a length of string does to a wave that passes: D(f) = exp(-gamma x), gamma x = tau (i q(w) + |w| c / (2 Q c_g)),
// with tau the travel time at low frequency. Its inverse advances, undoes the dispersion and, if asked to, gives back what
// was lost. Modal Q is a rate in time, so a path costs exp(-w x / (2 Q c_g)): the group velocity, not the phase velocity
// (checked against modal decay in the tests).
//
#pragma once

#include <rosin/propagate/dispersion.hpp>
#include <rosin/propagate/fir.hpp>
#include <rosin/propagate/string_parameters.hpp>

#include <complex>
#include <numbers>

namespace rosin {

/// gamma c in 1/s: complex rate of phase and loss per second of travel.
[[nodiscard]] inline std::complex<double> propagation_rate(double frequency_Hz, double stiffness_s2, const loss_law& loss) {
  const double w = 2 * std::numbers::pi * frequency_Hz, slow = slowness_ratio(w, stiffness_s2);
  return {w * loss.inverse_q(frequency_Hz) / 2 * slow, phase_rate(w, stiffness_s2) + w * slow * loss.lead(frequency_Hz)};
}

/// One passage of travel time `delay_s` (s, >= 0).
struct transmission {
  double delay_s = 0;
  double stiffness_s2 = 0;
  loss_law loss{};

  [[nodiscard]] std::complex<double> operator()(double frequency_Hz) const {
    return std::exp(-delay_s * propagation_rate(frequency_Hz, stiffness_s2, loss));
  }
};

/// The way back in time: 1 / D, loss compensated. With a lossless `loss` it is the paper's time reversal of Eqs. (9b, d).
struct inverse_transmission {
  double delay_s = 0;
  double stiffness_s2 = 0;
  loss_law loss{};

  [[nodiscard]] std::complex<double> operator()(double frequency_Hz) const {
    return std::exp(delay_s * propagation_rate(frequency_Hz, stiffness_s2, loss));
  }
};

/// Earliest and latest lag (samples) that can hold the response of a passage within `limits`: energy arrives between the
/// group delay of the highest frequency and that of the lowest, and the band's window rings a little around both.
struct passage_lags {
  int first, last;
};
[[nodiscard]] inline passage_lags lags_of_passage(double delay_s, double stiffness_s2, const band& limits, double rate_Hz) {
  const double fastest = slowness_ratio(2 * std::numbers::pi * limits.stop_Hz, stiffness_s2);
  const double ringing = 20 * rate_Hz / (limits.stop_Hz - limits.pass_Hz) + 24;
  return {static_cast<int>(std::floor(delay_s * rate_Hz * fastest - ringing)),
          static_cast<int>(std::ceil(delay_s * rate_Hz + ringing))};
}

/// Exact-phase transmission kernel: the shortest with the error asked for (1e-2 ... 1e-7 without loss). With loss |w| has a
/// corner at 0 Hz, whose tails tau / (2 Q) / (pi t^2) set a floor of about 1e-4 at 0 Hz for a long path at Q = 300; it falls as
/// 1/Q.
[[nodiscard]] inline fir transmission_kernel(const transmission& path, const band& limits, double rate_Hz, double error) {
  const passage_lags lags = lags_of_passage(path.delay_s, path.stiffness_s2, limits, rate_Hz);
  return shortest_fir(path, limits, rate_Hz, lags.first, lags.last, error);
}

/// Its inverse; anticausal. Without loss it is the transmission kernel reversed in time.
[[nodiscard]] inline fir transmission_kernel(const inverse_transmission& path, const band& limits, double rate_Hz, double error) {
  const passage_lags lags = lags_of_passage(path.delay_s, path.stiffness_s2, limits, rate_Hz);
  return shortest_fir(path, limits, rate_Hz, -lags.last, -lags.first, error);
}

/// The same taps with time running backwards: the inverse of an all-pass kernel.
[[nodiscard]] inline fir time_reversed(fir kernel) {
  kernel.first = -kernel.last();
  std::reverse(kernel.taps.begin(), kernel.taps.end());
  return kernel;
}

}  // namespace rosin
