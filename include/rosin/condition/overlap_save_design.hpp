// tier: hosted
// SPDX-License-Identifier: MIT
//
// What an overlap-save convolution has to know before it runs: which lags its kernels cover, how long its blocks should
// be, and the complex kernels by which two real channels travel as one signal z = x[0] + i x[1] (overlap_save.hpp):
//
//     y[0] + i y[1] = a * z + b * conj(z),    a = ((h00 + h11) + i (h10 - h01)) / 2,
//                                             b = ((h00 - h11) + i (h10 + h01)) / 2,   h[output][input]
//
#pragma once

#include <algorithm>
#include <complex>
#include <concepts>
#include <cstddef>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// y[n] = sum_j taps[j] x[n - first - j]: a negative `first` looks ahead. Without taps it is zero.
template <class K>
concept FirKernel = requires(const K& kernel) {
  { kernel.first } -> std::convertible_to<int>;
  { kernel.taps.size() } -> std::convertible_to<std::size_t>;
  { kernel.taps[0] } -> std::convertible_to<double>;
};

/// Lags first ... last, both included.
struct lag_range {
  int first, last;
  [[nodiscard]] std::size_t taps() const noexcept { return static_cast<std::size_t>(last - first + 1); }
};

/// The lags that at least one of the kernels covers; lag 0 if none has taps.
template <FirKernel Kernel>
[[nodiscard]] lag_range lags_of(const std::vector<Kernel>& kernels) noexcept {
  lag_range all{0, 0};
  bool any = false;
  for (const Kernel& kernel : kernels) {
    if (kernel.taps.size() == 0) continue;
    const int first = kernel.first, last = first + static_cast<int>(kernel.taps.size()) - 1;
    all = any ? lag_range{std::min(all.first, first), std::max(all.last, last)} : lag_range{first, last};
    any = true;
  }
  return all;
}

/// The power of two that makes the quickest blocks. Work per output is (log2 n + what a sample costs besides) n / (n - taps + 1);
/// a batch of blocks, bytes_per_point each, should stay in the cache.
[[nodiscard]] inline std::size_t quickest_block(std::size_t taps, std::size_t bytes_per_point) noexcept {
  constexpr std::size_t cache_bytes = 256 * 1024;
  std::size_t best = 16, n = 16;
  double least = 0;
  for (double log2n = 4; n / 16 <= taps; n *= 2, ++log2n) {
    if (n < 2 * taps) continue;
    const double spill = n * bytes_per_point > cache_bytes ? 1.3 : 1.0;
    const double work = spill * (log2n + 6) * static_cast<double>(n) / static_cast<double>(n - taps + 1);
    if (least == 0 || work < least) least = work, best = n;
  }
  return best;
}

/// a and b above, n points each, lag `first` at point 0.
struct pair_kernels {
  std::vector<std::complex<double>> a, b;

  pair_kernels(std::size_t n, int first) : a(n), b(n), first_{first} {}

  template <FirKernel Kernel>
  void add(const Kernel& kernel, std::size_t output, std::size_t input) {
    using complex = std::complex<double>;
    const complex in_a = output == input ? complex{0.5, 0} : complex{0, output > input ? 0.5 : -0.5};
    const complex in_b = output == input ? complex{output == 0 ? 0.5 : -0.5, 0} : complex{0, 0.5};
    const std::size_t at = static_cast<std::size_t>(kernel.first - first_);
    for (std::size_t j = 0; j < kernel.taps.size(); ++j) {
      a[at + j] += in_a * static_cast<double>(kernel.taps[j]);
      b[at + j] += in_b * static_cast<double>(kernel.taps[j]);
    }
  }

private:
  int first_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
