// tier: hosted
// SPDX-License-Identifier: MIT
//
// The default Fourier transform: Eigen's own, which needs nothing beyond what the library needs anyway. Its butterfly
// for an odd radix p costs p operations per sample, so a length with a large prime factor would take quadratic time:
// such lengths are sent through chirp_z (Bluestein), whose inner length has the factors 2, 3 and 5 only.
//
#pragma once

#include <rosin/math/chirp_z.hpp>
#include <rosin/math/fft_policy.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/FFT>

#include <complex>
#include <cstddef>
#include <vector>

namespace rosin {

/// Eigen's transform of one length: real over float and double, complex over std::complex of these.
template <class T>
class eigen_fft;

template <class T>
class eigen_fft<std::complex<T>> {
public:
  using complex_type = std::complex<T>;

  /// Above this prime factor the chirp-z transform is quicker (bench/math/fft_bench.cpp).
  static constexpr std::size_t largest_direct_prime = 23;

  explicit eigen_fft(std::size_t n) : size_{n} {
    if (largest_prime_factor(n) > largest_direct_prime) {
      chirp_.emplace_back(n);
    } else {  // Eigen makes its tables when first called; do it here, so that no later call allocates
      std::vector<complex_type> in(n), out(n);
      forward(in.data(), out.data());
      inverse(in.data(), out.data());
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  void forward(const complex_type* in, complex_type* out) noexcept {
    if (size_ == 1) out[0] = in[0];
    else if (chirp_.empty()) plan_.fwd(out, in, static_cast<Eigen::Index>(size_));
    else chirp_[0].forward(in, out);
  }

  void inverse(const complex_type* in, complex_type* out) noexcept {
    if (size_ == 1) out[0] = in[0];
    else if (chirp_.empty()) plan_.inv(out, in, static_cast<Eigen::Index>(size_));
    else chirp_[0].inverse(in, out);
  }

private:
  std::size_t size_;
  Eigen::FFT<T> plan_;
  std::vector<chirp_z<T, eigen_fft>> chirp_;  // none or one: unlike std::optional, a vector may hold what is not complete yet
};

template <class T>
class eigen_fft {
public:
  using complex_type = std::complex<T>;

  explicit eigen_fft(std::size_t n) : size_{n} {
    plan_.SetFlag(Eigen::FFT<T>::HalfSpectrum);
    if (largest_prime_factor(n) > eigen_fft<complex_type>::largest_direct_prime) {
      whole_.emplace_back(n);
      in_.resize(n);
      out_.resize(n);
    } else {
      std::vector<T> samples(n);
      std::vector<complex_type> bins(n / 2 + 1);
      forward(samples.data(), bins.data());
      inverse(bins.data(), samples.data());
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  void forward(const T* in, complex_type* out) noexcept {
    if (size_ == 1) {
      out[0] = in[0];
    } else if (whole_.empty()) {
      plan_.fwd(out, in, static_cast<Eigen::Index>(size_));
    } else {
      for (std::size_t j = 0; j < size_; ++j) in_[j] = in[j];
      whole_[0].forward(in_.data(), out_.data());
      for (std::size_t k = 0; k <= size_ / 2; ++k) out[k] = out_[k];
    }
    out[0].imag(T(0));
    if (size_ % 2 == 0) out[size_ / 2].imag(T(0));
  }

  void inverse(const complex_type* in, T* out) noexcept {
    if (size_ == 1) {
      out[0] = in[0].real();
    } else if (whole_.empty()) {
      plan_.inv(out, in, static_cast<Eigen::Index>(size_));
    } else {
      for (std::size_t k = 0; k <= size_ / 2; ++k) in_[k] = in[k];
      for (std::size_t k = 1; k <= (size_ - 1) / 2; ++k) in_[size_ - k] = std::conj(in[k]);
      whole_[0].inverse(in_.data(), out_.data());
      for (std::size_t j = 0; j < size_; ++j) out[j] = out_[j].real();
    }
  }

private:
  std::size_t size_;
  Eigen::FFT<T> plan_;
  std::vector<eigen_fft<complex_type>> whole_;  // none or one: the complex transform of the same length
  std::vector<complex_type> in_, out_;
};

}  // namespace rosin
