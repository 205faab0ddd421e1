// tier: hosted
// SPDX-License-Identifier: MIT
//
// Whole records through a matrix of FIR filters, y[p] = sum_m h[p][m] * x[m], by overlap-save in blocks that stay in the
// cache. Two things make it several times faster than transforms of the whole record:
//
//  - two real channels travel as one complex signal, z = x[0] + i x[1], and so do two outputs. In time,
//        y[0] + i y[1] = a * z + b * conj(z),    a = ((h00 + h11) + i (h10 - h01)) / 2,
//                                                b = ((h00 - h11) + i (h10 + h01)) / 2,
//    and the spectrum of conj(z) is conj(Z(-k)): no spectrum of a real signal is ever unpacked;
//  - as many blocks as a vector register has lanes are transformed side by side (math/lane_fft.hpp).
//
// Beyond its ends a record counts as zero; valid() says which outputs depend on none of those zeros.
//
#pragma once

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

namespace rosin {

/// y[n] = sum_j taps[j] x[n - first - j]: a negative `first` looks ahead. Without taps it is zero.
template <class K>
concept FirKernel = requires(const K& kernel) {
  { kernel.first } -> std::convertible_to<int>;
  { kernel.taps.size() } -> std::convertible_to<std::size_t>;
  { kernel.taps[0] } -> std::convertible_to<double>;
};

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
  /// kernels[p * inputs + m] leads from input m to output p, for kernels.size() / inputs outputs.
  /// `block` is the length of the transforms, a power of two above the span of the taps; 0: the quickest for it.
  template <FirKernel Kernel>
  block_convolver(std::size_t inputs, const std::vector<Kernel>& kernels, std::size_t block = 0)
      : block_convolver(inputs, kernels, extent_of(kernels), block) {}

  [[nodiscard]] std::size_t inputs() const noexcept { return inputs_; }
  [[nodiscard]] std::size_t outputs() const noexcept { return outputs_; }
  [[nodiscard]] std::size_t block_size() const noexcept { return fft_.size(); }

  /// The outputs of a record of `length` samples that depend on samples of the record only.
  [[nodiscard]] sample_range valid(std::size_t length) const noexcept {
    const std::size_t begin = std::min(length, static_cast<std::size_t>(std::max(0, taps_.last)));
    const std::size_t lost = static_cast<std::size_t>(std::max(0, -taps_.first));
    return {begin, std::max(begin, length - std::min(length, lost))};
  }

  /// All spans have one length, and none of `out` overlaps one of `in`. Allocates nothing, unless the Fft does.
  void process(std::span<const std::span<const T>> in, std::span<const std::span<T>> out) noexcept {
    const std::size_t length = in[0].size();
    for (std::size_t begin = 0; begin < length; begin += lanes * useful_) {
      const std::ptrdiff_t start = static_cast<std::ptrdiff_t>(begin) - taps_.last;
      const bool in_inside = start >= 0 && static_cast<std::size_t>(start) + lanes * useful_ + fft_.size() <= length;
      const bool out_inside = begin + lanes * useful_ <= length;
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
  struct extent {
    int first, last;
    [[nodiscard]] std::size_t taps() const noexcept { return static_cast<std::size_t>(last - first + 1); }
  };

  template <class Kernel>
  block_convolver(std::size_t inputs, const std::vector<Kernel>& kernels, extent taps, std::size_t block)
      : inputs_{inputs}, outputs_{kernels.size() / inputs}, taps_{taps}, fft_(block > 0 ? block : quickest_block(taps.taps())),
        useful_{fft_.size() - taps.taps() + 1}, mirror_(fft_.size()), spectra_((inputs + 1) / 2, fft_.make_buffer()),
        sum_(fft_.make_buffer()) {
    const std::size_t n = fft_.size();
    for (std::size_t k = 0; k < n; ++k) mirror_[fft_.position(k)] = static_cast<std::uint32_t>(fft_.position((n - k) % n));
    for (std::size_t p = 0; p < outputs_; p += 2)
      for (std::size_t m = 0; m < inputs_; m += 2) weights_.push_back(weights_of(kernels, p, m));
  }

  template <class Kernel>
  static extent extent_of(const std::vector<Kernel>& kernels) noexcept {
    extent all{0, 0};
    bool any = false;
    for (const Kernel& kernel : kernels) {
      if (kernel.taps.size() == 0) continue;
      const int first = kernel.first, last = first + static_cast<int>(kernel.taps.size()) - 1;
      all = any ? extent{std::min(all.first, first), std::max(all.last, last)} : extent{first, last};
      any = true;
    }
    return all;
  }

  /// Work per useful sample is (log2 n + what each sample costs besides) n / (n - taps + 1); a batch should stay in the cache.
  static std::size_t quickest_block(std::size_t taps) noexcept {
    constexpr std::size_t cache_bytes = 256 * 1024;
    std::size_t best = 16, n = 16;
    double least = 0;
    for (double log2n = 4; n / 16 <= taps; n *= 2, ++log2n) {
      if (n < 2 * taps) continue;
      const double spill = n * sizeof(complex) > cache_bytes ? 1.3 : 1.0;
      const double work = spill * (log2n + 6) * static_cast<double>(n) / static_cast<double>(n - taps + 1);
      if (least == 0 || work < least) least = work, best = n;
    }
    return best;
  }

  /// Re A, Im A, Re B, Im B of every bin where it stands, for outputs p, p + 1 and inputs m, m + 1.
  template <class Kernel>
  buffer weights_of(const std::vector<Kernel>& kernels, std::size_t p, std::size_t m) const {
    const std::size_t n = fft_.size();
    std::vector<double> a(2 * n), b(2 * n);  // taps as complex numbers, then their spectra: in double for any T
    const auto add = [&](std::size_t output, std::size_t input, std::size_t part, double sign_a, double sign_b) {
      if (output >= outputs_ || input >= inputs_) return;
      const Kernel& kernel = kernels[output * inputs_ + input];
      for (std::size_t j = 0; j < kernel.taps.size(); ++j) {
        const std::size_t at = 2 * (static_cast<std::size_t>(kernel.first - taps_.first) + j) + part;
        a[at] += sign_a * static_cast<double>(kernel.taps[j]);
        b[at] += sign_b * static_cast<double>(kernel.taps[j]);
      }
    };
    add(p, m, 0, 1, 1), add(p + 1, m + 1, 0, 1, -1), add(p + 1, m, 1, 1, 1), add(p, m + 1, 1, -1, 1);
    const lane_fft<double, 1> exact(n);
    exact.forward(a.data()), exact.forward(b.data());

    buffer weights(4 * n);
    const double scale = 0.5 / fft_.gain();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t from = 2 * exact.position(k), to = 4 * fft_.position(k);
      for (std::size_t part = 0; part < 2; ++part) {
        weights[to + part] = static_cast<T>(scale * a[from + part]);
        weights[to + 2 + part] = static_cast<T>(scale * b[from + part]);
      }
    }
    return weights;
  }

  /// Lane l begins at sample start + l useful_.
  template <bool Inside>
  void load(std::span<const std::span<const T>> in, std::size_t pair, std::ptrdiff_t start) noexcept {
    for (std::size_t part = 0; part < 2; ++part) {
      T* row = spectra_[pair].data() + part * lanes;
      const std::size_t channel = 2 * pair + part;
      const std::span<const T> x = channel < inputs_ ? in[channel] : std::span<const T>{};
      const std::size_t at = static_cast<std::size_t>(start);  // before the record: a huge number, no sample of it
      std::size_t k = 0;
      if (Inside && !x.empty())
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
    for (std::size_t part = 0; part < 2 && 2 * pair + part < outputs_; ++part) {
      const T* row = sum_.data() + (taps_.taps() - 1) * step + part * lanes;
      const std::span<T> y = out[2 * pair + part];
      std::size_t k = 0;
      if (Inside)
        for (; k + lanes <= useful_; k += lanes, row += lanes * step) transpose<T, lanes>(row, step, &y[begin + k], useful_);
      for (; k < useful_; ++k, row += step)
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const std::size_t n = begin + lane * useful_ + k;
          if (n < y.size()) y[n] = row[lane];
        }
    }
  }

  std::size_t inputs_, outputs_;
  extent taps_;
  transform fft_;
  std::size_t useful_;                 // outputs per block
  std::vector<std::uint32_t> mirror_;  // where bin -k stands, by where bin k stands
  std::vector<buffer> weights_;        // per pair of outputs and pair of inputs
  std::vector<buffer> spectra_;        // per pair of inputs, `lanes` blocks
  buffer sum_;
};

}  // namespace rosin
