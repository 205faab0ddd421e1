// tier: hosted
// SPDX-License-Identifier: MIT
//
// A stiff string each of whose modes loses on its own. Measured strings do not keep to a smooth law: 1/Q of the first modes of 40
// strings is off any of them by 18 % rms in the median. What a law leaves is told mode by mode,
//
//     1/Q(f) = law(f) exp(-u(nu)),    nu(f) = q(w) / (2 pi f0)    (nu = n at the n-th mode between pinned ends),
//
// u straight from one mode to the next. So a passage of travel time tau costs what its modes lose, and near each mode, where the
// loss decides, 1/Q is that mode's own. Between the modes a string of such modes differs from this by terms in the square of 1/Q.
//
#pragma once

#include <rosin/propagate/bow_point.hpp>
#include <rosin/propagate/dispersion.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct uneven_string {
  double fundamental_Hz = 0;  ///< c / (2 L)
  double stiffness_s2 = 0;    ///< epsilon = B m / T^2
  loss_law loss{};
  std::vector<double> ln_own_q{};  ///< u of the modes 1, 2, ...: ln of Q over the law's; the last one goes on

  [[nodiscard]] double partial_Hz(int n) const noexcept {
    const double q = 2 * std::numbers::pi * n * fundamental_Hz;
    return n * fundamental_Hz * std::sqrt(1 + stiffness_s2 * q * q);
  }

  /// Between which modes a frequency lies: u there is (1 - share) u[mode] + share u[mode + 1], counted from 0.
  struct place {
    std::size_t mode = 0;
    double share = 0;
  };
  [[nodiscard]] place place_of(double phase_rate_1_s) const noexcept {
    const double last = static_cast<double>(ln_own_q.size()) - 1;
    const double nu = std::clamp(std::abs(phase_rate_1_s) / (2 * std::numbers::pi * fundamental_Hz) - 1, 0.0, last);
    const double whole = std::min(std::floor(nu), std::max(0.0, last - 1));
    return {static_cast<std::size_t>(whole), nu - whole};
  }
  [[nodiscard]] double inverse_q(double frequency_Hz) const noexcept {
    const double law = loss.inverse_q(frequency_Hz);
    if (ln_own_q.size() < 2) return ln_own_q.empty() ? law : law * std::exp(-ln_own_q[0]);
    const place p = place_of(phase_rate(2 * std::numbers::pi * frequency_Hz, stiffness_s2));
    return law * std::exp(-(1 - p.share) * ln_own_q[p.mode] - p.share * ln_own_q[p.mode + 1]);
  }

  /// gamma c in 1/s, as propagation_rate() has it for a loss that keeps to its law.
  [[nodiscard]] std::complex<double> propagation_rate(double frequency_Hz) const noexcept {
    const double w = 2 * std::numbers::pi * frequency_Hz, slow = slowness_ratio(w, stiffness_s2);
    return {w * inverse_q(frequency_Hz) / 2 * slow, phase_rate(w, stiffness_s2) + w * slow * loss.lead(frequency_Hz)};
  }

  /// The same string with a smooth loss, as seen from a contact.
  [[nodiscard]] bow_point seen_from(double position, double impedance_Ns_m) const noexcept {
    const double one_way = 0.5 / fundamental_Hz;
    return {{position * one_way, (1 - position) * one_way}, stiffness_s2, loss, impedance_Ns_m};
  }
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
