// tier: hosted
// SPDX-License-Identifier: MIT
//
// Whole records through a matrix of FIR filters, y[p] = sum_m h[p][m] * x[m], by overlap-save in blocks that stay in the
// cache. Two things make it several times faster than transforms of the whole record:
//
//  - two real channels travel as one complex signal z = x[0] + i x[1], and so do two outputs, y[0] + i y[1] = a * z +
//    b * conj(z) (overlap_save_design.hpp). The spectrum of conj(z) is conj(Z(-k)): no spectrum of a real signal is ever
//    unpacked. A lone channel is split in two that go through the same filter;
//  - as many blocks as a vector register has lanes are transformed side by side (math/lane_fft.hpp).
//
// Beyond its ends a record counts as zero; valid() says which outputs depend on none of those zeros.
//
#pragma once

#include <rosin/condition/overlap_save_design.hpp>
#include <rosin/math/block_transform.hpp>
#include <rosin/math/lane_fft.hpp>
#include <rosin/math/lanes.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Samples begin ... end - 1; none if begin == end.
struct sample_range {
  std::size_t begin, end;
};

/// A fixed matrix of filters for records of any length. Fft: lane_fft, or any ComplexFft.
template <class T, class Fft = lane_fft<T>>
class block_convolver {
  using transform = block_transform<T, Fft>;
  using buffer = typename transform::buffer;
  static constexpr std::size_t lanes = transform::lanes;
  static constexpr std::size_t step = 2 * lanes;
  using complex = lane_complex<T, lanes>;

public:
  /// kernels[p * inputs + m] leads from input m to output p, for kernels.size() / inputs outputs; inputs >= 1.
  /// `block` is the length of the transforms, a power of two above the span of the taps; 0: the quickest for it.
  template <FirKernel Kernel>
  block_convolver(std::size_t inputs, const std::vector<Kernel>& kernels, std::size_t block = 0)
      : block_convolver(inputs, kernels, lags_of(kernels), block) {}

  [[nodiscard]] std::size_t inputs() const noexcept { return inputs_; }
  [[nodiscard]] std::size_t outputs() const noexcept { return outputs_; }
  [[nodiscard]] std::size_t block_size() const noexcept { return fft_.size(); }

  /// The outputs of a record of `length` samples that depend on samples of the record only.
  [[nodiscard]] sample_range valid(std::size_t length) const noexcept {
    const std::size_t begin = std::min(length, static_cast<std::size_t>(std::max(0, lags_.last)));
    const std::size_t lost = static_cast<std::size_t>(std::max(0, -lags_.first));
    return {begin, std::max(begin, length - std::min(length, lost))};
  }

  /// All spans have one length, and none of `out` overlaps one of `in`. Allocates nothing, unless the Fft does.
  void process(std::span<const std::span<const T>> in, std::span<const std::span<T>> out) noexcept {
    const std::size_t length = in[0].size();
    for (std::size_t begin = 0; begin < length; begin += hop_) {
      const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(begin) - lags_.last;
      const bool in_inside = start >= 0 && static_cast<std::size_t>(start) + hop_ + fft_.size() <= length;
      const bool out_inside = begin + hop_ <= length;
      for (std::size_t pair = 0; pair < spectra_.size(); ++pair) {
        in_inside ? load<true>(in, pair, start) : load<false>(in, pair, start);
        fft_.forward(spectra_[pair]);
      }
      for (std::size_t pair = 0; 2 * pair < outputs_; ++pair) {
        combine(pair);
        fft_.inverse(sum_);
        out_inside ? save<true>(out, pair, begin) : save<false>(out, pair, begin);
      }
    }
  }

private:
  template <class Kernel>
  block_convolver(std::size_t inputs, const std::vector<Kernel>& kernels, lag_range lags, std::size_t block)
      : inputs_{inputs}, outputs_{kernels.size() / inputs}, lags_{lags},
        fft_(block > 0 ? block : quickest_block(lags.taps(), sizeof(complex))), useful_{fft_.size() - lags.taps() + 1},
        hop_{lanes * useful_ * (lone() ? 2 : 1)}, mirror_(fft_.size()), spectra_((inputs + 1) / 2, fft_.make_buffer()),
        sum_(fft_.make_buffer()) {
    const std::size_t n = fft_.size();
    for (std::size_t k = 0; k < n; ++k) mirror_[fft_.position(k)] = static_cast<std::uint32_t>(fft_.position((n - k) % n));
    for (std::size_t p = 0; p < outputs_; p += 2)
      for (std::size_t m = 0; m < inputs_; m += 2) weights_.push_back(weights_of(kernels, p, m));
  }

  /// One filter: the channel's batches take the places of two channels in turn.
  [[nodiscard]] bool lone() const noexcept { return inputs_ == 1 && outputs_ == 1; }
  [[nodiscard]] std::size_t channel(std::size_t pair, std::size_t part) const noexcept { return lone() ? 0 : 2 * pair + part; }
  [[nodiscard]] std::size_t offset(std::size_t part) const noexcept { return lone() ? part * lanes * useful_ : 0; }

  /// Re A, Im A, Re B, Im B of every bin where it stands, for outputs p, p + 1 and inputs m, m + 1.
  template <class Kernel>
  buffer weights_of(const std::vector<Kernel>& kernels, std::size_t p, std::size_t m) const {
    const std::size_t n = fft_.size();
    pair_kernels pair{n, lags_.first};
    for (std::size_t output = 0; output < 2; ++output)
      for (std::size_t input = 0; input < 2; ++input)
        if (lone() && output == input) pair.add(kernels[0], output, input);
        else if (p + output < outputs_ && m + input < inputs_)
          pair.add(kernels[(p + output) * inputs_ + m + input], output, input);

    const lane_fft<double, 1> exact(n);  // in double for any T
    buffer weights(4 * n);
    for (std::size_t part = 0; part < 2; ++part) {
      double* const bins = reinterpret_cast<double*>((part == 0 ? pair.a : pair.b).data());
      exact.forward(bins);
      for (std::size_t k = 0; k < 2 * n; ++k)
        weights[4 * fft_.position(k / 2) + 2 * part + k % 2] =
            static_cast<T>(bins[2 * exact.position(k / 2) + k % 2] / fft_.gain());
    }
    return weights;
  }

  /// Lane l begins at sample start + l useful_.
  template <bool Inside>
  void load(std::span<const std::span<const T>> in, std::size_t pair, std::ptrdiff_t start) noexcept {
    for (std::size_t part = 0; part < 2; ++part) {
      T* row = spectra_[pair].data() + part * lanes;
      if (channel(pair, part) >= inputs_) {
        for (std::size_t k = 0; k < fft_.size(); ++k, row += step) std::fill_n(row, lanes, T(0));
        continue;
      }
      const std::span<const T> x = in[channel(pair, part)];
      const std::size_t at = static_cast<std::size_t>(start) + offset(part);  // before the record: a huge number, no sample of it
      std::size_t k = 0;
      if (Inside)
        for (; k + lanes <= fft_.size(); k += lanes, row += lanes * step) transpose<T, lanes>(&x[at + k], useful_, row, step);
      for (; k < fft_.size(); ++k, row += step)
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const std::size_t n = at + lane * useful_ + k;
          row[lane] = n < x.size() ? x[n] : T(0);
        }
    }
  }

  void combine(std::size_t output_pair) noexcept {
    for (std::size_t i = 0; i < fft_.size(); ++i) {
      complex sum{};
      for (std::size_t pair = 0; pair < spectra_.size(); ++pair) {
        const T* const spectrum = spectra_[pair].data();
        const T* const w = weights_[output_pair * spectra_.size() + pair].data() + 4 * i;
        sum = sum + complex::load(spectrum + i * step).times(w) + complex::load(spectrum + mirror_[i] * step).conj().times(w + 2);
      }
      sum.store(sum_.data() + i * step);
    }
  }

  template <bool Inside>
  void save(std::span<const std::span<T>> out, std::size_t pair, std::size_t begin) const noexcept {
    for (std::size_t part = 0; part < 2 && channel(pair, part) < outputs_; ++part) {
      const T* row = sum_.data() + (lags_.taps() - 1) * step + part * lanes;
      const std::span<T> y = out[channel(pair, part)];
      const std::size_t at = begin + offset(part);
      std::size_t k = 0;
      if (Inside)
        for (; k + lanes <= useful_; k += lanes, row += lanes * step) transpose<T, lanes>(row, step, &y[at + k], useful_);
      for (; k < useful_; ++k, row += step)
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const std::size_t n = at + lane * useful_ + k;
          if (n < y.size()) y[n] = row[lane];
        }
    }
  }

  std::size_t inputs_, outputs_;
  lag_range lags_;
  transform fft_;
  std::size_t useful_;                 // outputs per block
  std::size_t hop_;                    // outputs per batch of blocks
  std::vector<std::uint32_t> mirror_;  // where bin -k stands, by where bin k stands
  std::vector<buffer> weights_;        // per pair of outputs and pair of inputs
  std::vector<buffer> spectra_;        // per pair of inputs, `lanes` blocks
  buffer sum_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
