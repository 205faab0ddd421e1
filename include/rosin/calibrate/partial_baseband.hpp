// tier: hosted
// SPDX-License-Identifier: MIT
//
// One line of a long recording, brought down to zero frequency and a low rate. The whole record is transformed once; the bins
// around a centre, weighted by a smooth window W, are transformed back by themselves:
//
//     z(t) = 2 sum_{|k - k0| <= m} W((k - k0) df) X[k] exp(2 pi i (k - k0) df t) / N,      x = A cos(2 pi f t + p)  ->
//     z(t) = A exp(i p) exp(2 pi i (f - k0 df) t)
//
// That is exact heterodyning, filtering and decimation in one, without the design of a filter per line. W is a bell,
//
//     W(f) = exp(beta (sqrt(1 - (f / half width)^2) - 1)),    beta = 12,
//
// whose impulse response is over (to e^-beta) after two inverse half widths: that is how soon an attack is forgotten. A flat top
// would ring for much longer, and what rings is taken for decay. A line that is not at the centre, or decays, is W(detuning + i
// decay / 2 pi) times itself, exactly; fits divide by that.
//
#pragma once

#include <rosin/math/fft.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The window of a baseband; analytic, so that it has a value for damped lines too.
struct bell_window {
  double half_width_Hz = 0;

  template <class Frequency>
  [[nodiscard]] Frequency operator()(Frequency f_Hz) const {
    using std::exp, std::sqrt;
    constexpr double beta = 12;
    const Frequency x = f_Hz / half_width_Hz;
    return exp(beta * (sqrt(1.0 - x * x) - 1.0));
  }
};

/// A line and its surroundings at zero frequency: samples from the start of the recording on.
struct baseband_record {
  std::vector<std::complex<double>> samples;
  double rate_Hz = 0;
  double centre_Hz = 0;  ///< the frequency that became zero
  bell_window window;    ///< gain against f - centre
};

/// All basebands of one recording have one half width and one rate. Precondition: a signal that is not empty.
class baseband_bank {
public:
  template <class = void>
  baseband_bank(std::span<const double> signal, double rate_Hz, double half_width_Hz) : rate_Hz_{rate_Hz} {
    half_width_Hz_ = std::min(half_width_Hz, rate_Hz / 4);
    // so that the end does not wrap to the start
    const auto pause = static_cast<std::size_t>(std::ceil(4 * rate_Hz / half_width_Hz_));
    length_ = fast_size(signal.size() + pause);
    std::vector<double> padded(length_, 0.0);
    std::copy(signal.begin(), signal.end(), padded.begin());
    spectrum_.resize(length_ / 2 + 1);
    eigen_fft<double>{length_}.forward(padded.data(), spectrum_.data());
    df_Hz_ = rate_Hz / static_cast<double>(length_);
    short_length_ = fast_size(2 * static_cast<std::size_t>(half_width_Hz_ / df_Hz_) + 2);
    kept_ = static_cast<std::size_t>(static_cast<double>(short_length_) * static_cast<double>(signal.size()) /
                                     static_cast<double>(length_));
  }

  template <class = void>
  [[nodiscard]] baseband_record around(double frequency_Hz) const {
    const auto centre = static_cast<std::ptrdiff_t>(std::lround(frequency_Hz / df_Hz_));
    const auto reach = static_cast<std::ptrdiff_t>(half_width_Hz_ / df_Hz_);
    const auto size = static_cast<std::ptrdiff_t>(short_length_);
    const bell_window window{half_width_Hz_};
    std::vector<std::complex<double>> bins(short_length_), samples(short_length_);
    for (std::ptrdiff_t k = -reach; k <= reach; ++k)
      if (centre + k > 0 && centre + k < static_cast<std::ptrdiff_t>(spectrum_.size()))
        bins[static_cast<std::size_t>((k + size) % size)] =
            scale() * window(static_cast<double>(k) * df_Hz_) * spectrum_[static_cast<std::size_t>(centre + k)];
    eigen_fft<std::complex<double>>{short_length_}.inverse(bins.data(), samples.data());
    samples.resize(kept_);
    return {std::move(samples), rate(), static_cast<double>(centre) * df_Hz_, window};
  }

  /// Time after which an edge of the recording is forgotten.
  [[nodiscard]] double settling_s() const noexcept { return 2 / half_width_Hz_; }
  [[nodiscard]] double rate() const noexcept {
    return rate_Hz_ * static_cast<double>(short_length_) / static_cast<double>(length_);
  }

private:
  [[nodiscard]] double scale() const noexcept { return 2 * static_cast<double>(short_length_) / static_cast<double>(length_); }

  double rate_Hz_, half_width_Hz_ = 0, df_Hz_ = 0;
  std::size_t length_ = 0, short_length_ = 0, kept_ = 0;
  std::vector<std::complex<double>> spectrum_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
