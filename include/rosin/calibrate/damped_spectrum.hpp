// tier: hosted
// SPDX-License-Identifier: MIT
//
// The spectrum of a recording along a line s = sigma + i w to the right of the imaginary axis,
//
//     X(s) = h sum_n x[n] exp(-s n h),
//
// by one transform of the exponentially weighted record. What happens later than a few 1/sigma hardly counts, so the record needs
// no end and sharp resonances are seen as softly as wanted: a fit begins with a large sigma, where a string is two or three
// echoes and the pitch cannot be mistaken, and follows it down to the whole record.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/math/fft.hpp>

#include <cmath>
#include <complex>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The line along which spectra are taken, and its points.
struct damped_line_of_frequencies {
  double rate_Hz = 0;
  double sigma_per_s = 0;
  std::size_t samples = 0;          ///< of the record that are used
  std::size_t first = 1, last = 0;  ///< bins

  /// `highest_Hz`: of the bins. What the weight leaves of the record's end is exp(-12) of it.
  damped_line_of_frequencies(double rate, double sigma, std::size_t available, double highest_Hz)
      : rate_Hz{rate}, sigma_per_s{sigma}, samples{std::min(available, static_cast<std::size_t>(12 / sigma * rate) + 64)} {
    last = std::min(static_cast<std::size_t>(highest_Hz / rate * static_cast<double>(samples)), samples / 2);
  }
  [[nodiscard]] std::size_t bins() const noexcept { return last + 1 - first; }
  [[nodiscard]] std::complex<double> at(std::size_t bin) const noexcept {
    return {sigma_per_s, 2 * std::numbers::pi * static_cast<double>(first + bin) * rate_Hz / static_cast<double>(samples)};
  }
  /// Sum of the squared weights: so many samples' worth of noise.
  [[nodiscard]] double weighted_samples() const noexcept {
    const double x = 2 * sigma_per_s / rate_Hz;
    return (1 - std::exp(-x * static_cast<double>(samples))) / (1 - std::exp(-x));
  }
};

/// X along the line. Precondition: x holds as many samples as the line uses.
template <class = void>
[[nodiscard]] std::vector<std::complex<double>> damped_spectrum(const damped_line_of_frequencies& line,
                                                                std::span<const double> x) {
  std::vector<double> weighted(line.samples);
  const double step = std::exp(-line.sigma_per_s / line.rate_Hz);
  double weight = 1 / line.rate_Hz;
  for (std::size_t n = 0; n < line.samples; ++n, weight *= step) weighted[n] = weight * x[n];
  std::vector<std::complex<double>> all(line.samples / 2 + 1);
  eigen_fft<double> fft(line.samples);
  fft.forward(weighted.data(), all.data());
  return {all.begin() + static_cast<std::ptrdiff_t>(line.first), all.begin() + static_cast<std::ptrdiff_t>(line.last + 1)};
}
ROSIN_INSTANTIATE(std::vector<std::complex<double>> damped_spectrum(const damped_line_of_frequencies&, std::span<const double>))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
