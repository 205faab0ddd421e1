// tier: hosted
// SPDX-License-Identifier: MIT
//
// The one low-pass that every signal of the reference simulation goes through before it is sampled: a symmetric
// kernel in continuous time (a sinc under a Kaiser window), so that its delay is exactly zero and truth and
// recording keep the same clock,
//
//     h(t) = 2 f_c sinc(2 f_c t) I0(b sqrt(1 - (t / w)^2)) / I0(b),   |t| <= w,   f_c midway between pass and stop,
//
// scaled to unit gain at 0 Hz. With the default ripple of 1e-5 it is flat within 1e-5 up to `pass_Hz` and below
// 1e-5 from `stop_Hz` on. Kaiser's design formulae: J. F. Kaiser, Proc. IEEE ISCAS 1974, 20-23.
//
#pragma once

#include <array>
#include <cmath>
#include <complex>

namespace rosin {

/// Four-point Gauss-Legendre rule on [0, 1].
struct gauss4 {
  static constexpr std::array<double, 4> node{0.069431844202973712, 0.330009478207571868, 0.669990521792428132,
                                              0.930568155797026288};
  static constexpr std::array<double, 4> weight{0.173927422568726929, 0.326072577431273071, 0.326072577431273071,
                                                0.173927422568726929};
};

/// Symmetric low-pass kernel of finite length in continuous time.
class modal_low_pass {
public:
  modal_low_pass(double pass_Hz, double stop_Hz, double ripple = 1e-5) : pass_{pass_Hz}, stop_{stop_Hz} {
    constexpr double pi = 3.14159265358979323846;
    const double decibel = -20 * std::log10(ripple);
    shape_ = 0.1102 * (decibel - 8.7);
    half_width_ = (decibel - 7.95) / (2.285 * 2 * pi * (stop_ - pass_)) / 2;
    scale_ = 1;
    scale_ = 1 / response(0).real();
  }

  [[nodiscard]] double pass_Hz() const noexcept { return pass_; }
  [[nodiscard]] double stop_Hz() const noexcept { return stop_; }
  /// The kernel vanishes for |t| > half_width_s().
  [[nodiscard]] double half_width_s() const noexcept { return half_width_; }

  /// h(t), 1/s.
  [[nodiscard]] double operator()(double t_s) const noexcept {
    constexpr double pi = 3.14159265358979323846;
    const double u = t_s / half_width_;
    if (!(u * u < 1)) return 0;
    const double x = pi * (pass_ + stop_) * t_s;
    const double sinc = std::abs(x) < 1e-9 ? 1.0 : std::sin(x) / x;
    return scale_ * (pass_ + stop_) * sinc * bessel_i0(shape_ * std::sqrt(1 - u * u)) / bessel_i0(shape_);
  }

  /// H(s) = integral of h(t) exp(-s t) dt, for any complex s in rad/s; H(i w) is the frequency response.
  [[nodiscard]] std::complex<double> response(std::complex<double> s) const {
    const int panels = 64 + static_cast<int>(half_width_ * (std::abs(s) + 8 * stop_));
    const double step = 2 * half_width_ / panels;
    std::complex<double> sum = 0;
    for (int i = 0; i < panels; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        const double t = -half_width_ + (i + gauss4::node[j]) * step;
        sum += gauss4::weight[j] * step * (*this)(t)*std::exp(-s * t);
      }
    return sum;
  }

private:
  /// Modified Bessel function of order zero by its power series; all terms are positive.
  [[nodiscard]] static double bessel_i0(double x) noexcept {
    const double q = x * x / 4;
    double term = 1, sum = 1;
    for (int k = 1; term > 1e-17 * sum; ++k) sum += term *= q / (static_cast<double>(k) * k);
    return sum;
  }

  double pass_, stop_, shape_ = 0, half_width_ = 0, scale_ = 1;
};

}  // namespace rosin
