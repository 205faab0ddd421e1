// tier: hosted
// SPDX-License-Identifier: MIT
//
// A whole record through a window in frequency, without delay: every cosine of frequency f comes out W(f) times as large
// and where it was. Made for rosin::band (propagate/band.hpp), the band in which results are stated; any even window will do.
//
// Ends: the record is continued by its mirror image at either end, for ever (x[-1] = x[0], x[n] = x[n-1], period 2 n). So
// there is no jump at the ends as a periodic continuation would have it, a constant stays that constant, and no length of
// margin has to be chosen. A tone feels the mirror less than 1e-4 from 4 / (stop - pass) seconds off an
// end; a slope is flattened there.
//
#pragma once

#include <rosin/math/fft.hpp>
#include <rosin/math/fft_policy.hpp>

#include <algorithm>
#include <complex>
#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

namespace rosin {

/// A real gain for each frequency in Hz, >= 0.
template <class W>
concept FrequencyWindow = requires(const W& window, double frequency_Hz) {
  { window(frequency_Hz) } -> std::convertible_to<double>;
};

/// The record behind the window. An empty record stays empty.
template <class T, RealFft<T> Fft = eigen_fft<T>, FrequencyWindow Window>
[[nodiscard]] std::vector<T> low_pass(std::span<const T> record, double sample_rate_Hz, const Window& window) {
  const std::size_t n = record.size();
  if (n == 0) return {};
  std::vector<T> mirrored(2 * n);
  std::copy(record.begin(), record.end(), mirrored.begin());
  std::reverse_copy(record.begin(), record.end(), mirrored.begin() + static_cast<std::ptrdiff_t>(n));

  Fft fft(2 * n);
  std::vector<std::complex<T>> bins(n + 1);
  fft.forward(mirrored.data(), bins.data());
  for (std::size_t k = 0; k <= n; ++k)
    bins[k] *= static_cast<T>(window(sample_rate_Hz * static_cast<double>(k) / static_cast<double>(2 * n)));
  fft.inverse(bins.data(), mirrored.data());
  mirrored.resize(n);
  return mirrored;
}

}  // namespace rosin
