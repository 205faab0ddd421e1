// tier: hosted
// SPDX-License-Identifier: MIT
//
// A stroke as its fit sees it: the spectra of both forces over the whole record, up to an edge, and a window in time that what is
// made of them goes through. What the ends of a string tell of its contact now, they tell before and after: the first and last
// transit of a record is not known, and a record that is cut off there must not say otherwise. So the mismatch of the two ends is
// made of the whole record's spectra first, and weighed down to nothing at both ends of the record then.
//
#pragma once

#include <rosin/calibrate/stroke_layout.hpp>
#include <rosin/math/fft.hpp>
#include <rosin/propagate/band.hpp>

#include <span>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

class stroke_spectra {
public:
  using complex = std::complex<double>;

  /// `transit_s`: the longer of the two passages, as far as known. Bins from low_Hz to edge_Hz are used.
  stroke_spectra(const stroke_take& take, double low_Hz, double edge_Hz, double transit_s)
      : samples_{take.force_N[0].size()}, edge_{edge_Hz, std::min(1.08 * edge_Hz, 0.49 * take.rate_Hz)}, grid_{1} {
    const double ringing_s = 8 / (edge_.stop_Hz - edge_.pass_Hz), guard_s = transit_s + ringing_s;
    const std::size_t n = fast_size(samples_ + static_cast<std::size_t>(2 * guard_s * take.rate_Hz));
    bin_Hz_ = take.rate_Hz / static_cast<double>(n);
    first_ = static_cast<std::size_t>(std::ceil(low_Hz / bin_Hz_));
    last_ = static_cast<std::size_t>(std::floor(edge_.pass_Hz / bin_Hz_));
    const auto stop = static_cast<std::size_t>(std::ceil(edge_.stop_Hz / bin_Hz_));
    grid_ = eigen_fft<double>(fast_size(2 * stop + 2));
    eigen_fft<double> whole(n);
    std::vector<double> padded(n);
    std::vector<complex> bins(n / 2 + 1);
    for (std::size_t end = 0; end < 2; ++end) {
      std::fill(std::copy(take.force_N[end].begin(), take.force_N[end].end(), padded.begin()), padded.end(), 0.0);
      whole.forward(padded.data(), bins.data());
      for (std::size_t k = 0; k <= stop; ++k) force_[end].push_back(bins[k]);
    }
    make_window(guard_s, take.rate_Hz);
    for (std::size_t end = 0; end < 2; ++end) windowed_[end] = within(force_[end]);
  }

  [[nodiscard]] double bin_Hz() const noexcept { return bin_Hz_; }
  [[nodiscard]] std::size_t first() const noexcept { return first_; }
  [[nodiscard]] std::size_t last() const noexcept { return last_; }             ///< inclusive
  [[nodiscard]] std::size_t bins() const noexcept { return force_[0].size(); }  ///< that are made, from 0 Hz on
  /// Of the whole record, and of what the window leaves of it.
  [[nodiscard]] std::span<const complex> force(std::size_t end) const noexcept { return force_[end]; }
  [[nodiscard]] std::span<const complex> windowed(std::size_t end) const noexcept { return windowed_[end]; }

  /// What white noise of one newton makes of a bin behind the window: E |X|^2.
  [[nodiscard]] double noise_power() const noexcept { return noise_power_; }
  /// Independent complex values a bin: there are more bins than those.
  [[nodiscard]] double independence() const noexcept { return independence_; }

  /// The spectrum (of bins() values) of a signal, behind the window in time.
  [[nodiscard]] std::vector<complex> within(std::span<const complex> spectrum) const {
    const std::size_t m = grid_.size();
    std::vector<complex> bins(m / 2 + 1, complex(0));
    for (std::size_t k = 0; k < spectrum.size(); ++k) {
      const double f = static_cast<double>(k) * bin_Hz_;
      bins[k] = spectrum[k] * edge_(f);
    }
    std::vector<double> signal(m);
    eigen_fft<double> fft = grid_;
    fft.inverse(bins.data(), signal.data());
    for (std::size_t i = 0; i < m; ++i) signal[i] *= window_[i];
    fft.forward(signal.data(), bins.data());
    bins.resize(spectrum.size());
    return bins;
  }

private:
  /// Zero in the guards at both ends and behind the record, then a quarter of a wave up to one.
  void make_window(double guard_s, double rate_Hz) {
    const double length_s = static_cast<double>(samples_) / rate_Hz;
    const double taper_s = std::max(2 * guard_s, 0.04 * length_s), step_s = 1 / (bin_Hz_ * static_cast<double>(grid_.size()));
    window_.assign(grid_.size(), 0.0);
    double two = 0, four = 0;
    for (std::size_t i = 0; i < window_.size(); ++i) {
      const double t = static_cast<double>(i) * step_s, in = std::min(t, length_s - t) - guard_s;
      if (in > 0) window_[i] = in < taper_s ? std::pow(std::sin(0.5 * std::numbers::pi * in / taper_s), 2) : 1.0;
      two += std::pow(window_[i], 2), four += std::pow(window_[i], 4);
    }
    noise_power_ = two * step_s * rate_Hz;
    independence_ = four > 0 ? two * two / (four * static_cast<double>(window_.size())) : 0.0;
  }

  std::size_t samples_;
  double bin_Hz_ = 0;
  band edge_;
  std::size_t first_ = 0, last_ = 0;
  std::array<std::vector<complex>, 2> force_, windowed_;
  eigen_fft<double> grid_;
  std::vector<double> window_;
  double noise_power_ = 0, independence_ = 0;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
