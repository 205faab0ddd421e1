// tier: hosted
// SPDX-License-Identifier: MIT
//
// The two echoes that make a string a loop: from the contact to an end and back, as FIR kernels R1 and R2 of negative
// sign. By frequency sampling they follow exp(-2 gamma x) everywhere but at the lowest partials: a loss proportional
// to |w| has tails 1 / t^2 that a kernel of finite length must cut, and cutting
// those before t = 0, or scaling the rest up to -1 at 0 Hz, falsifies Q by per cents. So the longer kernel is corrected:
//
//     R1(z_n) R2(z_n) = 1  at z_n = exp(p_n h) for every partial's pole p_n,      R(1) = -1,
//
// by the change of its taps that is smallest in the least-squares sense, errors being weighed against each partial's loss. The
// loop then has the pitch and the Q that are asked for, causally, and every partial at its place.
//
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Dense>

#include <rosin/core/instantiate.hpp>
#include <rosin/propagate/fir.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// sum of taps[j] z^-(first + j): the response to a motion z^n, also a damped one.
[[nodiscard]] inline std::complex<double> response_at(const fir& kernel, std::complex<double> z) {
  const auto back = 1.0 / z;
  std::complex<double> sum = 0;
  for (std::size_t j = kernel.taps.size(); j-- > 0;) sum = sum * back + kernel.taps[j];
  return sum * std::pow(back, kernel.first);
}

/// Both echoes; first >= 1.
struct wave_loop {
  std::array<fir, 2> echo;
  double largest_change = 0;  ///< of a partial's loop gain by the correction, absolute
};

/// Makes a kernel `gain` with the delay (in samples) at 0 Hz: what of a response lies outside the taps is replaced by a straight
/// line over them.
inline void hold_at_rest(fir& kernel, double gain, double delay) noexcept {
  const double count = static_cast<double>(kernel.taps.size()), middle = (kernel.first + kernel.last()) / 2.0;
  double sum = 0, moment = 0;
  for (std::size_t k = 0; k < kernel.taps.size(); ++k) {
    sum += kernel.taps[k];
    moment += kernel.taps[k] * (kernel.first + static_cast<double>(k) - middle);
  }
  const double level = (gain - sum) / count;
  const double slope = count > 1 ? (gain * (delay - middle) - moment) / (count * (count * count - 1) / 12) : 0;
  for (std::size_t k = 0; k < kernel.taps.size(); ++k)
    kernel.taps[k] += level + slope * (kernel.first + static_cast<double>(k) - middle);
}

/// Taps first ... last of an echo: -1 with the delay (in samples) at 0 Hz.
template <Transfer H>
[[nodiscard]] fir sample_echo(const H& wanted, const band& limits, double rate_Hz, int first, int last, double delay) {
  fir out = sample_response(wanted, limits, rate_Hz, first, last);
  hold_at_rest(out, -1, delay);
  return out;
}

namespace detail {

/// Rows of the least-squares problem: what each tap of `other`'s partner adds to the loop gain at a pole.
inline void add_pole_rows(Eigen::MatrixXd& rows, Eigen::VectorXd& wanted, Eigen::Index n, const wave_loop& loop,
                          std::complex<double> pole, double step_s) {
  const auto z = std::exp(pole * step_s), back = 1.0 / z;
  const fir& shaped = loop.echo[1];
  const auto through = response_at(loop.echo[0], z), error = 1.0 - through * response_at(shaped, z);
  const double weight = 1 / (1e-9 - pole.real() / std::abs(pole));
  auto term = weight * through * std::pow(back, shaped.first);
  for (Eigen::Index k = 0; k < rows.cols(); ++k, term *= back) {
    rows(2 * n, k) = term.real();
    rows(2 * n + 1, k) = term.imag();
  }
  wanted[2 * n] = weight * error.real();
  wanted[2 * n + 1] = weight * error.imag();
}

}  // namespace detail

/// Sets the loop's poles; each is given for Im p > 0. echo[1] has to be the longer kernel; `delay` is its own, in samples.
template <class Real = double>
void set_poles(wave_loop& loop, std::span<const std::complex<double>> poles, double step_s, double delay,
               double stiffness = 1e-3) {
  auto& taps = loop.echo[1].taps;
  const double shaped_first = loop.echo[1].first;
  const auto rows_wanted = static_cast<Eigen::Index>(2 * poles.size() + 2);
  Eigen::MatrixX<Real> rows(rows_wanted, static_cast<Eigen::Index>(taps.size()));
  Eigen::VectorX<Real> wanted(rows_wanted);
  for (std::size_t n = 0; n < poles.size(); ++n) {
    detail::add_pole_rows(rows, wanted, static_cast<Eigen::Index>(n), loop, poles[n], step_s);
    const auto z = std::exp(poles[n] * step_s);
    loop.largest_change =
        std::max(loop.largest_change, std::abs(1.0 - response_at(loop.echo[0], z) * response_at(loop.echo[1], z)));
  }
  double moment = 0;
  for (Eigen::Index k = 0; k < rows.cols(); ++k) {  // R(1) stays -1, and the delay at 0 Hz what it is
    const double lag = (shaped_first + static_cast<double>(k)) / delay - 1;
    rows(rows_wanted - 2, k) = 1e6;
    rows(rows_wanted - 1, k) = 1e5 * lag;
    moment += taps[static_cast<std::size_t>(k)] * lag;
  }
  wanted[rows_wanted - 2] = 0;
  wanted[rows_wanted - 1] = -1e5 * moment;
  // the smallest change is a sum of rows: as many unknowns as conditions, not as taps
  Eigen::MatrixX<Real> between = rows * rows.transpose();
  double weight = 0;  // of a partial's error, on average
  for (const auto& p : poles) weight += std::abs(p) / (-p.real()) / static_cast<double>(poles.size());
  between.diagonal().array() += stiffness * stiffness * weight * weight * static_cast<double>(poles.size());
  const Eigen::VectorX<Real> change = rows.transpose() * between.ldlt().solve(wanted);
  for (std::size_t k = 0; k < taps.size(); ++k) taps[k] += change[static_cast<Eigen::Index>(k)];
}
ROSIN_INSTANTIATE(void set_poles(wave_loop&, std::span<const std::complex<double>>, double, double, double))

/// The loop's own pole next to a wanted one, by Newton's method on R1 R2 = 1: what pitch and Q have become.
[[nodiscard]] inline std::complex<double> pole_near(const wave_loop& loop, std::complex<double> start, double step_s) {
  auto p = start;
  for (int i = 0; i < 20; ++i) {
    const auto gain = [&](std::complex<double> s) {
      const auto z = std::exp(s * step_s);
      return response_at(loop.echo[0], z) * response_at(loop.echo[1], z) - 1.0;
    };
    const double small = 1e-6 * std::abs(p);
    const auto here = gain(p), slope = (gain(p + small) - gain(p - small)) / (2 * small);
    const auto change = here / slope;
    p -= change;
    if (std::abs(change) < 1e-12 * std::abs(p)) break;
  }
  return p;
}

namespace detail {

/// Transform of a kernel up to half the rate (conjugate). Precondition: it begins at or after 0 and ends before the transform
/// does.
template <class = void>
[[nodiscard]] std::vector<std::complex<double>> spectrum_of(const lane_fft<double, 1>& transform, std::ptrdiff_t first,
                                                            std::span<const double> taps) {
  std::vector<double> data(2 * transform.size(), 0.0);
  for (std::size_t k = 0; k < taps.size(); ++k) data[2 * transform.position(static_cast<std::size_t>(first) + k)] = taps[k];
  transform.inverse(data.data());
  std::vector<std::complex<double>> out(transform.size() / 2 + 1);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {data[2 * i], data[2 * i + 1]};
  return out;
}

/// The larger of two neighbouring gains where the phase passes 0 between them; 0 elsewhere. From 1 on it would grow (Nyquist).
[[nodiscard]] inline double gain_at_crossing(std::complex<double> before, std::complex<double> here) noexcept {
  const bool passes = before.real() > 0 && here.real() > 0 && before.imag() * here.imag() <= 0;
  return passes ? std::max(std::abs(before), std::abs(here)) : 0;
}

}  // namespace detail

/// Largest |R1 R2| where its phase passes 0, from 0.3 of the first partial's frequency on: elsewhere, and at 0 Hz, where the gain
/// is 1, nothing can grow. `period` in samples; at 16 points and more for each lag.
template <class = void>
[[nodiscard]] double largest_gain(const wave_loop& loop, double period) {
  std::size_t grid = 4096;
  while (grid < 32 * static_cast<std::size_t>(loop.echo[0].last() + loop.echo[1].last())) grid *= 2;
  const lane_fft<double, 1> transform(grid);
  const auto one = detail::spectrum_of(transform, loop.echo[0].first, loop.echo[0].taps),
             other = detail::spectrum_of(transform, loop.echo[1].first, loop.echo[1].taps);
  double largest = 0;
  for (auto i = static_cast<std::size_t>(0.3 * static_cast<double>(grid) / period) + 1; i <= grid / 2; ++i)
    largest = std::max(largest, detail::gain_at_crossing(one[i - 1] * other[i - 1], one[i] * other[i]));
  return largest;
}
ROSIN_INSTANTIATE(double largest_gain(const wave_loop&, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
