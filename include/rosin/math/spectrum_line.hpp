// tier: hosted
// SPDX-License-Identifier: MIT
//
// Amplitude of one sinusoid in a stretch of samples (Hann window, mean removed), and the strongest lines of its spectrum.
// A line's frequency comes from a parabola through the logarithms of three bins, good to about a hundredth of 1 / duration.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/math/fft.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct spectrum_line {
  double frequency_Hz = 0, amplitude = 0;  ///< peak amplitude of the sinusoid
};

namespace detail {

[[nodiscard]] inline std::vector<double> hann_windowed(std::span<const double> x) {
  constexpr double two_pi = 6.28318530717958647692;
  double mean = 0;
  for (const double v : x) mean += v / static_cast<double>(x.size());
  std::vector<double> out(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    out[i] = (x[i] - mean) * (1 - std::cos(two_pi * (static_cast<double>(i) + 0.5) / static_cast<double>(x.size())));
  return out;
}

/// a of x = Re{a e^{i 2 pi f t}}: (2 / sum w) sum w x e^{-i 2 pi f t} of samples that are windowed already.
[[nodiscard]] inline std::complex<double> phasor_at(const std::vector<double>& windowed, double frequency_Hz,
                                                    double sample_rate_Hz) {
  const double angle = -6.28318530717958647692 * frequency_Hz / sample_rate_Hz;
  const double turn_re = std::cos(angle), turn_im = std::sin(angle);
  double re = 1, im = 0, sum_re = 0, sum_im = 0;
  for (const double v : windowed) {
    sum_re += v * re;
    sum_im += v * im;
    const double next = re * turn_re - im * turn_im;
    im = re * turn_im + im * turn_re;
    re = next;
  }
  return 2 / static_cast<double>(windowed.size()) * std::complex<double>(sum_re, sum_im);
}
[[nodiscard]] inline double amplitude_at(const std::vector<double>& windowed, double frequency_Hz, double sample_rate_Hz) {
  return std::abs(phasor_at(windowed, frequency_Hz, sample_rate_Hz));
}

/// Amplitudes at the bins of a transform of the windowed samples, padded to at least twice their length.
template <class = void>
[[nodiscard]] std::vector<double> amplitude_bins(std::vector<double> windowed, std::size_t& size) {
  const double scale = 2 / static_cast<double>(windowed.size());
  size = fast_size(2 * windowed.size());
  windowed.resize(size, 0.0);
  std::vector<std::complex<double>> bins(size / 2 + 1);
  eigen_fft<double> fft{size};
  fft.forward(windowed.data(), bins.data());
  std::vector<double> out(bins.size());
  for (std::size_t k = 0; k < bins.size(); ++k) out[k] = scale * std::abs(bins[k]);
  return out;
}

/// The strongest lines, strongest first, without those that a stronger one casts beside itself: the side lobes of the Hann
/// window begin at 0.03, 2.5 bins away, and fall with the third power of the distance.
[[nodiscard]] inline std::vector<spectrum_line> main_lobes(std::vector<spectrum_line> lines, double bin_Hz, double least,
                                                           std::size_t count) {
  std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.amplitude > b.amplitude; });
  std::vector<spectrum_line> out;
  for (const auto& line : lines) {
    if (out.size() == count || line.amplitude <= least || line.amplitude < 0.003 * lines.front().amplitude) break;
    const bool cast = std::any_of(out.begin(), out.end(), [&](const spectrum_line& strong) {
      const double bins = std::abs(strong.frequency_Hz - line.frequency_Hz) / bin_Hz;
      return line.amplitude < 0.05 * strong.amplitude / std::pow(std::max(bins, 1.0) / 2.5, 3);
    });
    if (!cast) out.push_back(line);
  }
  return out;
}

}  // namespace detail

/// The strongest lines between two frequencies, strongest first; none that is a side lobe of a stronger one.
template <class = void>
[[nodiscard]] std::vector<spectrum_line> strongest_lines(std::span<const double> x, double sample_rate_Hz, double low_Hz,
                                                         double high_Hz, std::size_t count) {
  std::vector<spectrum_line> out;
  if (x.size() < 16) return out;
  std::size_t size = 0;
  const auto bins = detail::amplitude_bins(detail::hann_windowed(x), size);
  const double width = sample_rate_Hz / static_cast<double>(size);
  double largest = 0;
  for (const double v : x) largest = std::max(largest, std::abs(v));
  for (std::size_t k = 2; k + 2 < bins.size(); ++k) {
    const double f = static_cast<double>(k) * width;
    if (f < low_Hz || f > high_Hz || bins[k] < bins[k - 1] || bins[k] <= bins[k + 1] || bins[k - 1] <= 0 || bins[k + 1] <= 0)
      continue;
    const double a = std::log(bins[k - 1]), b = std::log(bins[k]), c = std::log(bins[k + 1]);
    const double shift = a - 2 * b + c < 0 ? (a - c) / (2 * (a - 2 * b + c)) : 0.0;
    out.push_back({f + shift * width, std::exp(b - (a - c) * shift / 4)});
  }
  return detail::main_lobes(std::move(out), sample_rate_Hz / static_cast<double>(x.size()), 1e-12 * largest, count);
}
ROSIN_INSTANTIATE(std::vector<spectrum_line> strongest_lines(std::span<const double>, double, double, double, std::size_t))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
