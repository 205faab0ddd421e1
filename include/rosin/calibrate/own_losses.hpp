// tier: hosted
// SPDX-License-Identifier: MIT
//
// Modes of a real string lose unevenly: their 1/Q is off every smooth law by 9 to 38 % (violin, viola and cello strings whose modal
// decays are public), on rigid ends by less, but not by some hundredths. What each mode has of its own is a nuisance,
//
//     ln 1/Q_n = ln 1/Q(f_n; law) + d_n,     d_n ~ N(0, s^2),
//
// and the data set s: with d_n at its best and of variance v_n, given s, the evidence is highest where (MacKay 1992)
//
//     s^2 = sum d_n^2 / sum (1 - v_n / s^2),     -2 ln(evidence) = cost + sum d_n^2 / s^2 + sum ln(s^2 / v_n).
//
// A line keeps its |s|, as a damped mode does, so that what it loses more also makes it slower, in second order. s = 0 is the law itself:
// then nothing here is free. A line belongs to the mode whose frequency is next to it.
//
#pragma once

#include <rosin/calibrate/pluck_model.hpp>
#include <rosin/core/finite_math.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

class own_losses {
public:
  /// `own`: d_1, d_2, ...
  own_losses(const ringing_string& string, Eigen::VectorXd own) : string_{string}, own_{std::move(own)} {}

  /// Of a string with things on it or ends that yield: these are its lines, one a mode in order of frequency.
  void follow(const std::vector<damped_line>& lines) {
    at_rad_s_.clear();
    for (const damped_line& line : lines)
      if (line.pole.imag() > 0) at_rad_s_.push_back(line.pole.imag());
    std::sort(at_rad_s_.begin(), at_rad_s_.end());
  }
  /// The mode whose line this is, from 1; 0: none that has a loss of its own, or one beside which the string's loss is little.
  [[nodiscard]] int mode_of(std::complex<double> pole) const {
    constexpr double little = 20;
    const double spacing = 2 * std::numbers::pi * string_.fundamental_Hz;
    if (!(pole.imag() > 0) || -pole.real() > little * half_loss(pole) * pole.imag()) return 0;
    double n = 0;
    if (at_rad_s_.empty()) {
      const double f = pole.imag() / spacing, x = f * f, b = string_.inharmonicity;
      n = std::round(std::sqrt(2 * x / (1 + std::sqrt(std::max(0.0, 1 + 4 * b * x)))));
    } else {
      const auto above = std::lower_bound(at_rad_s_.begin(), at_rad_s_.end(), pole.imag());
      const bool below =
          above == at_rad_s_.end() || (above != at_rad_s_.begin() && pole.imag() - above[-1] < above[0] - pole.imag());
      const auto next = below ? above - 1 : above;
      if (std::abs(*next - pole.imag()) < spacing / 2) n = static_cast<double>(next - at_rad_s_.begin() + 1);
    }
    return n >= 1 && n <= static_cast<double>(own_.size()) ? static_cast<int>(n) : 0;
  }

  /// A line at the instant of release as the law has it, with the loss of its own.
  void apply_to(damped_line& line) const {
    const int n = mode_of(line.pole);
    if (n == 0) return;
    const double half = half_loss(line.pole), own = half * std::exp(own_[n - 1]), w = std::abs(line.pole);
    const double real = line.pole.real() - w * (own - half);
    const std::complex<double> turn = turned(own) / turned(half);
    line.pole = {real, std::sqrt(std::max(0.0, w * w - real * real))};
    for (auto& r : line.residue) r *= turn;
  }

  /// Derivatives by d_n of a line that has its own loss already, `age_s` after the release and seen through a band.
  struct slope {
    int mode = 0;
    std::complex<double> pole, ln_residue;
  };
  [[nodiscard]] slope slope_of(const damped_line& line, double age_s, const band& limits) const {
    const int n = mode_of(line.pole);
    if (n == 0) return {};
    const double own = half_loss(line.pole) * std::exp(own_[n - 1]), real = -std::abs(line.pole) * own;
    const std::complex<double> pole{real, -line.pole.real() / line.pole.imag() * real};
    std::complex<double> residue = pole * age_s + std::complex<double>(0, string_.convention * own) / turned(own);
    if (line.pole.imag() > 2 * std::numbers::pi * limits.pass_Hz) {
      constexpr double h = 1e-3;
      residue += (band_weight(limits, line.pole + h * pole) - band_weight(limits, line.pole - h * pole)) /
                 (2 * h * band_weight(limits, line.pole));
    }
    if (!std::isfinite(std::norm(residue))) return {};  // at the very edge of the band
    return {n, pole, residue};
  }

  [[nodiscard]] bool any() const { return own_.size() > 0; }

private:
  [[nodiscard]] double half_loss(std::complex<double> pole) const {
    return string_.loss.inverse_q(pole.imag() / (2 * std::numbers::pi)) / 2;
  }
  [[nodiscard]] std::complex<double> turned(double half) const { return {1, string_.convention * half}; }

  ringing_string string_;
  Eigen::VectorXd own_;
  std::vector<double> at_rad_s_;
};

/// Partials of a pluck (pluck_model.hpp) of a string whose modes have losses of their own.
[[nodiscard]] inline std::vector<damped_line> pluck_lines(const ringing_string& string, const own_losses& own, double position,
                                                          double age_s, const band& limits, int most) {
  if (!own.any()) return pluck_lines(string, position, age_s, limits, most);
  std::vector<damped_line> lines = pluck_lines(string, position, 0, {limits.stop_Hz, limits.stop_Hz}, most);
  for (damped_line& line : lines) {
    own.apply_to(line);
    const std::complex<double> now = band_weight(limits, line.pole) * std::exp(line.pole * age_s);
    for (auto& r : line.residue) r *= now;
  }
  return lines;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
