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

#include <rosin/propagate/band.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <concepts>
#include <cstddef>
#include <numbers>
#include <vector>

namespace rosin {

/// y[n] = sum_j taps[j] x[n - first - j]. A negative `first` looks ahead.
struct fir {
  int first = 0;
  std::vector<double> taps;

  [[nodiscard]] int last() const noexcept { return first + static_cast<int>(taps.size()) - 1; }

  /// Frequency response at `frequency_Hz`, for a sampling rate.
  [[nodiscard]] std::complex<double> response(double frequency_Hz, double rate_Hz) const {
    const double turn = -2 * std::numbers::pi * frequency_Hz / rate_Hz;
    const std::complex<double> step = std::polar(1.0, turn);
    std::complex<double> z = 1, sum = 0;
    for (std::size_t j = 0; j < taps.size(); ++j, z *= step) {
      if (j % 64 == 0) z = std::polar(1.0, turn * static_cast<double>(j));
      sum += taps[j] * z;
    }
    return sum * std::polar(1.0, turn * first);
  }
};

/// A transfer function: complex response at a frequency in Hz, >= 0.
template <class H>
concept Transfer = requires(const H& h, double frequency_Hz) {
  { h(frequency_Hz) } -> std::convertible_to<std::complex<double>>;
};

/// Taps first ... last of the impulse response of `wanted` within `limits`, at `rate_Hz`.
/// The response is sampled on a grid wide enough that what wraps around has died away: at least eight times the
/// longest lag. Precondition: first <= last, limits.stop_Hz <= rate_Hz / 2.
template <Transfer H>
[[nodiscard]] fir sample_response(const H& wanted, const band& limits, double rate_Hz, int first, int last) {
  std::size_t grid = 4096;
  while (grid < 8 * static_cast<std::size_t>(std::max(std::abs(first), std::abs(last)))) grid *= 2;
  const double turn = 2 * std::numbers::pi / static_cast<double>(grid);

  fir out{first, std::vector<double>(static_cast<std::size_t>(last - first + 1), 0.0)};
  for (std::size_t bin = 0; bin < grid / 2; ++bin) {
    const double f = rate_Hz * static_cast<double>(bin) / static_cast<double>(grid);
    const double weight = limits(f) / static_cast<double>(grid);
    if (f > limits.pass_Hz && weight == 0) break;
    const std::complex<double> value = (bin == 0 ? 1.0 : 2.0) * weight * std::complex<double>(wanted(f));
    const std::complex<double> step = std::polar(1.0, turn * static_cast<double>(bin));
    std::complex<double> z = value * std::polar(1.0, turn * static_cast<double>(bin) * first);
    for (double& tap : out.taps) {
      tap += z.real();
      z *= step;
    }
  }
  return out;
}

/// Largest |response - wanted W| / max |wanted| from 0 to the end of the pass band.
template <Transfer H>
[[nodiscard]] double pass_band_error(const fir& kernel, const H& wanted, const band& limits, double rate_Hz,
                                     int points = 400) {
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

}  // namespace detail

/// The shortest run of taps whose response stays within `error` (relative to the largest |wanted|) of the wanted one all over
/// the pass band. `first` ... `last` bound the search and must hold the response.
template <Transfer H>
[[nodiscard]] fir shortest_fir(const H& wanted, const band& limits, double rate_Hz, int first, int last, double error) {
  const fir whole = sample_response(wanted, limits, rate_Hz, first, last);
  std::size_t too_short = 0, enough = whole.taps.size();
  while (enough - too_short > 1) {
    const std::size_t middle = (too_short + enough) / 2;
    const fir candidate = detail::shrink(whole, middle);
    (pass_band_error(candidate, wanted, limits, rate_Hz) <= error ? enough : too_short) = middle;
  }
  return detail::shrink(whole, enough);
}

}  // namespace rosin
