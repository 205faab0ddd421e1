// tier: hosted
// SPDX-License-Identifier: MIT
//
// The dispersion relation (dispersion.hpp) at complex frequencies w = s / i, where a string's poles are.
//
#pragma once

#include <rosin/math/plain_complex.hpp>

#include <complex>

namespace rosin {

/// c k(w), as phase_rate() has it for real frequencies.
[[nodiscard]] inline std::complex<double> phase_rate(std::complex<double> omega, double epsilon_s2) noexcept {
  return omega * plain::sqrt(2.0 * plain::reciprocal(1.0 + plain::sqrt(1.0 + 4 * epsilon_s2 * (omega * omega))));
}

}  // namespace rosin
