// tier: hosted
// SPDX-License-Identifier: MIT
//
// A record as one period of a spectrum: its first sample held before it, its last one after it, and from there gently back, half
// a cosine, to where it begins. So a filter meets no step where the period closes, and what wraps around falls into the padding.
//
#pragma once

#include <rosin/math/fft.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Spectra of records of one length, and back. At least `pad` samples (> 0) on either side.
class held_record {
public:
  template <class = void>
  held_record(std::size_t samples, std::size_t pad)
      : samples_{samples}, pad_{pad}, size_{fast_size(samples + 2 * pad)}, fft_(size_) {}

  [[nodiscard]] std::size_t bins() const { return size_ / 2 + 1; }
  [[nodiscard]] double frequency_Hz(std::size_t k, double rate_Hz) const {
    return static_cast<double>(k) * rate_Hz / static_cast<double>(size_);
  }
  template <class = void>
  [[nodiscard]] std::vector<std::complex<double>> spectrum(std::span<const double> x) {
    std::vector<double> wide(size_);
    for (std::size_t i = 0; i < size_; ++i) wide[i] = x[std::min(samples_ - 1, i < pad_ ? 0 : i - pad_)];
    for (std::size_t i = samples_ + pad_; i < size_; ++i) {  // back to where it begins, gently
      const double u = static_cast<double>(i - samples_ - pad_) / static_cast<double>(size_ - samples_ - pad_);
      wide[i] += (wide[0] - x.back()) * 0.5 * (1 - std::cos(std::numbers::pi * u));
    }
    std::vector<std::complex<double>> out(bins());
    fft_.forward(wide.data(), out.data());
    return out;
  }
  template <class = void>
  [[nodiscard]] std::vector<double> record(std::vector<std::complex<double>> spectrum) {
    std::vector<double> wide(size_);
    fft_.inverse(spectrum.data(), wide.data());
    return {wide.begin() + static_cast<std::ptrdiff_t>(pad_), wide.begin() + static_cast<std::ptrdiff_t>(pad_ + samples_)};
  }

private:
  std::size_t samples_, pad_, size_;
  eigen_fft<double> fft_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
