// tier: hosted
// SPDX-License-Identifier: MIT
//
// Mains hum: lines at the mains' frequency and at what rectifiers and transformers add; every take has its own phases. Sought in
// what a fit leaves: there all lines together have to take away more than noise would give them,
//
//     gain of ln L = (n / 2) sum over channels of ln(power before / power after)  >  k / 2 + sqrt(k / 2),   k amplitudes.
//
// Lines near a partial of the string do not count in that, as a partial that is off would look like them, but go with the others.
// Slow noise would give any lines more than white noise: it has to be clearly more than lines elsewhere take away.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_effect.hpp>
#include <rosin/math/median.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// Least squares of lines at these frequencies in what is left of both channels.
struct lines_in_rest {
  double gain = 0;              ///< of ln L
  std::vector<double> parts_N;  ///< re and im of near, of far, line by line: Re(a exp(2 pi i f t)), t from the take's beginning
};

template <class Real = double>
lines_in_rest lines_at(const take_residual& rest, const std::vector<double>& frequencies_Hz) {
  const auto k = static_cast<Eigen::Index>(2 * frequencies_Hz.size());
  const Eigen::Index n = rest.residual[0].size();
  lines_in_rest out{0, std::vector<double>(2 * static_cast<std::size_t>(k), 0.0)};
  if (n < 4 * k) return out;
  Eigen::MatrixX<Real> turning(n, k);
  for (Eigen::Index l = 0; l < k / 2; ++l) {
    const double w = 2 * std::numbers::pi * frequencies_Hz[static_cast<std::size_t>(l)];
    const auto phase = w * (rest.begin_s + Eigen::ArrayX<Real>::LinSpaced(n, 0, static_cast<double>(n - 1)) / rest.rate_Hz);
    turning.col(2 * l) = phase.cos(), turning.col(2 * l + 1) = -phase.sin();
  }
  const Eigen::LDLT<Eigen::MatrixX<Real>> gram(turning.transpose() * turning);
  for (std::size_t c = 0; c < 2; ++c) {
    const Eigen::VectorX<Real>& x = rest.residual[c];
    const Eigen::VectorX<Real> projected = turning.transpose() * x, amplitude = gram.solve(projected);
    const double before = x.squaredNorm(), after = before - amplitude.dot(projected);
    if (before > 0) out.gain += 0.5 * static_cast<double>(n) * std::log(before / std::max(after, 1e-12 * before));
    for (Eigen::Index i = 0; i < k; ++i) out.parts_N[static_cast<std::size_t>(4 * (i / 2) + i % 2) + 2 * c] = amplitude[i];
  }
  return out;
}

/// Gain of lines that are no hum's over what white noise would give them, in the middle of several such sets: 1 if noise is white.
template <class = void>
double lines_elsewhere(const take_residual& rest, const std::vector<double>& frequencies_Hz) {
  std::vector<double> gains;
  for (const double by : {0.63, 0.71, 0.78, 0.84, 1.16, 1.23, 1.29, 1.37, 1.43}) {
    std::vector<double> moved = frequencies_Hz;
    for (double& f : moved) f *= by;
    gains.push_back(lines_at(rest, moved).gain);
  }
  return std::max(1.0, median_of(gains) / (2 * static_cast<double>(frequencies_Hz.size())));
}

}  // namespace detail

/// Parameters of a take, one multiple after the other: re and im of near, of far.
template <class = void>
pluck_effect hum_effect(const string_facts& f, double mains_Hz) {
  constexpr double clear = 0.02, apart = 0.003;  // of the pitch, from a partial
  std::vector<double> multiples{1}, near_partials;
  for (const double m : {2.0, 3.0, 4.0, 5.0, 7.0}) {
    const double order = m * mains_Hz / f.fundamental_Hz, off = std::abs(order - std::max(1.0, std::round(order)));
    if (off > apart) (off > clear ? multiples : near_partials).push_back(m);
  }
  const std::size_t counting = multiples.size();
  multiples.insert(multiples.end(), near_partials.begin(), near_partials.end());
  const std::size_t of_take = 4 * multiples.size();
  pluck_effect e{.name = "mains-hum",
                 .parameters = {{"frequency_Hz", mains_Hz - 0.6, mains_Hz + 0.6, 1e-6, true}},
                 .starts = {{mains_Hz}},
                 .strength = -1};
  for (std::size_t i = 0; i < f.takes * of_take; ++i) {
    e.parameters.push_back({"amplitude", -100, 100, 1e-5, false, static_cast<int>(i / of_take)});
    e.starts[0].push_back(0);
  }
  e.apply = [multiples, of_take](pluck_scene& s, const double* v, int take) {
    const double* a = v + 1 + static_cast<std::ptrdiff_t>(of_take) * take;
    for (const double m : multiples) {
      s.hum.push_back({v[0] * m, {std::complex<double>(a[0], a[1]), std::complex<double>(a[2], a[3])}});
      a += 4;
    }
  };
  e.seek = [multiples, counting, of_take, mains_Hz,
            nothing = e.starts[0]](const take_residual& rest) -> std::vector<std::vector<double>> {
    std::vector<double> at, counted;
    for (const double m : multiples) at.push_back(m * mains_Hz);
    counted.assign(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(counting));
    const double by_chance = 2 * static_cast<double>(counting);
    const double gain = detail::lines_at(rest, counted).gain;
    if (!(gain > by_chance + std::sqrt(by_chance))) return {};
    const double elsewhere = detail::lines_elsewhere(rest, counted);
    if (elsewhere > 1.5 && !(gain > elsewhere * (by_chance + 4 * std::sqrt(by_chance)))) return {};
    const detail::lines_in_rest found = detail::lines_at(rest, at);
    std::vector<double> start = nothing;
    std::copy(found.parts_N.begin(), found.parts_N.end(), start.begin() + 1 + static_cast<std::ptrdiff_t>(rest.take * of_take));
    return {start};
  };
  return e;
}
ROSIN_INSTANTIATE(pluck_effect hum_effect(const string_facts&, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
