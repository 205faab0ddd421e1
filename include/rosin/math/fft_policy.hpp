// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the library asks of a Fourier transform. A policy is a plan for one length: it is constructed with the length,
// keeps its tables and buffers, and transforms from one array into another that does not overlap it:
//
//     forward   X[k] = sum_j x[j] exp(-2 pi i j k / n)           inverse   x[j] = 1/n sum_k X[k] exp(+2 pi i j k / n)
//
// A real transform of n samples has n/2 + 1 bins; its inverse ignores the imaginary parts of the bins 0 and (n even) n/2.
// Policies: eigen_fft (math/fft.hpp), pocketfft_fft and fftw_fft (adapt/). Each is a template: over float or double it
// is the real transform, over std::complex of these the complex one. A plan is for one thread at a time.
//
#pragma once

#include <complex>
#include <concepts>
#include <cstddef>

namespace rosin {

/// F transforms n real samples to n/2 + 1 bins and back, for any n >= 1.
template <class F, class T>
concept RealFft = std::movable<F> && std::constructible_from<F, std::size_t> &&
    requires(F fft, const F& same, const T* samples, T* samples_out, const std::complex<T>* bins, std::complex<T>* bins_out) {
  { same.size() }
  noexcept->std::same_as<std::size_t>;
  { fft.forward(samples, bins_out) }
  noexcept;
  { fft.inverse(bins, samples_out) }
  noexcept;
};

/// F transforms n complex samples to n bins and back, for any n >= 1.
template <class F, class T>
concept ComplexFft = std::movable<F> && std::constructible_from<F, std::size_t> &&
    requires(F fft, const F& same, const std::complex<T>* in, std::complex<T>* out) {
  { same.size() }
  noexcept->std::same_as<std::size_t>;
  { fft.forward(in, out) }
  noexcept;
  { fft.inverse(in, out) }
  noexcept;
};

/// The largest prime factor of n; 1 for n = 1 and n = 0.
[[nodiscard]] constexpr std::size_t largest_prime_factor(std::size_t n) noexcept {
  std::size_t largest = 1;
  for (std::size_t p = 2; p * p <= n; p += p == 2 ? 1 : 2)
    for (; n % p == 0; n /= p) largest = p;
  return n > 1 ? n : largest;
}

/// The next size >= n that has no prime factor above 5, so that every backend is quick with it; 1 for n = 0.
[[nodiscard]] constexpr std::size_t fast_size(std::size_t n) noexcept {
  std::size_t best = 1;
  while (best < n) best *= 2;
  for (std::size_t fives = 1; fives < best; fives *= 5)
    for (std::size_t odd = fives; odd < best; odd *= 3) {
      std::size_t size = odd;
      while (size < n) size *= 2;
      if (size < best) best = size;
    }
  return best;
}

}  // namespace rosin
