// tier: hosted
// SPDX-License-Identifier: MIT
//
// Is this partial one damped line or two? Both polarisations of a string, or the strings of a choir, give beats and double
// decays. Two lines are tried from several starts (a line in what one leaves over, a quick and a slow decay at one pitch, the
// roots of a two-term linear prediction), and kept if Schwarz's criterion pays for the four parameters more:
//
//     BIC = M ln(residual) + parameters ln(M),    M: real numbers in the band; two lines need 10 less than one
//
// and if they make sense: two lines that are large only to cancel each other say that the model is wrong, not that there are two.
//
#pragma once

#include <rosin/calibrate/partial_line.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/math/fft.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

inline double energy_of(complex_span z) {
  double sum = 0;
  for (const auto& v : z) sum += std::norm(v);
  return sum;
}

/// Angular frequency of the strongest line within +-tolerance of zero.
template <class = void>
double strongest_detuning(complex_span z, double rate_Hz, double tolerance_Hz) {
  const std::size_t n = fast_size(4 * z.size());
  std::vector<std::complex<double>> padded(n), bins(n);
  std::copy(z.begin(), z.end(), padded.begin());
  eigen_fft<std::complex<double>>{n}.forward(padded.data(), bins.data());
  const double df = rate_Hz / static_cast<double>(n);
  const auto reach = std::min(static_cast<std::size_t>(tolerance_Hz / df) + 1, n / 2 - 1);
  std::size_t best = 0;
  double sign = 1;
  for (std::size_t k = 0; k <= reach; ++k) {
    if (std::norm(bins[k]) > std::norm(bins[best])) best = k, sign = 1;
    if (k > 0 && std::norm(bins[n - k]) > std::norm(bins[best])) best = n - k, sign = -1;
  }
  return sign * full_turn * df * static_cast<double>(sign > 0 ? best : n - best);
}

inline std::vector<std::complex<double>> left_over(complex_span z, double rate_Hz, const line_model& m) {
  std::vector<std::complex<double>> r(z.begin(), z.end());
  Eigen::VectorXcd row(static_cast<Eigen::Index>(4 * m.parts.size() + 1));
  for (std::size_t j = 0; j < r.size(); ++j) r[j] -= line_row(m, static_cast<double>(j) / rate_Hz, false, row);
  return r;
}

/// The two exponents, s = (-decay, detuning) relative to `around`, of the recurrence z[j] = g1 z[j-m] + g2 z[j-2m].
template <class = void>
std::array<std::complex<double>, 2> predicted_exponents(complex_span z, double rate_Hz, double around_rad_s, std::size_t lag) {
  Eigen::Matrix2cd gram = Eigen::Matrix2cd::Zero();
  Eigen::Vector2cd right = Eigen::Vector2cd::Zero();
  const auto at = [&](std::size_t j) { return z[j] * std::polar(1.0, -around_rad_s * static_cast<double>(j) / rate_Hz); };
  for (std::size_t j = 2 * lag; j < z.size(); ++j) {
    const Eigen::Vector2cd past{at(j - lag), at(j - 2 * lag)};
    gram += past.conjugate() * past.transpose();
    right += past.conjugate() * at(j);
  }
  const Eigen::Vector2cd g = gram.fullPivLu().solve(right);
  const std::complex<double> root = std::sqrt(g[0] * g[0] / 4.0 + g[1]);
  const double per_s = rate_Hz / static_cast<double>(lag);
  return {std::log(g[0] / 2.0 + root) * per_s, std::log(g[0] / 2.0 - root) * per_s};
}

template <class = void>
std::vector<line_model> starts_for_two(complex_span z, double rate_Hz, const line_fit& one, double tolerance_Hz) {
  const damped_part p = one.model.parts[0];
  std::vector<line_model> starts;
  const auto add = [&](damped_part a, damped_part b) { starts.push_back({{a, b}, one.model.centre_Hz, one.model.glide}); };
  add({1.0, 2.5 * p.decay_per_s, p.detuning_rad_s}, {1.0, 0.4 * p.decay_per_s, p.detuning_rad_s});
  const double other = strongest_detuning(left_over(z, rate_Hz, one.model), rate_Hz, tolerance_Hz);
  add(p, {1.0, p.decay_per_s, other});
  for (const std::size_t parts : {6U, 16U}) {
    const std::size_t lag = z.size() / parts;
    if (lag == 0) continue;
    const auto s = predicted_exponents(z, rate_Hz, p.detuning_rad_s, lag);
    if (!std::isfinite(std::abs(s[0])) || !std::isfinite(std::abs(s[1]))) continue;
    add({1.0, -s[0].real(), p.detuning_rad_s + s[0].imag()}, {1.0, -s[1].real(), p.detuning_rad_s + s[1].imag()});
  }
  return starts;
}

inline bool makes_sense(const line_fit& two, const line_fit& one, complex_span z, double rate_Hz, double tolerance_Hz) {
  const double lasts = static_cast<double>(z.size()) / rate_Hz, whole = energy_of(z) / rate_Hz;
  double sum = 0;
  for (const damped_part& p : two.model.parts) {
    if (!(p.decay_per_s > -0.5 / lasts) || p.decay_per_s > rate_Hz) return false;
    if (std::abs(p.detuning_rad_s - one.model.parts[0].detuning_rad_s) > full_turn * tolerance_Hz) return false;
    sum += p.energy(lasts);
  }
  return sum < 4 * whole;
}

}  // namespace detail

/// The best single line within +-tolerance of the centre.
template <class = void>
line_fit fit_one_line(std::span<const std::complex<double>> z, double rate_Hz, double centre_Hz, double tolerance_Hz,
                      pitch_glide glide = {}) {
  double first_moment = 0;
  for (std::size_t j = 0; j < z.size(); ++j) first_moment += static_cast<double>(j) / rate_Hz * std::norm(z[j]);
  const double guess = detail::energy_of(z) / (2 * std::max(first_moment, 1e-300));
  const double detuning = detail::strongest_detuning(z, rate_Hz, tolerance_Hz);
  line_model best{{{1.0, guess, detuning}}, centre_Hz, glide};
  double least = solve_amplitudes(z, rate_Hz, best);
  for (const double factor : {0.25, 4.0}) {
    line_model other{{{1.0, guess * factor, detuning}}, centre_Hz, glide};
    const double residual = solve_amplitudes(z, rate_Hz, other);
    if (residual < least) least = residual, best = other;
  }
  return fit_line(z, rate_Hz, best);
}
ROSIN_INSTANTIATE(line_fit fit_one_line(std::span<const std::complex<double>>, double, double, double, pitch_glide))

/// `one`, or two lines that explain the record so much better. filled: the part of the rate that the band fills with noise.
template <class = void>
line_fit one_or_two_lines(std::span<const std::complex<double>> z, double rate_Hz, const line_fit& one, double tolerance_Hz,
                          double filled) {
  auto starts = detail::starts_for_two(z, rate_Hz, one, tolerance_Hz);
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < starts.size(); ++i) order.emplace_back(solve_amplitudes(z, rate_Hz, starts[i]), i);
  std::sort(order.begin(), order.end());
  const double numbers = 2 * filled * static_cast<double>(z.size());
  line_fit best = one;
  double limit = numbers * std::log(std::max(one.residual, 1e-300)) - 4 * std::log(numbers) - 10;
  for (std::size_t i = 0; i < std::min<std::size_t>(2, order.size()); ++i) {
    line_fit two = fit_line(z, rate_Hz, starts[order[i].second]);
    const double value = numbers * std::log(std::max(two.residual, 1e-300));
    if (!(value < limit) || !detail::makes_sense(two, one, z, rate_Hz, tolerance_Hz)) continue;
    limit = value;
    best = std::move(two);
  }
  return best;
}
ROSIN_INSTANTIATE(line_fit one_or_two_lines(std::span<const std::complex<double>>, double, const line_fit&, double, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
