// tier: hosted
// SPDX-License-Identifier: MIT
//
// Delays by a windowed sinc: w[j] = sinc(t) I0(beta sqrt(1 - (2 t / taps)^2)) / I0(beta), t = j - (taps/2 - 1) - fraction,
// scaled to a sum of one. The window moves with the sinc, so that the weights are smooth in the fraction.
//
// A fractional delay jumps at half the sampling rate, from exp(-i pi d) to its conjugate; the window smears the jump over its
// main lobe, and below that lobe leaves ripples alone. Kaiser's window (J. F. Kaiser, R. W. Schafer, IEEE Trans. ASSP 28, 1980,
// 105) trades one for the other: with its lobe filling the band from `bandwidth` to half the sampling rate,
//
//     attenuation (dB) = 7.95 + 2.285 (taps - 1) 2 pi (1 - bandwidth),   beta = 0.1102 (attenuation - 8.7) above 50 dB
//
// Why not an optimal (equiripple) design: it saves a tap in ten, and needs an iteration for every delay.
//
#pragma once

#include <rosin/condition/fractional_delay.hpp>
#include <rosin/core/number_text.hpp>
#include <rosin/core/outcome.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <concepts>
#include <cstddef>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace rosin {

/// Modified Bessel function I0 by its power series, in which nothing cancels.
[[nodiscard]] inline double bessel_i0(double x) noexcept {
  double sum = 1, term = 1;
  for (double k = 1; term > 1e-17 * sum; ++k) {
    term *= x * x / (4 * k * k);
    sum += term;
  }
  return sum;
}

/// Shape of Kaiser's window for a ripple of -attenuation_dB.
[[nodiscard]] inline double kaiser_beta(double attenuation_dB) noexcept {
  if (attenuation_dB > 50) return 0.1102 * (attenuation_dB - 8.7);
  if (attenuation_dB <= 21) return 0;
  return 0.5842 * std::pow(attenuation_dB - 21, 0.4) + 0.07886 * (attenuation_dB - 21);
}

/// The attenuation that fills the band from `bandwidth` to half the sampling rate with the window's main lobe.
[[nodiscard]] inline double kaiser_attenuation_dB(std::size_t taps, double bandwidth) noexcept {
  return 7.95 + 2.285 * static_cast<double>(taps - 1) * 2 * std::numbers::pi * (1 - bandwidth);
}

/// Windowed-sinc weights for a delay of taps / 2 - 1 + fraction samples; an even number of taps.
inline void kaiser_weights(double fraction, double beta, std::span<double> weights) noexcept {
  const double half = static_cast<double>(weights.size()) / 2;
  double sum = 0;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    const double t = static_cast<double>(j) - (half - 1) - fraction, edge = 1 - (t / half) * (t / half);
    // sin(pi t) from the fraction: its size is the same for every tap
    const double sine = std::sin(std::numbers::pi * fraction) * ((weights.size() / 2 + j) % 2 == 0 ? 1 : -1);
    const double sinc = t == 0 ? 1 : sine / (std::numbers::pi * t);
    weights[j] = sinc * bessel_i0(beta * std::sqrt(edge > 0 ? edge : 0));
    sum += weights[j];
  }
  for (double& weight : weights) weight /= sum;
}

/// Interpolator for fractional_delay: good up to Percent of half the sampling rate, as far as the taps go.
template <std::size_t Taps, int Percent = 80>
struct kaiser {
  static constexpr std::size_t taps = Taps;

  template <std::floating_point T>
  [[nodiscard]] static std::array<T, Taps> weights(T fraction) noexcept {
    std::array<double, Taps> exact{};
    kaiser_weights(static_cast<double>(fraction), kaiser_beta(kaiser_attenuation_dB(Taps, Percent / 100.0)), exact);
    std::array<T, Taps> w{};
    for (std::size_t j = 0; j < Taps; ++j) w[j] = static_cast<T>(exact[j]);
    return w;
  }
};

/// How well a delay has to be met, and up to where.
struct delay_limits {
  double bandwidth = 0.8;  ///< of half the sampling rate, at most 0.99
  double error_dB = -140;  ///< largest |H(f) exp(2 pi i f d) - 1| in that band, at least -280
};

/// y[n] = sum_j taps[j] x[n - first - j].
struct delay_kernel {
  int first;
  std::vector<double> taps;
};

/// Largest |H(f) exp(2 pi i f d) - 1|, in dB, up to `bandwidth` times half the sampling rate.
[[nodiscard]] inline double delay_error_dB(const delay_kernel& kernel, double delay_samples, double bandwidth) {
  const std::size_t points = 4 * kernel.taps.size() + 16;
  double worst = 0;
  for (std::size_t i = 1; i <= points; ++i) {
    const double w = std::numbers::pi * bandwidth * static_cast<double>(i) / static_cast<double>(points);
    std::complex<double> sum = 0;
    for (std::size_t j = 0; j < kernel.taps.size(); ++j)
      sum += kernel.taps[j] * std::polar(1.0, w * (delay_samples - kernel.first - static_cast<double>(j)));
    worst = std::fmax(worst, std::abs(sum - 1.0));
  }
  return 20 * std::log10(std::fmax(worst, 1e-16));
}

/// The kernel of a delay by any real number of samples, negative ones too: a windowed sinc of
/// about Kaiser's length, made longer until it keeps the limits.
[[nodiscard]] inline outcome<delay_kernel> design_kaiser_delay(double delay_samples, const delay_limits& limits = {}) {
  const auto [bandwidth, error_dB] = limits;
  if (!(std::abs(delay_samples) < 1e9)) return failure{"delay of " + number_text(delay_samples) + " samples: not below 1e9"};
  if (!(bandwidth > 0 && bandwidth <= 0.99))
    return failure{"delay: bandwidth " + number_text(bandwidth) + " is not in 0 ... 0.99"};
  if (!(error_dB >= -280 && error_dB < 0))
    return failure{"delay: error of " + number_text(error_dB) + " dB is not in -280 ... 0"};

  const double whole = std::floor(delay_samples), fraction = delay_samples - whole;
  const double estimate = (-error_dB - 12) / (4.57 * 2 * std::numbers::pi * (1 - bandwidth));  // a little short
  for (int half = fraction == 0 || estimate < 1 ? 1 : static_cast<int>(estimate);; ++half) {
    delay_kernel kernel{static_cast<int>(whole) - half + 1, std::vector<double>(2 * static_cast<std::size_t>(half))};
    kaiser_weights(fraction, kaiser_beta(kaiser_attenuation_dB(kernel.taps.size(), bandwidth)), kernel.taps);
    if (delay_error_dB(kernel, delay_samples, bandwidth) < error_dB - 0.5) return kernel;  // 0.5: between the points looked at
  }
}

}  // namespace rosin
