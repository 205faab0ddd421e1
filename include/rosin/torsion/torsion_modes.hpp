// tier: hosted
// SPDX-License-Identifier: MIT
//
// The same torsion as torsion_response.hpp with another convention of damping: every mode is a viscously damped oscillator,
//
//     v_T / f = (2 / M) sum_n sin^2(n pi p) i w / (w_n^2 - w^2 + i w w_n / Q),    M = Z_T tau,  w_n = n pi / tau,
//
// tau the torsional travel time over the whole length, p the contact's place. At equal Q the two conventions agree at the
// resonances and differ by a good part of 1/Q in phase between them: with Q about 15 that is more than a good
// reconstruction leaves open, so that a fit of torsion has to try both. Modes that are alike in Q may also lie wider than harmonics,
// w_n = w_1 n^(1 / (1 - 1 / (pi Q))), as the dispersion in torsion_response.hpp has it. The sum ends after `modes`; what the rest adds
// below them is a compliance (rest_m_N) and small beside it.
//
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace rosin {

struct torsion_modes {
  std::array<double, 2> delay_s{};  ///< torsional travel times to the near and the far end
  double impedance_Ns_m = 0;        ///< referred to the surface
  double q = 15;
  int modes = 60;
  bool causal = false;  ///< wider than harmonics

  /// How many to sum for what is seen below a frequency: those above 1.25 of it are a compliance there. 40 at least, 1000 at most.
  [[nodiscard]] static int seen_below(double frequency_Hz, double one_way_s) noexcept {
    return static_cast<int>(std::clamp(std::ceil(2.5 * frequency_Hz * one_way_s), 40.0, 1000.0));
  }

  /// Of mode n, by that of the first.
  [[nodiscard]] static double ratio(int n, double q, bool causal) noexcept {
    return causal ? std::pow(n, 1 / (1 - 1 / (std::numbers::pi * q))) : n;
  }

  /// Surface velocity for 1 N at a frequency in Hz, m/s per N.
  [[nodiscard]] std::complex<double> operator()(double frequency_Hz) const noexcept {
    const double w = 2 * std::numbers::pi * frequency_Hz, tau = delay_s[0] + delay_s[1], first = std::numbers::pi / tau;
    const std::complex<double> turn = std::polar(1.0, 2 * std::numbers::pi * delay_s[0] / tau);
    std::complex<double> sum = 0, place = 1;
    for (int n = 1; n <= modes; ++n) {
      place *= turn;  // 2 sin^2(n pi p) = 1 - cos(2 n pi p)
      const double wn = ratio(n, q, causal) * first, re = wn * wn - w * w, im = w * wn / q,
                   scale = (1 - place.real()) / (re * re + im * im);
      sum += std::complex<double>(re * scale, -im * scale);
    }
    return std::complex<double>(0, w) * sum / (impedance_Ns_m * tau);
  }

  /// The same at 0, step_Hz, ... (count - 1) step_Hz, mode by mode.
  [[nodiscard]] std::vector<std::complex<double>> on_grid(double step_Hz, std::size_t count) const {
    const double step = 2 * std::numbers::pi * step_Hz, tau = delay_s[0] + delay_s[1], first = std::numbers::pi / tau;
    std::vector<double> real(count, 0.0), imag(count, 0.0);
    for (int n = 1; n <= modes; ++n) {
      const double wn = ratio(n, q, causal) * first, wn2 = wn * wn, lossy = wn / q,
                   moved = 1 - std::cos(2 * n * std::numbers::pi * delay_s[0] / tau);
      for (std::size_t k = 0; k < count; ++k) {
        const double w = step * static_cast<double>(k), re = wn2 - w * w, im = w * lossy, scale = moved / (re * re + im * im);
        real[k] += re * scale, imag[k] -= im * scale;
      }
    }
    std::vector<std::complex<double>> out(count);
    const double per = step / (impedance_Ns_m * tau);
    for (std::size_t k = 0; k < count; ++k) out[k] = per * static_cast<double>(k) * std::complex<double>(-imag[k], real[k]);
    return out;
  }

  /// Compliance of the modes left out, m/N: what all modes yield under a steady force, less those of the sum.
  [[nodiscard]] double rest_m_N() const noexcept {
    const double tau = delay_s[0] + delay_s[1], first = std::numbers::pi / tau, p = delay_s[0] / tau;
    double sum = 0;
    for (int n = 1; n <= modes; ++n) sum += 2 * std::pow(std::sin(n * std::numbers::pi * p) / (n * first), 2);
    const double wider = ratio(modes, q, causal) / modes;  // about what the next ones are
    return (delay_s[0] * delay_s[1] / (tau * impedance_Ns_m) - sum / (impedance_Ns_m * tau)) / (wider * wider);
  }
};

/// How the loss is shared out between the resonances: waves or modes, without or with dispersion.
enum class torsion_damping { constant_q, viscous_modes, causal_q, causal_modes };
[[nodiscard]] constexpr bool in_modes(torsion_damping d) noexcept {
  return d == torsion_damping::viscous_modes || d == torsion_damping::causal_modes;
}
[[nodiscard]] constexpr bool is_causal(torsion_damping d) noexcept {
  return d == torsion_damping::causal_q || d == torsion_damping::causal_modes;
}
[[nodiscard]] constexpr torsion_damping torsion_convention(bool modes, bool causal) noexcept {
  return causal ? (modes ? torsion_damping::causal_modes : torsion_damping::causal_q)
                : (modes ? torsion_damping::viscous_modes : torsion_damping::constant_q);
}
/// With dispersion in place of without, or the other way about.
[[nodiscard]] constexpr torsion_damping otherwise_dispersed(torsion_damping d) noexcept {
  return torsion_convention(in_modes(d), !is_causal(d));
}
/// Modes in place of waves, or the other way about.
[[nodiscard]] constexpr torsion_damping otherwise_shared(torsion_damping d) noexcept {
  return torsion_convention(!in_modes(d), is_causal(d));
}

}  // namespace rosin
