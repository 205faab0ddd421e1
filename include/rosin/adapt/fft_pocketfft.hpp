// tier: hosted
// SPDX-License-Identifier: MIT
//
// The Fourier transform of pocketfft (BSD-3, one header; Debian's gemmi-dev carries it): 2 to 4 times as fast as Eigen's
// and quick at any length by itself. Each transform allocates a work array inside pocketfft: this backend is for whole
// records, not for real time; where memory runs out the program ends.
//
// Its vector types serve several transforms at once, which a plan of this policy never does; with them it would also ask
// aligned_alloc for sizes that are no multiple of the alignment, which some C libraries refuse. They are switched off.
//
#pragma once

#include <rosin/math/fft_policy.hpp>

#ifndef POCKETFFT_NO_VECTORS
#define POCKETFFT_NO_VECTORS
#endif
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // a false alarm in its Bluestein transform, at -O3
#endif
#include <pocketfft_hdronly.h>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

#include <algorithm>
#include <complex>
#include <cstddef>

namespace rosin {

/// pocketfft's transform of one length: real over float and double, complex over std::complex of these.
template <class T>
class pocketfft_fft;

template <class T>
class pocketfft_fft<std::complex<T>> {
public:
  using complex_type = std::complex<T>;

  explicit pocketfft_fft(std::size_t n) : plan_(n) {}
  [[nodiscard]] std::size_t size() const noexcept { return plan_.length(); }

  void forward(const complex_type* in, complex_type* out) noexcept { run(in, out, T(1), true); }
  void inverse(const complex_type* in, complex_type* out) noexcept {
    run(in, out, static_cast<T>(1.0 / static_cast<double>(size())), false);
  }

private:
  void run(const complex_type* in, complex_type* out, T scale, bool forward) {
    std::copy_n(in, size(), out);
    plan_.exec(reinterpret_cast<pocketfft::detail::cmplx<T>*>(out), scale, forward);
  }

  pocketfft::detail::pocketfft_c<T> plan_;
};

template <class T>
class pocketfft_fft {
public:
  using complex_type = std::complex<T>;

  explicit pocketfft_fft(std::size_t n) : plan_(n) {}
  [[nodiscard]] std::size_t size() const noexcept { return plan_.length(); }

  /// pocketfft packs r0 r1 i1 r2 i2 ...: written one place further on, all but r0 stands where it belongs.
  void forward(const T* in, complex_type* out) noexcept {
    T* const packed = reinterpret_cast<T*>(out) + 1;
    std::copy_n(in, size(), packed);
    plan_.exec(packed, T(1), true);
    out[0] = packed[0];
    if (size() % 2 == 0) out[size() / 2].imag(T(0));
  }

  void inverse(const complex_type* in, T* out) noexcept {
    out[0] = in[0].real();
    for (std::size_t k = 1; 2 * k < size(); ++k) {
      out[2 * k - 1] = in[k].real();
      out[2 * k] = in[k].imag();
    }
    if (size() % 2 == 0) out[size() - 1] = in[size() / 2].real();
    plan_.exec(out, static_cast<T>(1.0 / static_cast<double>(size())), false);
  }

private:
  pocketfft::detail::pocketfft_r<T> plan_;
};

}  // namespace rosin
