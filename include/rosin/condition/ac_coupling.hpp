// tier: freestanding
// SPDX-License-Identifier: MIT
//
// What an AC-coupled amplifier did to a force, undone. A first-order high-pass obeys y' + w_c y = x', so that
//
//     x(t) = y(t) + w_c int y dt + constant.
//
// The droop comes back exactly; the constant, the force's level before and its mean, is lost in the amplifier and stays
// unknown. The integral is taken by the trapezoidal rule, whose error is below (w_c / rate)^2.
//
#pragma once

#include <cstddef>
#include <numbers>
#include <span>

namespace rosin {

/// Replaces y by x, in place, with mean zero. corner_Hz <= 0: DC coupled, nothing is done.
template <class T>
void restore_ac_coupled(std::span<T> signal, double corner_Hz, double rate_Hz) noexcept {
  if (corner_Hz <= 0 || signal.empty()) return;
  const double half_step = std::numbers::pi * corner_Hz / rate_Hz;  // w_c h / 2
  double integral = 0, previous = static_cast<double>(signal[0]), mean = 0;
  for (std::size_t n = 0; n < signal.size(); ++n) {
    const double y = static_cast<double>(signal[n]);
    if (n > 0) integral += half_step * (y + previous);
    previous = y;
    signal[n] = static_cast<T>(y + integral);
    mean += y + integral;
  }
  mean /= static_cast<double>(signal.size());
  for (T& x : signal) x = static_cast<T>(static_cast<double>(x) - mean);
}

/// The other way about, in place: x, steady before it begins, through the high-pass, by the same rule, so that either undoes the
/// other. (The simulated amplifier of simulate/converter.hpp steps exactly instead: what is undone is not to have been made by
/// its own inverse.)
template <class T>
void pass_ac_coupled(std::span<T> signal, double corner_Hz, double rate_Hz) noexcept {
  if (corner_Hz <= 0 || signal.empty()) return;
  const double half_step = std::numbers::pi * corner_Hz / rate_Hz;
  double before = static_cast<double>(signal[0]), y = 0;
  for (T& s : signal) {
    const double x = static_cast<double>(s);
    y = ((1 - half_step) * y + x - before) / (1 + half_step);
    before = x;
    s = static_cast<T>(y);
  }
}

}  // namespace rosin
