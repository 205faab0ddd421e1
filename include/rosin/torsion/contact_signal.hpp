// tier: hosted
// SPDX-License-Identifier: MIT
//
// One signal of a take, ready to be put through many transfer functions: transformed once, multiplied and transformed back for
// each. Whatever is compared while the string sticks goes through smooth_window besides: a squared cosine over the whole band,
// whose kernel is confined to a few samples, whereas that of a flat band with steep edges rings from every slip far into the
// sticking. Before the record the signal had its first value for ever; behind it, it returns gently to it in a padding.
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

/// cos^2(pi f / (2 edge)), zero from the edge on.
struct smooth_window {
  double edge_Hz = 0;

  [[nodiscard]] double operator()(double frequency_Hz) const noexcept {
    if (!(std::abs(frequency_Hz) < edge_Hz)) return 0;
    const double c = std::cos(0.5 * std::numbers::pi * frequency_Hz / edge_Hz);
    return c * c;
  }
  /// Samples to either side beyond which the kernel is below 1e-3 of what it integrates to.
  [[nodiscard]] std::size_t reach(double rate_Hz) const noexcept {
    return static_cast<std::size_t>(std::ceil(1.75 * rate_Hz / edge_Hz));
  }
};

template <class Fft = eigen_fft<double>>
class contact_signal {
public:
  /// `memory_s`: how long the longest transfer function rings. Preconditions: all samples are numbers, there is at least one.
  contact_signal(std::span<const double> samples, double rate_Hz, double memory_s = 0.03)
      : samples_{samples.size()}, rate_Hz_{rate_Hz}, first_{samples.front()},
        fft_(fast_size(samples.size() + padding(rate_Hz, memory_s))) {
    const std::size_t pad = padding(rate_Hz, memory_s);
    buffer_.assign(fft_.size(), 0.0);
    for (std::size_t i = 0; i < samples_; ++i) buffer_[i] = samples[i] - first_;
    const double end = buffer_[samples_ - 1];
    for (std::size_t i = 0; i < pad / 2; ++i)
      buffer_[samples_ + i] =
          0.5 * end * (1 + std::cos(std::numbers::pi * static_cast<double>(i + 1) / static_cast<double>(pad / 2 + 1)));
    bins_.resize(fft_.size() / 2 + 1);
    work_.resize(bins_.size());
    fft_.forward(buffer_.data(), bins_.data());
  }

  [[nodiscard]] std::size_t size() const noexcept { return samples_; }

  /// Transfer functions are asked at 0 and multiples of this.
  [[nodiscard]] double bin_Hz() const noexcept { return rate_Hz_ / static_cast<double>(fft_.size()); }

  /// The signal through a transfer function of the frequency in Hz and the window; the transfer function is asked inside it only,
  /// all at once if it can be (on_grid).
  template <class Transfer>
  [[nodiscard]] std::vector<double> through(const smooth_window& window, const Transfer& transfer) {
    const double step = bin_Hz();
    look_through(window);
    const std::size_t used = windowed_.size();
    if constexpr (requires { transfer.on_grid(step, used); }) {
      const auto values = transfer.on_grid(step, used);
      for (std::size_t k = 0; k < used; ++k) work_[k] = windowed_[k] * values[k];
    } else {
      for (std::size_t k = 0; k < used; ++k)
        work_[k] = windowed_[k] * std::complex<double>(transfer(static_cast<double>(k) * step));
    }
    return back(used, first_ * std::complex<double>(transfer(0.0)).real());
  }

  /// The sum of two signals of one take, each through a transfer function of the bin, asked for the first `bins` only.
  template <class Own, class Others>
  [[nodiscard]] std::vector<double> through_with(contact_signal& other, const smooth_window& window, std::size_t bins,
                                                 const Own& own, const Others& others) {
    look_through(window), other.look_through(window);
    const std::size_t used = std::min(bins, windowed_.size());
    for (std::size_t k = 0; k < used; ++k) work_[k] = windowed_[k] * own(k) + other.windowed_[k] * others(k);
    return back(used, used == 0 ? 0.0 : first_ * own(0).real() + other.first_ * others(0).real());
  }

private:
  /// The samples of a spectrum of so many bins in work_, on a steady level.
  [[nodiscard]] std::vector<double> back(std::size_t used, double steady) {
    std::fill(work_.begin() + static_cast<std::ptrdiff_t>(used), work_.end(), 0.0);
    fft_.inverse(work_.data(), buffer_.data());
    std::vector<double> out(samples_);
    for (std::size_t i = 0; i < samples_; ++i) out[i] = buffer_[i] + steady;
    return out;
  }

  /// The spectrum through a window, as far as the window reaches: kept until another is asked for.
  void look_through(const smooth_window& window) {
    if (!windowed_.empty() && window.edge_Hz == edge_Hz_) return;
    edge_Hz_ = window.edge_Hz;
    windowed_.clear();
    for (std::size_t k = 0; k < bins_.size(); ++k) {
      const double w = window(static_cast<double>(k) * bin_Hz());
      if (!(w > 0)) break;
      windowed_.push_back(w * bins_[k]);
    }
  }

  static std::size_t padding(double rate_Hz, double memory_s) { return static_cast<std::size_t>(2 * memory_s * rate_Hz) + 64; }

  std::size_t samples_;
  double rate_Hz_, first_;
  Fft fft_;
  std::vector<double> buffer_;
  std::vector<std::complex<double>> bins_, work_, windowed_;
  double edge_Hz_ = 0;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
