// tier: hosted
// SPDX-License-Identifier: MIT
//
// The discrete Fourier transform of any length by convolution with a chirp (L. Bluestein, IEEE Trans. Audio
// Electroacoust. 18, 1970, 451): with j k = (j^2 + k^2 - (k - j)^2) / 2 and w[j] = exp(-i pi j^2 / n)
//
//     X[k] = w[k] sum_j (x[j] w[j]) conj(w[k - j])
//
// The sum is a convolution, made cyclic of a fast length >= 2n - 1; so a prime length costs three transforms of
// about twice the size instead of n^2. The angle is reduced in integers (j^2 mod 2n) and is exact for any n < 2^32.
//
#pragma once

#include <rosin/math/fft_policy.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rosin {

/// Complex transform of any length n >= 1 on top of a policy that is called with fast_size(2n - 1) only.
template <class T, class Fft>
class chirp_z {
public:
  using complex_type = std::complex<T>;

  explicit chirp_z(std::size_t n)
      : fft_(fast_size(2 * n - 1)), chirp_(n), kernel_(fft_.size()), a_(fft_.size()), b_(fft_.size()) {
    static_assert(ComplexFft<Fft, T>);
    for (std::size_t j = 0; j < n; ++j) chirp_[j] = chirp_at(j, n);
    const T scale = T(1) / static_cast<T>(fft_.size());
    for (std::size_t j = 0; j < n; ++j) a_[j] = std::conj(chirp_[j]);
    for (std::size_t j = 1; j < n; ++j) a_[fft_.size() - j] = a_[j];
    fft_.forward(a_.data(), kernel_.data());
    for (complex_type& bin : kernel_) bin *= scale;
  }

  [[nodiscard]] std::size_t size() const noexcept { return chirp_.size(); }

  void forward(const complex_type* in, complex_type* out) noexcept {
    for (std::size_t j = 0; j < size(); ++j) a_[j] = times(in[j], chirp_[j]);
    convolve();
    for (std::size_t k = 0; k < size(); ++k) out[k] = times(std::conj(a_[k]), chirp_[k]);
  }

  /// 1/n conj(forward(conj(x))).
  void inverse(const complex_type* in, complex_type* out) noexcept {
    for (std::size_t j = 0; j < size(); ++j) a_[j] = times(std::conj(in[j]), chirp_[j]);
    convolve();
    const T scale = T(1) / static_cast<T>(size());
    for (std::size_t k = 0; k < size(); ++k) out[k] = scale * times(a_[k], std::conj(chirp_[k]));
  }

private:
  static complex_type chirp_at(std::uint64_t j, std::uint64_t n) {
    constexpr double pi = 3.14159265358979323846;
    const double angle = pi * static_cast<double>(j * j % (2 * n)) / static_cast<double>(n);
    return {static_cast<T>(std::cos(angle)), static_cast<T>(-std::sin(angle))};
  }

  /// The product without the library's detour for infinities.
  static complex_type times(complex_type x, complex_type y) noexcept {
    return {x.real() * y.real() - x.imag() * y.imag(), x.real() * y.imag() + x.imag() * y.real()};
  }

  /// a := conj(a * kernel): the second forward transform, of a conjugate, stands for the inverse one.
  void convolve() noexcept {
    std::fill(a_.begin() + static_cast<std::ptrdiff_t>(size()), a_.end(), complex_type{});
    fft_.forward(a_.data(), b_.data());
    for (std::size_t k = 0; k < b_.size(); ++k) b_[k] = std::conj(times(b_[k], kernel_[k]));
    fft_.forward(b_.data(), a_.data());
  }

  Fft fft_;
  std::vector<complex_type> chirp_, kernel_, a_, b_;
};

}  // namespace rosin
