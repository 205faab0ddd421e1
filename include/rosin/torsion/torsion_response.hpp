// tier: hosted
// SPDX-License-Identifier: MIT
//
// How fast the string's surface moves at the contact because the string rolls under the friction force. Torsion obeys the wave
// equation between two fixed ends; with travel times tau_j from the contact to either end and a constant Q,
//
//     v_T / f = (1 / (2 Z_T)) 2 sinh(g_1) sinh(g_2) / sinh(g_1 + g_2),    g_j = i w tau_j + |w| tau_j / (2 Q)
//
// (Woodhouse, Schumacher & Garoff (2000), section IV). Written with decaying exponentials
// only, (1 - e^{-2 g_1})(1 - e^{-2 g_2}) / (1 - e^{-2 (g_1 + g_2)}), it neither overflows nor cancels at high frequency. A loss of
// this kind answers a little before it is asked; what cannot do so carries high frequencies faster, and if it is in the stress, as in
// what a string is made of, the string is the stiffer the faster it is turned (Kjartansson, J. Geophys. Res. 84, 1979):
//
//     g_j = i w tau_j (i w / w_1)^(-G) / cos(pi G / 2),    Z_T (i w / w_1)^G in place of Z_T,    G = atan(1 / Q) / pi,
//
// w_1 the first torsional resonance, where speed and impedance are told. The product of both, the inertia, has no loss.
//
// No material keeps to that: the loss has a trend. With a loss angle that falls by `trend` of itself for each e-th of frequency, the
// stiffness goes as causality asks (d ln M' / d ln w = 2 / pi times the loss angle),
//
//     delta = delta_1 (1 - trend L),    ln M' = (2 delta_1 / pi) (L - trend L^2 / 2),    L = ln(w / w_1).
//
// A flat spectrum of relaxations, whose loss modulus is the same at all frequencies while the stiffness rises, has 2 / (pi Q).
//
// It is one transfer function, applied to the whole record at once: Q is as low as 15, so that all memory ends within a few dozen of
// the torsional periods, and zeros behind the record keep its end out of its beginning.
//
#pragma once

#include <rosin/math/fft.hpp>
#include <rosin/math/plain_complex.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

namespace rosin {

/// What a loss alike at all frequencies does to waves, at `over_first` times the frequency where they are told; 0: what is not causal.
struct causal_loss {
  double sooner = 1;                ///< share of the travel time
  double per_phase = 0;             ///< loss a radian
  std::complex<double> softer = 1;  ///< of the mobility

  causal_loss(double q, double over_first, double trend = 0) noexcept : per_phase{1 / (2 * q)} {
    if (!(over_first > 0)) return;
    const double at_first = std::atan(1 / q), since = std::log(over_first), angle = at_first * (1 - trend * since);
    const double speed = std::exp(at_first / std::numbers::pi * since * (1 - 0.5 * trend * since));
    sooner = std::cos(angle / 2) / (speed * std::cos(at_first / 2));
    per_phase = std::tan(angle / 2), softer = std::polar(1 / speed, -angle / 2);
  }
};

/// Torsion as seen from the contact; the impedance is referred to the surface.
struct torsion_waveguide {
  std::array<double, 2> delay_s{};  ///< travel times to the near and the far end
  double impedance_Ns_m = 0;
  double q = 15;
  bool causal = false;  ///< with the dispersion and the stiffness that belong to the loss
  double trend = 0;     ///< of the loss angle, where it is causal: by how much of itself it falls for each e-th of frequency

  /// Surface velocity for 1 N at a frequency in Hz, m/s per N.
  [[nodiscard]] std::complex<double> operator()(double frequency_Hz) const noexcept {
    const double w = 2 * std::numbers::pi * frequency_Hz;
    if (w == 0) return 0;
    const causal_loss loss(q, causal ? std::abs(w) * (delay_s[0] + delay_s[1]) / std::numbers::pi : 0, trend);
    const auto round_trip = [&](double delay) {
      return std::exp(-2 * delay * loss.sooner * std::complex<double>(std::abs(w) * loss.per_phase, w));
    };
    const std::complex<double> a = round_trip(delay_s[0]), b = round_trip(delay_s[1]),
                               softer = w > 0 ? loss.softer : std::conj(loss.softer);
    return (1.0 - a) * (1.0 - b) / (1.0 - a * b) / (2 * impedance_Ns_m) * softer;
  }

  /// The same at 0, step_Hz, ... (count - 1) step_Hz: one product from a frequency to the next, where nothing disperses.
  [[nodiscard]] std::vector<std::complex<double>> on_grid(double step_Hz, std::size_t count) const {
    constexpr std::size_t anew = 256;
    const double w = 2 * std::numbers::pi * step_Hz;
    std::vector<std::complex<double>> out(count);
    for (std::size_t k = 0; causal && k < count; ++k) out[k] = (*this)(step_Hz * static_cast<double>(k));
    if (causal) return out;
    std::array<std::complex<double>, 2> rate, turn, at;
    for (std::size_t j = 0; j < 2; ++j)
      rate[j] = -2 * w * delay_s[j] * std::complex<double>(1 / (2 * q), 1), turn[j] = std::exp(rate[j]);
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t j = 0; j < 2; ++j) at[j] = k % anew == 0 ? std::exp(rate[j] * static_cast<double>(k)) : at[j] * turn[j];
      if (k > 0) out[k] = (1.0 - at[0]) * (1.0 - at[1]) * plain::reciprocal((1.0 - at[0] * at[1]) * (2 * impedance_Ns_m));
    }
    return out;
  }

  /// How long what happened is felt: until an impulse has died to `rest` of its size.
  [[nodiscard]] double memory_s(double rest = 1e-3) const noexcept {
    return 2 * (delay_s[0] + delay_s[1]) * q / std::numbers::pi * std::log(1 / rest);
  }
};

/// From the transverse travel times and impedance, and the ratios torsional / transverse.
[[nodiscard]] inline torsion_waveguide torsion_of(const std::array<double, 2>& transverse_delay_s, double impedance_Ns_m,
                                                  double speed_ratio, double impedance_ratio, double q) noexcept {
  return {{transverse_delay_s[0] / speed_ratio, transverse_delay_s[1] / speed_ratio}, impedance_Ns_m * impedance_ratio, q};
}

/// Surface velocity by rotation for a force of finite samples. Before the record the force had its first value for ever.
template <class Fft = eigen_fft<double>>
[[nodiscard]] std::vector<double> torsion_velocity(const torsion_waveguide& waveguide, std::span<const double> force_N,
                                                   double rate_Hz) {
  if (force_N.empty()) return {};
  const auto memory = static_cast<std::size_t>(std::ceil(2 * waveguide.memory_s(1e-4) * rate_Hz));
  const std::size_t size = fast_size(force_N.size() + memory + 2);
  std::vector<double> padded(size, 0.0);
  for (std::size_t i = 0; i < force_N.size(); ++i) padded[i] = force_N[i] - force_N.front();
  const double end = padded[force_N.size() - 1];  // a gentle way back to zero, which itself rings in the padding only
  for (std::size_t i = 0; i < memory / 2; ++i)
    padded[force_N.size() + i] =
        0.5 * end * (1 + std::cos(std::numbers::pi * static_cast<double>(i + 1) / static_cast<double>(memory / 2 + 1)));
  Fft fft(size);
  std::vector<std::complex<double>> bins(size / 2 + 1);
  fft.forward(padded.data(), bins.data());
  const auto responses = waveguide.on_grid(rate_Hz / static_cast<double>(size), bins.size());
  for (std::size_t k = 0; k < bins.size(); ++k) bins[k] *= responses[k];
  fft.inverse(bins.data(), padded.data());
  padded.resize(force_N.size());
  return padded;
}

}  // namespace rosin
