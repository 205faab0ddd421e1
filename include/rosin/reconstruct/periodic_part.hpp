// tier: hosted
// SPDX-License-Identifier: MIT
//
// The stretch of a take in which it repeats itself best, its exact period, and its Fourier series there.
//
// The paper resamples seven periods to an integral number of samples a period and transforms them. Here the series is fitted to
// the samples as they are, by least squares,
//
//     x[n] = sum_h Re{ c_h exp(2 pi i h n / P) },   h = 0 ... H,   P not integral,
//
// which needs no interpolation, has no leakage, and averages the periods; evaluated on any integral grid it is the resampled
// period. P is the one that leaves least.
//
#pragma once

#include <rosin/calibrate/pluck_start.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>

#include <Eigen/Dense>

#include <complex>
#include <numbers>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Two channels as Fourier series over one stretch.
struct periodic_part {
  std::size_t begin = 0, end = 0;          ///< samples of the take
  double period = 0;                       ///< samples
  double remainder = 1;                    ///< rms of what is not periodic / rms of what moves
  std::array<Eigen::VectorXcd, 2> series;  ///< c_0 ... c_H; phases counted from sample `begin`

  [[nodiscard]] double periods() const { return static_cast<double>(end - begin) / period; }
};

namespace detail {

/// Least-squares Fourier series of x[begin, end) with a period, up to harmonic H; returns the power left over.
template <class Real = double>
double fit_series(std::span<const double> x, double period, int H, Eigen::VectorXcd* series) {
  const auto N = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixX<Real> basis(N, 2 * H + 1);
  basis.col(0).setOnes();
  for (int h = 1; h <= H; ++h) {
    const std::complex<double> step = std::polar(1.0, 2 * std::numbers::pi * h / period);
    std::complex<double> z = 1;
    for (Eigen::Index n = 0; n < N; ++n, z *= step) {
      basis(n, 2 * h - 1) = z.real();
      basis(n, 2 * h) = -z.imag();
    }
  }
  const Eigen::Map<const Eigen::VectorX<Real>> data(x.data(), N);
  Eigen::MatrixX<Real> gram = Eigen::MatrixX<Real>::Zero(2 * H + 1, 2 * H + 1);
  gram.template selfadjointView<Eigen::Lower>().rankUpdate(basis.transpose());
  const Eigen::VectorX<Real> c = gram.template selfadjointView<Eigen::Lower>().ldlt().solve(basis.transpose() * data);
  if (series != nullptr) {
    series->resize(H + 1);
    (*series)[0] = c[0];
    for (int h = 1; h <= H; ++h) (*series)[h] = {c[2 * h - 1], c[2 * h]};
  }
  return (data - basis * c).squaredNorm();
}

/// Power of x[n + P] - x[n], with a parabola through the three nearest lags in place of interpolation.
inline double unlikeness(std::span<const double> x, std::size_t begin, std::size_t count, double period) {
  const auto lag = static_cast<std::size_t>(std::lround(period));
  std::array<double, 3> power{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t n = begin; n < begin + count; ++n) {
      const double d = x[n + lag - 1 + k] - x[n];
      power[k] += d * d;
    }
  return std::min({power[0], power[1], power[2]});
}

/// Start of the window of `count` samples that is most like itself a period later, in relation to how much moves in it.
inline std::size_t steadiest(std::span<const double> x, double period, std::size_t count) {
  const auto lag = static_cast<std::size_t>(std::lround(period)) + 2, hop = std::max<std::size_t>(1, lag / 2);
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity(), loudest = 0;
  std::vector<std::array<double, 2>> windows;
  for (std::size_t begin = 0; begin + count + lag < x.size(); begin += hop) {
    double mean = 0, power = 0;
    for (std::size_t n = begin; n < begin + count; ++n) mean += x[n];
    mean /= static_cast<double>(count);
    for (std::size_t n = begin; n < begin + count; ++n) power += (x[n] - mean) * (x[n] - mean);
    windows.push_back({unlikeness(x, begin, count, period), power});
    loudest = std::max(loudest, power);
  }
  for (std::size_t i = 0; i < windows.size(); ++i)
    if (windows[i][1] > 0.05 * loudest && windows[i][0] < least * windows[i][1]) {
      least = windows[i][0] / windows[i][1];
      best = i * hop;
    }
  return best;
}

}  // namespace detail

/// Finds the stretch of `periods` periods near 1/nominal_Hz (within 15 %: friction flattens) that repeats best, in both channels.
template <class = void>
[[nodiscard]] outcome<periodic_part> find_periodic_part(std::span<const double> near, std::span<const double> far, double rate_Hz,
                                                        double nominal_Hz, double highest_Hz, int periods = 7) {
  const double rough = rate_Hz / nominal_Hz;
  if (static_cast<double>(near.size()) < (periods + 3) * rough)
    return failure{"the take is shorter than " + std::to_string(periods + 3) + " periods"};
  std::vector<double> sum(near.size());
  for (std::size_t n = 0; n < sum.size(); ++n) {
    sum[n] = near[n] + far[n];
    if (!std::isfinite(sum[n])) return failure{"sample " + std::to_string(n) + " is not a number"};
  }
  double period = detail::likest_lag(sum, sum.size() / 3, 0.87 * rough, 1.15 * rough);
  if (period <= 0) period = rough;
  periodic_part out;
  const auto count = static_cast<std::size_t>(std::ceil(periods * period));
  out.begin = detail::steadiest(sum, period, count);
  out.end = out.begin + count;
  const auto part = [&](std::span<const double> x) { return x.subspan(out.begin, count); };

  double step = 0.004 * period;  // golden-section steps would do; three shrinking scans are as good and cannot be fooled
  for (int scan = 0; scan < 7; ++scan, step /= 4) {
    double best = period, least = std::numeric_limits<double>::infinity();
    for (int i = -4; i <= 4; ++i) {
      const double tried = period + i * step / 2;
      const double left = detail::fit_series(part(sum), tried, std::min(40, static_cast<int>(0.4 * tried)), nullptr);
      if (left < least) least = left, best = tried;
    }
    period = best;
  }
  out.period = period;
  const int H = std::max(1, static_cast<int>(std::min(highest_Hz / rate_Hz, 0.49) * period));
  double left = 0, power = 0;
  for (std::size_t c = 0; c < 2; ++c) {
    const std::span<const double> x = part(c == 0 ? near : far);
    left += detail::fit_series(x, period, H, &out.series[c]);
    const double mean = std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
    for (const double v : x) power += (v - mean) * (v - mean);
  }
  if (power <= 0) return failure{"nothing moves in the take"};
  out.remainder = std::sqrt(left / power);
  if (out.remainder > 0.5)
    return failure{"no stretch of " + std::to_string(periods) + " periods repeats itself: at best " +
                   std::to_string(static_cast<int>(100 * out.remainder)) + " % of the signal is not periodic"};
  return out;
}
ROSIN_INSTANTIATE(outcome<periodic_part> find_periodic_part(std::span<const double>, std::span<const double>, double, double,
                                                            double, int))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
