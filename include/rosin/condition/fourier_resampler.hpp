// tier: hosted
// SPDX-License-Identifier: MIT
//
// A periodic record at another number of samples per period: the trigonometric polynomial through the samples, evaluated
// anew. Exact for what lies below both halves of the sampling rate; what lies above the new half is left out, not folded.
//
// A record of even length has one bin at half its sampling rate, which stands for +n/2 and -n/2 together: between longer
// lengths it is shared out to both (its cosine goes on, the sine that no sample showed stays zero); where the new length
// ends there, both are gathered in one, which is what sampling that component gives.
//
// Why no padding to a quick length: the ends would no longer meet, and the record would no longer be periodic. Any length
// is quick enough, since the transform takes large primes by the chirp-z.
//
#pragma once

#include <rosin/math/fft.hpp>
#include <rosin/math/fft_policy.hpp>

#include <algorithm>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// From periodic records of `from` samples to `to` samples; both at least 1. Sample 0 stays sample 0.
template <class T, RealFft<T> Fft = eigen_fft<T>>
class fourier_resampler {
public:
  fourier_resampler(std::size_t from, std::size_t to) : forward_(from), inverse_(to), bins_(std::max(from, to) / 2 + 1) {}

  [[nodiscard]] std::size_t from() const noexcept { return forward_.size(); }
  [[nodiscard]] std::size_t to() const noexcept { return inverse_.size(); }

  /// in.size() == from(), out.size() == to(). Allocates nothing, unless the Fft does.
  void process(std::span<const T> in, std::span<T> out) noexcept {
    forward_.forward(in.data(), bins_.data());
    const std::size_t shorter = std::min(from(), to());
    if (shorter % 2 == 0 && from() != to())
      bins_[shorter / 2] = to() > from() ? T(0.5) * bins_[shorter / 2].real() : T(2) * bins_[shorter / 2].real();
    const T scale = static_cast<T>(static_cast<double>(to()) / static_cast<double>(from()));
    for (std::size_t k = 0; k <= shorter / 2; ++k) bins_[k] *= scale;
    std::fill(bins_.begin() + static_cast<std::ptrdiff_t>(shorter / 2 + 1), bins_.end(), std::complex<T>{});
    inverse_.inverse(bins_.data(), out.data());
  }

private:
  Fft forward_, inverse_;
  std::vector<std::complex<T>> bins_;
};

/// One record. `to` >= 1; an empty record stays empty.
template <class T>
[[nodiscard]] std::vector<T> fourier_resample(std::span<const T> record, std::size_t to) {
  if (record.empty()) return {};
  std::vector<T> out(to);
  fourier_resampler<T>{record.size(), to}.process(record, out);
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
