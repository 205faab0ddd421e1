// tier: hosted
// SPDX-License-Identifier: MIT
//
// Finite impulse responses by frequency sampling: the taps of a wanted transfer function H(f) W(f), W a band that ends
// below half the sampling rate, and the shortest run of taps that keeps a given error inside the pass band.
//
// Why not a least-squares or equiripple design: the wanted functions are smooth (an all-pass phase times a C3 window), their
// sampled responses decay by themselves, and cutting what lies under the error asked for is optimal to a tap or two. It also
// works for any delay, for loss and its compensation, and for both directions of time, with no special function.
//
#pragma once

#include <rosin/math/lane_fft.hpp>
#include <rosin/propagate/band.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <concepts>
#include <cstddef>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// y[n] = sum_j taps[j] x[n - first - j]. A negative `first` looks ahead.
struct fir {
  int first = 0;
  std::vector<double> taps;

  [[nodiscard]] int last() const noexcept { return first + static_cast<int>(taps.size()) - 1; }

  /// Frequency response at `frequency_Hz`, for a sampling rate.
  [[nodiscard]] std::complex<double> response(double frequency_Hz, double rate_Hz) const {
    const double turn = -2 * std::numbers::pi * frequency_Hz / rate_Hz, c = std::cos(turn), d = std::sin(turn);
    double re = 1, im = 0, sum_re = 0, sum_im = 0;
    for (std::size_t j = 0; j < taps.size(); ++j) {
      if (j % 64 == 0) re = std::cos(turn * static_cast<double>(j)), im = std::sin(turn * static_cast<double>(j));
      sum_re += taps[j] * re, sum_im += taps[j] * im;
      const double next = re * c - im * d;
      im = re * d + im * c, re = next;
    }
    return std::complex<double>(sum_re, sum_im) * std::polar(1.0, turn * first);
  }
};

/// A transfer function: complex response at a frequency in Hz, >= 0.
template <class H>
concept Transfer = requires(const H& h, double frequency_Hz) {
  { h(frequency_Hz) } -> std::convertible_to<std::complex<double>>;
};

/// Several of them that are evaluated together: an array of complex responses at a frequency in Hz, >= 0.
template <class H>
concept TransferSet = requires(const H& h, double frequency_Hz) {
  std::tuple_size<decltype(h(frequency_Hz))>::value;
  { h(frequency_Hz)[0] } -> std::convertible_to<std::complex<double>>;
};
template <TransferSet H>
inline constexpr std::size_t set_size = std::tuple_size_v<decltype(std::declval<const H&>()(0.0))>;

/// Taps first ... last of the impulse responses of `wanted` within `limits`, at `rate_Hz`.
/// The responses are sampled on a grid wide enough that what wraps around has died away: at least eight times the
/// longest lag. Precondition: first <= last, limits.stop_Hz <= rate_Hz / 2.
template <TransferSet H>
[[nodiscard]] std::array<fir, set_size<H>> sample_responses(const H& wanted, const band& limits, double rate_Hz, int first,
                                                            int last) {
  std::size_t grid = 4096;
  while (grid < 8 * static_cast<std::size_t>(std::max(std::abs(first), std::abs(last)))) grid *= 2;
  const lane_fft<double, 1> transform(grid);
  std::array<std::vector<double>, set_size<H>> spectrum;  // re, im by turns, in the order that the transform asks for
  spectrum.fill(std::vector<double>(2 * grid, 0.0));
  for (std::size_t bin = 0; bin < grid / 2; ++bin) {
    const double f = rate_Hz * static_cast<double>(bin) / static_cast<double>(grid);
    const double weight = limits(f) / static_cast<double>(grid);
    if (f > limits.pass_Hz && weight == 0) break;
    const auto values = wanted(f);
    const std::size_t at = 2 * transform.position(bin);
    for (std::size_t i = 0; i < set_size<H>; ++i) {
      const std::complex<double> value = (bin == 0 ? 1.0 : 2.0) * weight * std::complex<double>(values[i]);
      spectrum[i][at] = value.real(), spectrum[i][at + 1] = value.imag();
    }
  }
  std::array<fir, set_size<H>> out;
  for (std::size_t i = 0; i < set_size<H>; ++i) {
    transform.inverse(spectrum[i].data());
    out[i].first = first;
    for (int n = first; n <= last; ++n)
      out[i].taps.push_back(spectrum[i][2 * (n < 0 ? grid - static_cast<std::size_t>(-n) : static_cast<std::size_t>(n))]);
  }
  return out;
}
template <Transfer H>
[[nodiscard]] fir sample_response(const H& wanted, const band& limits, double rate_Hz, int first, int last) {
  return sample_responses([&](double f) { return std::array<std::complex<double>, 1>{wanted(f)}; }, limits, rate_Hz, first,
                          last)[0];
}

/// Largest |response - wanted W| / max |wanted| from 0 to the end of the pass band.
template <Transfer H>
[[nodiscard]] double pass_band_error(const fir& kernel, const H& wanted, const band& limits, double rate_Hz, int points = 400) {
  double worst = 0, scale = 0;
  for (int i = 0; i <= points; ++i) {
    const double f = limits.pass_Hz * i / points;
    const std::complex<double> ideal = wanted(f);
    worst = std::max(worst, std::abs(kernel.response(f, rate_Hz) - ideal));
    scale = std::max(scale, std::abs(ideal));
  }
  return worst / scale;
}

namespace detail {

/// Drops the smaller end tap until `count` are left.
inline fir shrink(const fir& whole, std::size_t count) {
  std::size_t begin = 0, end = whole.taps.size();
  while (end - begin > count) {
    if (std::abs(whole.taps[begin]) < std::abs(whole.taps[end - 1])) ++begin;
    else --end;
  }
  return {whole.first + static_cast<int>(begin),
          {whole.taps.begin() + static_cast<std::ptrdiff_t>(begin), whole.taps.begin() + static_cast<std::ptrdiff_t>(end)}};
}

/// Whether the response stays within `most` of ideals that lie evenly from 0 to the end of the pass band. Looked at from both
/// ends towards the middle, since there most runs that are too short are off.
[[nodiscard]] inline bool stays_near(const fir& kernel, const std::vector<std::complex<double>>& ideal, double most,
                                     const band& limits, double rate_Hz) {
  const std::size_t last = ideal.size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    const std::size_t i = k % 2 == 0 ? k / 2 : last - k / 2;
    const double f = limits.pass_Hz * static_cast<double>(i) / static_cast<double>(last);
    if (!(std::abs(kernel.response(f, rate_Hz) - ideal[i]) <= most)) return false;
  }
  return true;
}

/// As short as it stays near its ideals, by bisection; `error` is relative to the largest of them.
[[nodiscard]] inline fir shortest_part(const fir& whole, const std::vector<std::complex<double>>& ideal, const band& limits,
                                       double rate_Hz, double error) {
  double scale = 0;
  for (const auto& x : ideal) scale = std::max(scale, std::abs(x));
  std::size_t too_short = 0, enough = whole.taps.size();
  while (enough - too_short > 1) {
    const std::size_t middle = (too_short + enough) / 2;
    (stays_near(shrink(whole, middle), ideal, error * scale, limits, rate_Hz) ? enough : too_short) = middle;
  }
  return shrink(whole, enough);
}

}  // namespace detail

/// The shortest runs of taps whose responses stay within `error` (relative to the largest |wanted|) of the wanted ones all over
/// the pass band. `first` ... `last` bound the search and must hold the responses.
template <TransferSet H>
[[nodiscard]] std::array<fir, set_size<H>> shortest_firs(const H& wanted, const band& limits, double rate_Hz, int first, int last,
                                                         double error) {
  constexpr int points = 400;
  std::array<std::vector<std::complex<double>>, set_size<H>> ideal;
  for (int i = 0; i <= points; ++i) {
    const auto values = wanted(limits.pass_Hz * i / points);
    for (std::size_t k = 0; k < set_size<H>; ++k) ideal[k].emplace_back(values[k]);
  }
  std::array<fir, set_size<H>> out = sample_responses(wanted, limits, rate_Hz, first, last);
  for (std::size_t k = 0; k < set_size<H>; ++k) out[k] = detail::shortest_part(out[k], ideal[k], limits, rate_Hz, error);
  return out;
}
template <Transfer H>
[[nodiscard]] fir shortest_fir(const H& wanted, const band& limits, double rate_Hz, int first, int last, double error) {
  return shortest_firs([&](double f) { return std::array<std::complex<double>, 1>{wanted(f)}; }, limits, rate_Hz, first, last,
                       error)[0];
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
