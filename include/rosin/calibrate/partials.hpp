// tier: hosted
// SPDX-License-Identifier: MIT
//
// One partial of a freely decaying string, from one channel: its frequency, decay and amplitude with standard deviations.
//
// The stretch that is fitted begins after the attack and ends where the partial sinks into the noise, or five time constants
// on. The standard deviations are those of maximum likelihood, (S/2 information^-1), with S the noise that the fit left over
// AT the line: what a filter matched to the line finds at neighbouring frequencies. So whatever the model of one or two lines
// does not explain (a third polarisation, a glide, a neighbour) widens them like noise of the same strength would.
// Two lines are reported as one partial, means by energy, and their distance is part of the standard deviation: the string has
// two pitches there.
//
#pragma once

#include <rosin/calibrate/partial_baseband.hpp>
#include <rosin/calibrate/partial_choice.hpp>
#include <rosin/core/instantiate.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct partial {
  int number = 0;
  double frequency_Hz = 0, frequency_sd = 0;
  double decay_per_s = 0, decay_sd = 0;  ///< of the amplitude
  double amplitude = 0,
         amplitude_sd = 0;  ///< at the start of the stretch, in the unit of the signal; of two lines: root of squares
  bool doubled = false;     ///< two lines
  double split_Hz = 0;      ///< between the two
  double spread_Hz = 0, spread_per_s = 0;  ///< of two lines about their mean, weighted by energy; contained in the sd above
  double lasts_s = 0;                      ///< length of the stretch that was fitted
  double signal_to_noise = 0;              ///< energy of the partial against the noise at it (matched filter), a power ratio
  double misfit = 0;                       ///< energy left over beyond the noise around, as a part of the whole
  double weight = 0;                       ///< in the fit of pitch and inharmonicity: 1 taken as it is, 0 left out

  [[nodiscard]] double inverse_q() const noexcept { return decay_per_s / (3.14159265358979323846 * frequency_Hz); }
};

/// What is kept of a partial between the passes of a fit.
struct partial_track {
  int number = 0;
  std::vector<std::complex<double>> samples;  ///< the stretch that is fitted
  double rate_Hz = 0;
  bell_window window;  ///< of the baseband: the noise has its shape
  line_fit fit;
};

namespace detail {

/// Number of samples up to where the power, averaged over 50 ms, was last above three times its lowest tenth.
inline std::size_t audible_samples(complex_span z, double rate_Hz) {
  const auto width = std::max<std::size_t>(2, static_cast<std::size_t>(0.05 * rate_Hz));
  std::vector<double> power;
  for (std::size_t j = 0; j + width <= z.size(); j += width) power.push_back(energy_of(z.subspan(j, width)));
  if (power.size() < 4) return z.size();
  std::vector<double> sorted = power;
  std::sort(sorted.begin(), sorted.end());
  const double limit = 3 * sorted[sorted.size() / 10];
  std::size_t last = power.size();
  while (last > 1 && power[last - 1] < limit) --last;
  return std::max(last * width, std::min<std::size_t>(z.size(), 8));
}

/// White noise through the window against white noise over the whole rate.
inline double filled_with_noise(const bell_window& window, double rate_Hz) {
  double sum = 0;
  for (int i = 0; i < 64; ++i) sum += std::pow(window((i + 0.5) / 64 * window.half_width_Hz), 2) / 64;
  return 2 * window.half_width_Hz * sum / rate_Hz;
}

struct line_noise {
  double at_line;  ///< density of a white complex noise that would be as strong at the line
  double away;     ///< the same some way off: the noise of the recording
};

/// What a filter matched to the decay finds beside the line in what the fit left over.
inline line_noise noise_beside(complex_span left, double rate_Hz, const damped_part& p, const bell_window& window) {
  const double lasts = static_cast<double>(left.size()) / rate_Hz, decay = std::max(p.decay_per_s, 0.0);
  const double step = std::max(1 / lasts, 2 * decay / full_turn);
  double energy = 0, near = 0, all = 0;
  std::vector<double> powers;
  for (std::size_t j = 0; j < left.size(); ++j) energy += std::exp(-2 * decay * static_cast<double>(j) / rate_Hz);
  for (int k = -12; k <= 12; ++k) {
    const double offset = p.detuning_rad_s / full_turn + k * step;
    if (k == 0 || std::abs(offset) > 0.55 * window.half_width_Hz) continue;
    const double gain = window(offset);
    const std::complex<double> turn_by =
        std::polar(std::exp(-decay / rate_Hz), -(p.detuning_rad_s + full_turn * k * step) / rate_Hz);
    std::complex<double> sum = 0, w = 1;
    for (const auto& r : left) sum += w * r, w *= turn_by;
    powers.push_back(std::norm(sum) / (energy * gain * gain));
    all += powers.back();
    if (std::abs(k) <= 3) near += powers.back() / 6;
  }
  if (powers.empty()) return {energy_of(left) / static_cast<double>(left.size()), 0};  // a line wider than the band
  all /= static_cast<double>(powers.size());
  std::nth_element(powers.begin(), powers.begin() + static_cast<std::ptrdiff_t>(powers.size() / 2), powers.end());
  return {near > 2 * all ? near : all, powers[powers.size() / 2] / 0.693};
}

/// Covariance of the parameters; the noise as density S = E|n|^2 of a white complex noise.
template <class Real = double>
Eigen::MatrixXd line_covariance(const line_fit& fit, double noise) {
  Eigen::VectorX<Real> scale = fit.information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixX<Real> unit = scale.asDiagonal() * fit.information * scale.asDiagonal();
  return noise / 2 * (scale.asDiagonal() * unit.completeOrthogonalDecomposition().pseudoInverse() * scale.asDiagonal());
}

inline const damped_part& strongest(const line_model& m, double lasts) {
  return *std::max_element(m.parts.begin(), m.parts.end(),
                           [&](const auto& a, const auto& b) { return a.energy(lasts) < b.energy(lasts); });
}

}  // namespace detail

/// Noise at the line of a track and off it; never less than rounding.
[[nodiscard]] inline detail::line_noise noise_of(const partial_track& t) {
  const auto left = detail::left_over(t.samples, t.rate_Hz, t.fit.model);
  const double lasts = static_cast<double>(t.samples.size()) / t.rate_Hz;
  const double rounding = 1e-24 * detail::energy_of(t.samples) / static_cast<double>(t.samples.size());
  const auto noise = detail::noise_beside(left, t.rate_Hz, detail::strongest(t.fit.model, lasts), t.window);
  return {std::max(noise.at_line, rounding), noise.away};
}

/// What a track says of its partial.
template <class Real = double>
[[nodiscard]] partial summary_of(const partial_track& t) {
  const double lasts = static_cast<double>(t.samples.size()) / t.rate_Hz;
  const detail::line_noise noise = noise_of(t);
  const Eigen::MatrixX<Real> covariance = detail::line_covariance(t.fit, noise.at_line);
  partial p;
  p.number = t.number;
  p.lasts_s = lasts;
  double energy = 0, detuning = 0, power = 0;
  for (const damped_part& part : t.fit.model.parts) energy += part.energy(lasts);
  Eigen::VectorX<Real> mean = Eigen::VectorX<Real>::Zero(covariance.rows()), slope = mean, loudness = mean;
  Eigen::Index at = 0;
  for (const damped_part& part : t.fit.model.parts) {
    const double w = part.energy(lasts) / energy;
    detuning += w * part.detuning_rad_s;
    p.decay_per_s += w * part.decay_per_s;
    const auto gain = t.window(std::complex<double>{part.detuning_rad_s, part.decay_per_s} / detail::full_turn);
    power += std::norm(part.amplitude / gain);
    loudness[at] = part.amplitude.real() / std::norm(gain);
    loudness[at + 1] = part.amplitude.imag() / std::norm(gain);
    slope[at + 2] = w;
    mean[at + 3] = w / detail::full_turn;
    at += 4;
  }
  double df2 = 0, da2 = 0;  // spread of the two lines
  for (const damped_part& part : t.fit.model.parts) {
    const double w = part.energy(lasts) / energy;
    df2 += w * std::pow((part.detuning_rad_s - detuning) / detail::full_turn, 2);
    da2 += w * std::pow(part.decay_per_s - p.decay_per_s, 2);
  }
  p.frequency_Hz = t.fit.model.centre_Hz + detuning / detail::full_turn;
  p.spread_Hz = std::sqrt(df2);
  p.spread_per_s = std::sqrt(da2);
  p.frequency_sd = std::sqrt(mean.dot(covariance * mean) + df2);
  p.decay_sd = std::sqrt(slope.dot(covariance * slope) + da2);
  p.amplitude = std::sqrt(power);
  p.amplitude_sd = std::sqrt(loudness.dot(covariance * loudness) / power);
  p.doubled = t.fit.model.parts.size() > 1;
  if (p.doubled)
    p.split_Hz = std::abs(t.fit.model.parts[0].detuning_rad_s - t.fit.model.parts[1].detuning_rad_s) / detail::full_turn;
  p.signal_to_noise = energy * t.rate_Hz / noise.at_line;
  const double expected = noise.away * static_cast<double>(t.samples.size()) * detail::filled_with_noise(t.window, t.rate_Hz);
  p.misfit = std::max(t.fit.residual - 1.5 * expected, 0.0) / std::max(detail::energy_of(t.samples), 1e-300);
  return p;
}
ROSIN_INSTANTIATE(partial summary_of(const partial_track&))

/// Fits the line nearest to what was expected, from start_s of the recording on. None where nothing rings within +-tolerance.
template <class = void>
[[nodiscard]] std::optional<partial_track> track_partial(const baseband_bank& bank, int number, double expected_Hz,
                                                         double tolerance_Hz, double start_s, double end_s) {
  const baseband_record whole = bank.around(expected_Hz);
  const auto from = std::min(static_cast<std::size_t>(std::ceil(start_s * whole.rate_Hz)), whole.samples.size());
  const auto to = std::clamp(static_cast<std::size_t>(end_s * whole.rate_Hz), from, whole.samples.size());
  const detail::complex_span z = detail::complex_span{whole.samples}.subspan(from, to - from);
  if (z.size() < 12) return std::nullopt;
  std::size_t length = detail::audible_samples(z, whole.rate_Hz);
  line_fit one = fit_one_line(z.first(length), whole.rate_Hz, whole.centre_Hz, tolerance_Hz);
  const double decay = one.model.parts[0].decay_per_s;
  const auto enough =
      decay > 0 ? std::max<std::size_t>(12, static_cast<std::size_t>(std::min(5 / decay * whole.rate_Hz, 1e9))) : length;
  if (enough < length) one = fit_line(z.first(length = enough), whole.rate_Hz, one.model);
  if (!(std::abs(one.model.parts[0].detuning_rad_s) < detail::full_turn * 1.5 * tolerance_Hz)) return std::nullopt;
  partial_track track{number, {z.begin(), z.begin() + static_cast<std::ptrdiff_t>(length)}, whole.rate_Hz, whole.window, one};
  track.fit = one_or_two_lines(track.samples, whole.rate_Hz, one, 1.5 * tolerance_Hz,
                               detail::filled_with_noise(whole.window, whole.rate_Hz));
  return track;
}
ROSIN_INSTANTIATE(std::optional<partial_track> track_partial(const baseband_bank&, int, double, double, double, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
