// tier: hosted
// SPDX-License-Identifier: MIT
//
// A periodic record later by any real number of samples: every bin turned by exp(-2 pi i k d / n). The turns of the whole
// samples in d are counted in integers, so that the error does not grow with the delay. The bin at half the sampling rate
// (even n) keeps what a delayed cosine shows there, its cos(pi d).
//
// For a record that does not repeat, see condition/fractional_delay.hpp: what is shifted here comes in at the other end.
//
#pragma once

#include <rosin/math/fft.hpp>
#include <rosin/math/fft_policy.hpp>

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace rosin {

/// Delays of periodic records of n samples.
template <class T, RealFft<T> Fft = eigen_fft<T>>
class fourier_shift {
public:
  explicit fourier_shift(std::size_t n) : fft_(n), bins_(n / 2 + 1) {}

  [[nodiscard]] std::size_t size() const noexcept { return fft_.size(); }

  /// out(j) = in(j - delay_samples); negative: earlier. Both spans have size() samples and may be the same.
  void process(std::span<const T> in, std::span<T> out, double delay_samples) noexcept {
    const std::size_t n = size();
    const double whole = std::floor(delay_samples), fraction = delay_samples - whole;
    const double length = static_cast<double>(n);
    const auto turns = static_cast<std::size_t>(whole - length * std::floor(whole / length)) % n;
    fft_.forward(in.data(), bins_.data());
    for (std::size_t k = 1; k < bins_.size(); ++k) {
      const double cycles = (static_cast<double>(k * turns % n) + static_cast<double>(k) * fraction) / length;
      const std::complex<double> turned = std::complex<double>{bins_[k]} * std::polar(1.0, -2 * std::numbers::pi * cycles);
      bins_[k] = {static_cast<T>(turned.real()), static_cast<T>(turned.imag())};
    }
    fft_.inverse(bins_.data(), out.data());
  }

private:
  Fft fft_;
  std::vector<std::complex<T>> bins_;
};

}  // namespace rosin
