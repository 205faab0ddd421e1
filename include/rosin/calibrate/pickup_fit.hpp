// tier: hosted
// SPDX-License-Identifier: MIT
//
// Calibration from one channel that knows nothing of newtons: a pickup or a microphone, a plucked or struck string. Out come the
// partials, the pitch and inharmonicity behind them (f_n = n f0 sqrt(1 + b n^2)) and the loss law, each with the standard
// deviation that the data deserve: errors of the single lines, and their scatter about the law, which is mostly the supports'
// doing.
//
//     search (partial_search) -> one or two lines each (partials) -> common glide (pickup_glide) -> pitch, loss (pickup_regression)
//
// Gains, force and position of the pluck cannot be had from such a channel: for these take two force channels (pluck_fit.hpp).
//
#pragma once

#include <rosin/calibrate/partial_search.hpp>
#include <rosin/calibrate/partials.hpp>
#include <rosin/calibrate/pickup_glide.hpp>
#include <rosin/calibrate/pickup_loss.hpp>
#include <rosin/calibrate/pickup_pitch.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/core/number_text.hpp>
#include <rosin/core/outcome.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct pickup_options {
  std::optional<double> release_s{};                       ///< when the string is let go; without it: where the sound rises
  double skip_s = 0.05;                                    ///< of the sound after that: attack, and the worst of the glide
  double end_s = std::numeric_limits<double>::infinity();  ///< the string rings freely up to here, or to the end
  double search_range = 0.06;                              ///< how far the pitch may be from the nominal one, as a part of it
  double highest_Hz = std::numeric_limits<double>::infinity();
  int partials_at_most = 64;
};

struct pickup_fit {
  double fundamental_Hz = 0, fundamental_sd = 0;  ///< of the string without stiffness: mode n at n f0 sqrt(1 + b n^2)
  double inharmonicity = 0, inharmonicity_sd = 0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of f0 and b
  loss_estimate loss;
  std::vector<partial> partials;
  double scatter_Hz = 0;       ///< of the partials about the law, beyond their own errors (of the first one, if in_proportion)
  bool in_proportion = false;  ///< the scatter grows with the number of the partial
  pitch_glide glide;           ///< taken out of all partials; relative is 0 where none was found
  double glide_sd = 0;
  double start_s = 0;  ///< of what was fitted, in the time of the recording
  std::vector<std::string> warnings;
};

namespace detail {

/// The first 5 ms whose power is a tenth of the loudest's.
inline double sound_begins_s(std::span<const double> x, double rate_Hz) {
  const auto block = std::max<std::size_t>(1, static_cast<std::size_t>(0.005 * rate_Hz));
  std::vector<double> power;
  for (std::size_t j = 0; j + block <= x.size(); j += block) {
    double sum = 0;
    for (const double v : x.subspan(j, block)) sum += v * v;
    power.push_back(sum);
  }
  const double loud = 0.1 * *std::max_element(power.begin(), power.end());
  const auto first = std::find_if(power.begin(), power.end(), [&](double p) { return p >= loud; });
  return static_cast<double>(first - power.begin()) * static_cast<double>(block) / rate_Hz;
}

inline std::string pickup_input_problem(std::span<const double> x, double rate_Hz, double nominal_Hz, const pickup_options& o) {
  if (!(rate_Hz > 0) || !std::isfinite(rate_Hz)) return "sampling rate: has to be positive";
  if (!(nominal_Hz >= 5) || !(nominal_Hz < rate_Hz / 5))
    return "nominal fundamental: has to lie between 5 Hz and a fifth of the sampling rate";
  if (!(o.search_range > 0) || !(o.search_range < 0.3)) return "search_range: has to lie between 0 and 0.3";
  for (std::size_t j = 0; j < x.size(); ++j)
    if (!std::isfinite(x[j])) return "sample " + std::to_string(j) + ": not a finite number";
  if (std::all_of(x.begin(), x.end(), [](double v) { return v == 0; })) return "signal: there is nothing but zeros";
  return {};
}

inline bool believable(const partial& p, double expected_Hz, double f0) {
  return std::isfinite(p.frequency_sd) && std::isfinite(p.decay_sd) && p.signal_to_noise > 30 && p.frequency_sd < 0.05 * f0 &&
         std::abs(p.frequency_Hz - expected_Hz) < 0.2 * f0;
}

/// The tracks of what was found that can be believed.
template <class = void>
std::vector<partial_track> pickup_tracks(const baseband_bank& bank, const found_partials& found, double start_s, double stop_s,
                                         double highest_Hz, double tolerance_Hz) {
  std::vector<partial_track> tracks;
  for (const auto& line : found.partials) {
    if (line.frequency_Hz > highest_Hz) continue;
    auto t = track_partial(bank, line.number, line.frequency_Hz, tolerance_Hz, start_s, stop_s);
    if (t && believable(summary_of(*t), line.frequency_Hz, found.fundamental_Hz)) tracks.push_back(std::move(*t));
  }
  return tracks;
}

/// If most partials are double the string itself has two pitches (losses): their relative distance, which no number of partials
/// averages away.
inline double common_spread(const std::vector<partial>& partials, double partial::*spread, double partial::*value) {
  Eigen::VectorXd relative(static_cast<Eigen::Index>(partials.size()));
  for (std::size_t i = 0; i < partials.size(); ++i)
    relative[static_cast<Eigen::Index>(i)] = partials[i].*spread / std::max(std::abs(partials[i].*value), 1e-300);
  return std::min(median_of(relative), 1.0);
}

/// What that does to f0 and b: which of the two pitches is heard more may be the same for all partials, and may drift along them.
template <class Real = double>
Eigen::Matrix2d two_pitches(const std::vector<partial>& partials, const robust_fit& pitch) {
  const double spread = common_spread(partials, &partial::spread_Hz, &partial::frequency_Hz);
  const double first = partials.front().number, last = partials.back().number;
  Eigen::VectorX<Real> drift(static_cast<Eigen::Index>(partials.size()));
  for (std::size_t i = 0; i < partials.size(); ++i)
    drift[static_cast<Eigen::Index>(i)] =
        spread * partials[i].frequency_Hz * ((partials[i].number - first) / (last - first) - 0.5);
  const Eigen::Vector2d moved = pitch.gain * drift;
  Eigen::Matrix2d covariance = moved * moved.transpose();
  covariance(0, 0) += std::pow(spread * pitch.value[0], 2);
  return covariance;
}

template <class Real = double>
void fit_laws(pickup_fit& fit, const found_partials& found, const glide_estimate& glide) {
  std::vector<numbered_frequency> lines;
  std::vector<measured_decay> decays;
  for (const partial& p : fit.partials) {
    lines.push_back({p.number, p.frequency_Hz, p.frequency_sd});
    decays.push_back({p.frequency_Hz, p.decay_per_s, p.decay_sd});
  }
  const robust_fit pitch = fit_pitch(lines, found.fundamental_Hz, found.inharmonicity);
  const Eigen::VectorX<Real> share =
      Eigen::Map<const Eigen::VectorX<Real>>(glide.share_Hz.data(), static_cast<Eigen::Index>(glide.share_Hz.size()));
  const Eigen::Vector2d common = glide.sd * (pitch.gain * share);
  fit.fundamental_Hz = pitch.value[0];
  fit.inharmonicity = pitch.value[1];
  fit.covariance = pitch.covariance + common * common.transpose();
  fit.covariance += two_pitches(fit.partials, pitch);
  fit.fundamental_sd = std::sqrt(fit.covariance(0, 0));
  fit.inharmonicity_sd = std::sqrt(fit.covariance(1, 1));
  fit.scatter_Hz = pitch.scatter;
  fit.in_proportion = pitch.in_proportion;
  for (std::size_t i = 0; i < fit.partials.size(); ++i) fit.partials[i].weight = pitch.weight[static_cast<Eigen::Index>(i)];
  std::erase_if(decays, [](const measured_decay& d) { return !(d.decay_per_s > -5 * d.sd_per_s); });
  if (decays.empty()) return;
  fit.loss = fit_loss(decays);
  const double spread = common_spread(fit.partials, &partial::spread_per_s, &partial::decay_per_s);
  fit.loss.covariance += spread * spread * fit.loss.value * fit.loss.value.transpose();
  fit.loss.sd = fit.loss.covariance.diagonal().cwiseSqrt();
}

inline void add_warnings(pickup_fit& fit, double nominal_Hz) {
  const auto percent = [](double v) { return number_text(100 * v, "%.1f") + " %"; };
  const auto say = [&](bool when, std::string what) {
    if (when) fit.warnings.push_back(std::move(what));
  };
  const auto count = fit.partials.size();
  std::size_t left_out = 0, growing = 0, odd = 0;
  for (const partial& p : fit.partials) {
    left_out += p.weight == 0 ? 1U : 0U;
    growing += p.decay_per_s < p.decay_sd ? 1U : 0U;
    odd += p.misfit > 0.1 ? 1U : 0U;
  }
  const double off = fit.fundamental_Hz / nominal_Hz - 1;
  const std::string of = " of " + std::to_string(count) + " partials ";
  say(std::abs(off) > 0.02, "pitch: " + percent(off) + " from the nominal one");
  say(count < 6, "partials: only " + std::to_string(count) + " found; errors of pitch and inharmonicity are rough");
  say(!(fit.inharmonicity > 2 * fit.inharmonicity_sd), "inharmonicity: not told from zero by these partials");
  say(5 * left_out > count, "partials: " + std::to_string(left_out) + of + "lie far off the law of a stiff string");
  say(5 * growing > count, "decay: " + std::to_string(growing) + of + "do not clearly decay; a string that is let go does");
  say(5 * odd > count,
      "decay: " + std::to_string(odd) + of + "are not one or two damped lines (more than a tenth of their energy is left over)");
  say(std::abs(fit.glide.relative) > 1e-3, "pitch glide: sharp by " + percent(fit.glide.relative) + " at the start; taken out");
}

template <class = void>
outcome<pickup_fit> fit_stretch(std::span<const double> signal, double rate_Hz, double nominal_Hz, const pickup_options& options,
                                const baseband_bank& bank, double start_s, double stop_s) {
  const double seen_s = std::min(stop_s - start_s, std::max(1.0, 50 / nominal_Hz));
  const auto first = signal.subspan(static_cast<std::size_t>(start_s * rate_Hz), static_cast<std::size_t>(seen_s * rate_Hz));
  const auto found = find_partials(first, rate_Hz, nominal_Hz, options.search_range, options.partials_at_most);
  const double f0 = found.fundamental_Hz, tolerance = std::min(0.12 * f0, 3.0);
  auto tracks = pickup_tracks(bank, found, start_s, stop_s, options.highest_Hz, tolerance);
  if (tracks.size() < 3) return failure{"partials: fewer than three stand out near multiples of the nominal fundamental"};

  glide_estimate glide = estimate_glide(tracks);
  if (glide.glide.relative != 0) take_out_glide(tracks, glide.glide, 1.5 * tolerance);
  pickup_fit fit;
  std::vector<double> shares;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const partial p = summary_of(tracks[i]);
    if (!believable(p, partial_frequency(f0, found.inharmonicity, p.number), f0)) continue;
    fit.partials.push_back(p);
    shares.push_back(glide.share_Hz[i]);
  }
  if (fit.partials.size() < 3) return failure{"partials: fewer than three are damped lines"};
  const auto steady =
      std::count_if(fit.partials.begin(), fit.partials.end(), [](const partial& p) { return p.decay_per_s < p.decay_sd; });
  if (2 * steady > static_cast<std::ptrdiff_t>(fit.partials.size()))
    return failure{"decay: " + std::to_string(steady) + " of " + std::to_string(fit.partials.size()) +
                   " partials do not clearly decay; this is no string that rings freely"};
  glide.share_Hz = shares;
  fit.glide = glide.glide;
  fit.glide_sd = glide.sd;
  fit.start_s = start_s;
  fit_laws(fit, found, glide);
  if (!std::isfinite(fit.fundamental_sd) || !std::isfinite(fit.inharmonicity_sd))
    return failure{"partials: they do not tell pitch and inharmonicity"};
  return fit;
}

}  // namespace detail

/// Fits a recording of one free ringing. nominal_Hz: the pitch to be expected, within options.search_range. A glide is modelled,
/// not waited for: once it is over, the high partials are gone, and what stands in their places is the pickup's distortion of the
/// low ones.
template <class = void>
[[nodiscard]] outcome<pickup_fit> fit_pickup(std::span<const double> signal, double rate_Hz, double nominal_Hz,
                                             const pickup_options& options = {}) {
  if (const auto problem = detail::pickup_input_problem(signal, rate_Hz, nominal_Hz, options); !problem.empty())
    return failure{problem};
  const double end = std::min(options.end_s, static_cast<double>(signal.size()) / rate_Hz),
               least = std::max(0.15, 12 / nominal_Hz);
  const auto heard = signal.first(static_cast<std::size_t>(std::max(end, 0.0) * rate_Hz));
  const failure brief{"signal: less than " + number_text(least) + " s of ringing to look at"};
  if (static_cast<double>(heard.size()) < least * rate_Hz) return brief;
  const double begin = options.release_s ? *options.release_s : detail::sound_begins_s(heard, rate_Hz);
  const baseband_bank bank{signal, rate_Hz, std::min(64.0, 0.45 * nominal_Hz)};
  const double start = begin + std::max(options.skip_s, bank.settling_s()), stop = end - bank.settling_s() / 2;
  if (!(begin >= 0) || !(stop - start > least)) return brief;
  outcome<pickup_fit> fit = detail::fit_stretch(signal, rate_Hz, nominal_Hz, options, bank, start, stop);
  if (fit) detail::add_warnings(*fit, nominal_Hz);
  return fit;
}
ROSIN_INSTANTIATE(outcome<pickup_fit> fit_pickup(std::span<const double>, double, double, const pickup_options&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
