// tier: hosted
// SPDX-License-Identifier: MIT
//
// How a termination moves under the force that its transducer measures: Z V = z F, z = Z Y its relative admittance
// (termination.hpp), in newtons like the force. Causal and decaying, hence a stable filter whatever the string does.
//
// Modes, by their poles p = s_k with residue r, one complex state each:
//
//     y[n] = e^{p h} y[n-1] + (b * F)[n],    b(w) = r (1 - e^{(p - i w) h}) / (i w - p)
//
// b, the response of the pole over one step, is entire in w and so a short FIR within any band; the recursion is then exact
// there, unlike an impulse-invariant or bilinear one. Anything else is convolved with its impulse response. What was before the
// record is taken as its first sample forever; `settled` says from when on that no longer matters.
//
#pragma once

#include <rosin/condition/overlap_save.hpp>
#include <rosin/math/fft.hpp>
#include <rosin/propagate/fir.hpp>
#include <rosin/propagate/termination.hpp>

#include <array>
#include <span>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Z V of an end in newtons, sample by sample.
struct end_motion {
  std::vector<double> times_impedance_N;
  sample_range known{0, 0};  ///< samples that depend on samples of the record only, or on rest before it
  std::size_t settled = 0;   ///< from here on it does not matter what was before the record
};

namespace detail {

/// Real and imaginary part of b, as FIRs.
[[nodiscard]] inline std::array<fir, 2> step_taps(std::complex<double> pole, std::complex<double> residue, const band& limits,
                                                  double rate_Hz) {
  using complex = std::complex<double>;
  const auto b = [=](double f) -> complex {
    const complex rest = complex(0, 2 * std::numbers::pi * f) - pole, x = -rest / rate_Hz;
    const complex share = std::abs(x) < 1e-4 ? 1.0 + x / 2.0 : (std::exp(x) - 1.0) / x;
    return residue / rate_Hz * share;
  };
  const int reach = static_cast<int>(20 * rate_Hz / (limits.stop_Hz - limits.pass_Hz)) + 24;
  const auto real = [&](double f) { return (b(f) + std::conj(b(-f))) / 2.0; };
  const auto imag = [&](double f) { return (b(f) - std::conj(b(-f))) / complex(0, 2); };
  return {shortest_fir(real, limits, rate_Hz, -reach, reach, 1e-7), shortest_fir(imag, limits, rate_Hz, -reach, reach, 1e-7)};
}

/// x[n - lag] summed over the taps; beyond its ends the record goes on with its first and last sample.
[[nodiscard]] inline double tap_sum(const fir& k, std::span<const double> x, std::ptrdiff_t n) {
  const auto last = static_cast<std::ptrdiff_t>(x.size()) - 1;
  double sum = 0;
  const std::ptrdiff_t from = n - k.first;
  if (from <= last && n - k.last() >= 0) {
    for (std::size_t j = 0; j < k.taps.size(); ++j)
      sum += k.taps[j] * x[static_cast<std::size_t>(from - static_cast<std::ptrdiff_t>(j))];
    return sum;
  }
  for (std::size_t j = 0; j < k.taps.size(); ++j)
    sum += k.taps[j] * x[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(from - static_cast<std::ptrdiff_t>(j), 0, last))];
  return sum;
}

inline void widen(sample_range& known, const fir& k, std::size_t samples) {
  known.begin = std::max(known.begin, static_cast<std::size_t>(std::max(0, k.last())));
  const auto lost = static_cast<std::size_t>(std::max(0, -k.first));
  known.end = std::min(known.end, samples - std::min(samples, lost));
}

}  // namespace detail

/// Adds one mode's motion to `out`.
inline void add_mode_motion(const admittance_mode& mode, std::span<const double> force_N, const band& limits, double rate_Hz,
                            end_motion& out) {
  admittance_mode apart = mode;  // two equal poles are told apart
  if (std::abs(mode.q - 0.5) < 1e-6) apart.q = 0.5 - 1e-6;
  const std::complex<double> p = apart.pole(),
                             other = p.imag() != 0 ? std::conj(p) : -p - 2 * std::numbers::pi * apart.frequency_Hz / apart.q;
  const bool pair = p.imag() != 0;
  for (const auto& [pole, rest] : {std::pair{p, other}, std::pair{other, p}}) {
    const std::complex<double> residue = mode.per_mass_per_s * pole / (pole - rest);
    const auto taps = detail::step_taps(pole, residue, limits, rate_Hz);
    const std::complex<double> turn = std::exp(pole / rate_Hz);
    std::complex<double> y = -residue / pole * (force_N.empty() ? 0.0 : force_N[0]);  // under a force that was always there
    for (std::size_t n = 0; n < force_N.size(); ++n) {
      const auto at = static_cast<std::ptrdiff_t>(n);
      y = turn * y + std::complex<double>(detail::tap_sum(taps[0], force_N, at), detail::tap_sum(taps[1], force_N, at));
      out.times_impedance_N[n] += (pair ? 2 : 1) * y.real();
    }
    for (const fir& k : taps) detail::widen(out.known, k, force_N.size());
    if (pair) break;
  }
}

/// Modes, by recursion. `limits`: as of the reconstruction.
[[nodiscard]] inline end_motion motion_of_end(const modal_termination& end, std::span<const double> force_N, const band& limits,
                                              double rate_Hz) {
  end_motion out{std::vector<double>(force_N.size(), 0.0), {0, force_N.size()}, 0};
  for (const admittance_mode& m : end.modes) add_mode_motion(m, force_N, limits, rate_Hz, out);
  out.settled = std::min(force_N.size(), out.known.begin + static_cast<std::size_t>(end.memory_s() * rate_Hz));
  return out;
}

/// A rigid end stays where it is.
[[nodiscard]] inline end_motion motion_of_end(const rigid_termination&, std::span<const double> force_N, const band&, double) {
  return {std::vector<double>(force_N.size(), 0.0), {0, force_N.size()}, 0};
}

namespace detail {

/// z of any termination as a filter: by sampling within the band, over twice its memory.
template <Termination End>
[[nodiscard]] fir end_response(const End& end, const band& limits, double rate_Hz) {
  std::size_t size = 4096;
  while (static_cast<double>(size) < 2.2 * end.memory_s() * rate_Hz) size *= 2;
  const double step_Hz = rate_Hz / static_cast<double>(size);
  std::vector<std::complex<double>> bins(size / 2 + 1);
  if constexpr (requires { end.on_grid(step_Hz, bins.size()); }) bins = end.on_grid(step_Hz, bins.size());
  else
    for (std::size_t k = 0; k < bins.size(); ++k) bins[k] = end.relative_admittance(step_Hz * static_cast<double>(k));
  for (std::size_t k = 0; k < bins.size(); ++k) bins[k] *= limits(step_Hz * static_cast<double>(k));
  std::vector<double> response(size);
  eigen_fft<double>(size).inverse(bins.data(), response.data());
  const int before =
      std::min(static_cast<int>(20 * rate_Hz / (limits.stop_Hz - limits.pass_Hz)) + 24, static_cast<int>(size / 8));
  fir out{-before, std::vector<double>(response.end() - before, response.end())};
  out.taps.insert(out.taps.end(), response.begin(), response.begin() + static_cast<std::ptrdiff_t>(size / 2));
  return out;
}

}  // namespace detail

/// Any other termination, by convolution.
template <Termination End>
[[nodiscard]] end_motion motion_of_end(const End& end, std::span<const double> force_N, const band& limits, double rate_Hz) {
  const fir response = detail::end_response(end, limits, rate_Hz);
  const auto ahead = static_cast<std::size_t>(-response.first), behind = static_cast<std::size_t>(response.last());
  const double first = force_N.empty() ? 0.0 : force_N.front(), last = force_N.empty() ? 0.0 : force_N.back();
  std::vector<double> longer(behind, first), moved(behind + force_N.size() + ahead);
  longer.insert(longer.end(), force_N.begin(), force_N.end());
  longer.insert(longer.end(), ahead, last);
  const std::array<std::span<const double>, 1> in{longer};
  const std::array<std::span<double>, 1> out_spans{moved};
  block_convolver<double>(1, std::vector<fir>{response}).process(in, out_spans);
  end_motion out{{moved.begin() + static_cast<std::ptrdiff_t>(behind), moved.end() - static_cast<std::ptrdiff_t>(ahead)},
                 {ahead, force_N.size()},
                 0};
  out.known = {std::min(ahead, force_N.size()), force_N.size() - std::min(ahead, force_N.size())};
  out.settled = std::min(force_N.size(), out.known.begin + static_cast<std::size_t>(end.memory_s() * rate_Hz));
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
