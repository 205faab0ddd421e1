// tier: hosted
// SPDX-License-Identifier: MIT
//
// Scott's Airy-function formula for a pulse on a stiff string, Eqs. (6)-(8) of Woodhouse, Schumacher & Garoff (2000), with
// the normalisation that makes it a transmission function. With epsilon = B m / T^2 and travel time tau_x = x / c:
//
//     tb = t / sqrt(epsilon),  xb = tau_x / sqrt(epsilon),  tau = t / tau_x,
//     K  = (1 - 4 tau^2 + sqrt(1 + 8 tau^2)) / (8 tau^2)                                             Eq. (7)
//     v  = 3^(1/6) (K+1)^(2/3) / (2^(2/3) (2K+3)^(1/2) tb^(1/3)) Ai(-(3 tb/2)^(2/3) K / (K+1)^(1/3))   Eq. (6)
//     d  = 2 v / (tau sqrt(epsilon))                                                                 1/s
//
// As printed, Eq. (6) is half the response to an initial velocity; the boundary-value response that multiplies spectra by
// exp(-i k x) needs the factors 2 T / sqrt(B m) and 1 / tau (docs/explain/theory.md: without the last it is no all-pass).
// It is kept as the paper's own processing and as an independent check of the exact-phase kernels.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/propagate/fir.hpp>
#include <rosin/propagate/transmission.hpp>

#include <boost/math/special_functions/airy.hpp>

#include <cmath>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Which of the two normalisations of Eq. (6).
enum class airy_form {
  transmission,  ///< with 1 / tau: an all-pass, what d(t) has to be
  printed        ///< Eq. (6) as it stands, scaled to unit gain at zero frequency
};

/// d(t) in 1/s, t in s after the pulse left; 0 for t <= 0. Relative rms error over the pulse about 0.06 xb^(-4/3).
template <class = void>
[[nodiscard]] double airy_transmission(double t_s, double delay_s, double stiffness_s2,
                                       airy_form form = airy_form::transmission) {
  if (t_s <= 0) return 0;
  const double tb = t_s / std::sqrt(stiffness_s2), tau = t_s / delay_s;
  const double K = (1 - 4 * tau * tau + std::sqrt(1 + 8 * tau * tau)) / (8 * tau * tau);
  const double argument = -std::pow(1.5 * tb, 2.0 / 3) * K / std::cbrt(K + 1);
  const double front =
      std::pow(3.0, 1.0 / 6) * std::pow(K + 1, 2.0 / 3) / (std::pow(2.0, 2.0 / 3) * std::sqrt(2 * K + 3) * std::cbrt(tb));
  const double v = argument > 100 ? 0.0 : front * boost::math::airy_ai(argument);
  return 2 * v / std::sqrt(stiffness_s2) / (form == airy_form::transmission ? tau : 1.0);
}
ROSIN_INSTANTIATE(double airy_transmission(double, double, double, airy_form))

/// FIR kernel from the Airy formula: evaluated `oversampling` times too often, band-limited, then decimated; sampled directly
/// at the rate it would alias beyond use. Lossless, as the formula is.
template <class = void>
[[nodiscard]] fir airy_kernel(double delay_s, double stiffness_s2, const band& limits, double rate_Hz,
                              airy_form form = airy_form::transmission, int oversampling = 32) {
  const double fine_Hz = rate_Hz * oversampling;
  const passage_lags lags = lags_of_passage(delay_s, stiffness_s2, limits, rate_Hz);
  const int margin = lags.last - static_cast<int>(delay_s * rate_Hz);
  // The band's own response, at the fine rate, is what the formula is convolved with.
  const fir window = sample_response([](double) { return 1.0; }, limits, fine_Hz, -margin * oversampling, margin * oversampling);
  // Far ahead of the front the local frequency is above all bands: the chirp is faded in between the arrivals of 16 and of
  // 2 times the stop band's edge. A cut, or a shorter fade, would ring into the band.
  const auto arrival = [&](double times) {
    return delay_s * slowness_ratio(2 * std::numbers::pi * times * limits.stop_Hz, stiffness_s2);
  };
  const double start_s = arrival(16);
  const band fade{0, arrival(2) - start_s};
  const int begin = static_cast<int>(start_s * fine_Hz), end = lags.last * oversampling;

  fir out{lags.first, std::vector<double>(static_cast<std::size_t>(lags.last - lags.first + 1), 0.0)};
  for (int i = begin; i <= end; ++i) {
    const double t = i / fine_Hz;
    const double weight = 1 - fade(std::max(t - start_s, 0.0));
    const double d = weight * airy_transmission(t, delay_s, stiffness_s2, form) / fine_Hz;
    if (d == 0) continue;
    for (int n = out.first; n <= out.last(); ++n) {
      const int lag = n * oversampling - i;
      if (lag < window.first || lag > window.last()) continue;
      out.taps[static_cast<std::size_t>(n - out.first)] +=
          d * oversampling * window.taps[static_cast<std::size_t>(lag - window.first)];
    }
  }
  return out;
}
ROSIN_INSTANTIATE(fir airy_kernel(double, double, const band&, double, airy_form, int))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
