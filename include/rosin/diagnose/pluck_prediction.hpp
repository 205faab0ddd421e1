// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a fit of plucks leaves: where it shows, how well takes that were not fitted are predicted (of them only the instant of
// release, the strength and the sensors' zeros are free, and where no other was made at that place the place, within what a
// notebook tells of it and of the nearest other), and whether what rings is noisier than what was held.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/mismatch_place.hpp>
#include <rosin/diagnose/pluck_exchange.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Where the declared model and the recordings part.
struct pluck_mismatch {
  std::size_t take = 0, channel = 0;
  std::array<double, 2> time_s{}, band_Hz{};
  double residual_over_noise = 0;
  std::optional<acting_place> place{};  ///< where what no effect accounts for acts, if that is one place
};

namespace detail {

/// Narrowest band around the strongest bin that holds four fifths of a residual's power, by a plain periodogram of at most 4096
/// samples.
inline std::array<double, 2> band_of(const Eigen::VectorXd& r, double rate_Hz) {
  const auto n = static_cast<int>(std::min<Eigen::Index>(r.size(), 4096));
  const int bins = std::min(n / 2, 400);
  std::vector<double> power(static_cast<std::size_t>(bins), 0.0);
  for (int k = 0; k < bins; ++k) {
    const double w = std::numbers::pi * (k + 0.5) / bins;
    std::complex<double> sum = 0;
    const std::complex<double> turn = std::polar(1.0, -w);
    for (Eigen::Index i = n; i-- > 0;) sum = sum * turn + r[i];
    power[static_cast<std::size_t>(k)] = std::norm(sum);
  }
  const double all = std::accumulate(power.begin(), power.end(), 0.0);
  std::size_t low = static_cast<std::size_t>(std::max_element(power.begin(), power.end()) - power.begin()), high = low;
  double held = power[low];
  while (held < 0.8 * all && (low > 0 || high + 1 < power.size())) {
    const double below = low > 0 ? power[low - 1] : -1, above = high + 1 < power.size() ? power[high + 1] : -1;
    if (below > above) held += power[--low];
    else held += power[++high];
  }
  const double width = rate_Hz / 2 / bins;
  return {static_cast<double>(low) * width, static_cast<double>(high + 1) * width};
}

/// Channel (of those that are asked), quarter period and band in which the residual of the first periods is largest.
template <class = void>
pluck_mismatch locate(const scene_data& data, const scene_fit& base, double noise, std::array<bool, 2> asked = {true, true}) {
  const auto problem = data.problem(base.effects, base.value, {1000, base.horizon_periods, true, freedom::all}, {1, 1});
  pluck_mismatch m;
  double most = 0, power = 0, count = 0;
  for (std::size_t t = 0; t < problem.takes(); ++t) {
    const auto r = residual_of(problem, base.value, t);
    const double rate = problem.rate_Hz(t);
    const auto window = static_cast<Eigen::Index>(std::max(16.0, 0.25 * rate / base.value[0]));
    for (std::size_t c = 0; c < 2; ++c) {
      power += r[c].squaredNorm(), count += static_cast<double>(r[c].size());
      for (Eigen::Index i = 0; asked[c] && i + window <= r[c].size(); i += window / 2)
        if (const double p = r[c].segment(i, window).squaredNorm(); p > most) {
          most = p;
          m.take = t, m.channel = c;
          const double begin = problem.part(t, 1).begin_s + static_cast<double>(i) / rate;
          m.time_s = {begin, begin + static_cast<double>(window) / rate};
          m.band_Hz = band_of(r[c], rate);
        }
    }
  }
  m.residual_over_noise = std::sqrt(power / std::max(1.0, count)) / noise;
  return m;
}
ROSIN_INSTANTIATE(pluck_mismatch locate(const scene_data&, const scene_fit&, double, std::array<bool, 2>))

/// A take that was not fitted, by the model of those that were.
struct seen_take {
  scene_data data;          ///< the take by itself
  scene_fit fit;            ///< release, strength and the sensors' zeros were free
  fit_stage stage;          ///< what was looked at in the end
  std::size_t nearest = 0;  ///< of those that were fitted, the one at the nearest place

  template <class = void>
  [[nodiscard]] line_problem<scene_plucks> problem() const {
    return data.problem(fit.effects, fit.value, stage, {1, 1});
  }
};

/// By its first `most_periods`; nothing where no release is found. `most`: freedom::release_only where the place is exact.
template <class Real = double>
std::optional<seen_take> see(const scene_data& data, const scene_fit& fit, const pluck_take& held, double most_periods = 1e9,
                             freedom most = freedom::release_and_place) {
  seen_take out{{{held}, data.guess, data.options, pluck_layout({held}, data.options, data.guess.ends)}, {}, {}, 0};
  const auto start = find_start(out.data.takes, data.guess);
  if (!start) return std::nullopt;
  Eigen::VectorX<Real> v(out.data.layout.size());
  v.head(pluck_layout::first_position) = fit.value.head(pluck_layout::first_position);
  std::size_t& nearest = out.nearest;
  for (std::size_t t = 1; t < data.takes.size(); ++t)
    if (std::abs(data.takes[t].position - held.position) < std::abs(data.takes[nearest].position - held.position)) nearest = t;
  if (data.takes[nearest].position == held.position && !data.options.own_places) most = freedom::release_only;
  const double place = fit.value[data.layout.position(nearest)] + held.position - data.takes[nearest].position;
  v[out.data.layout.position(0)] = place;
  const auto from = [&](int which) { return fit.value[data.layout.at(nearest, which)]; };
  v[out.data.layout.at(0, pluck_layout::release)] = start->release_s[0] + 0.25 / start->fundamental_Hz - 0.25 / fit.value[0];
  v[out.data.layout.at(0, pluck_layout::strength)] = std::log(held.strength_N);
  v[out.data.layout.at(0, pluck_layout::offset_near)] = from(pluck_layout::offset_near);
  v[out.data.layout.at(0, pluck_layout::offset_far)] = from(pluck_layout::offset_far);
  v.tail(out.data.layout.size() - out.data.layout.first_of_uneven()) =
      fit.value.segment(data.layout.first_of_uneven(), data.layout.size() - data.layout.first_of_uneven());
  std::vector<pluck_effect> effects;
  Eigen::Index at = data.layout.size();
  double horizon = std::min(most_periods, fit.horizon_periods);
  for (const pluck_effect& e : fit.effects) {
    pluck_effect mine = e;
    double own = 0, count = 0;  // what is never zero begins where the others are
    for (std::size_t i = 0; i < e.parameters.size(); ++i)
      if (e.parameters[i].take >= 0 && e.parameters[i].low > 0) own += fit.value[at + static_cast<Eigen::Index>(i)], count += 1;
    std::erase_if(mine.parameters, [](const effect_parameter& p) { return p.take > 0; });
    for (const effect_parameter& p : mine.parameters) {
      v.conservativeResize(v.size() + 1);
      v[v.size() - 1] = p.take < 0 ? fit.value[at + (&p - mine.parameters.data())] : count > 0 ? own / count : 0.0;
    }
    horizon = std::min(horizon, e.horizon_periods);
    at += static_cast<Eigen::Index>(e.parameters.size());
    effects.push_back(std::move(mine));
  }
  const auto fit_with = [&](freedom free) {
    out.stage = {1000, horizon, true, free};
    out.fit = fit_scene(out.data, effects, v,
                        {{12, std::min(8.0, horizon), false, free}, {1000, std::min(12.0, horizon), true, free}, out.stage},
                        {1e-3, 1e-3});
  };
  fit_with(most);
  constexpr double both = 2;  // either place may be off by the tolerance
  if (!(std::abs(out.fit.value[out.data.layout.position(0)] - place) <= both * data.guess.position_tolerance))
    fit_with(freedom::release_only);
  return out;
}
ROSIN_INSTANTIATE(std::optional<seen_take> see(const scene_data&, const scene_fit&, const pluck_take&, double, freedom))

/// Of a take that was not fitted: rms residual / rms recorded; the noise's share; samples.
template <class = void>
std::array<double, 3> predicted(const scene_data& data, const scene_fit& fit, const pluck_take& held, double noise,
                                freedom most = freedom::release_and_place) {
  const auto seen = see(data, fit, held, 1e9, most);
  if (!seen) return {1, 0, 0};
  const auto problem = seen->problem();
  double power = 0, samples = 0;
  for (const auto& part : {problem.part(0, 0), problem.part(0, 1)})
    for (const auto& d : part.data) power += d.squaredNorm(), samples += static_cast<double>(d.size());
  const double mean_square = (seen->fit.quality.samples[0] + seen->fit.quality.samples[1]) / std::max(1.0, samples);
  return {seen->fit.quality.residual_ratio[0], noise * std::sqrt(mean_square * samples / std::max(1e-300, power)), samples};
}
ROSIN_INSTANTIATE(std::array<double, 3> predicted(const scene_data&, const scene_fit&, const pluck_take&, double, freedom))

/// What is left of a series without its mean and slope, squared and summed.
template <class Real = double>
[[nodiscard]] double power_without_trend(const Eigen::VectorXd& x) {
  if (x.size() < 3) return 0;
  const Eigen::VectorX<Real> t = Eigen::VectorX<Real>::LinSpaced(x.size(), -1, 1), level = x.array() - x.mean();
  return (level - t * (t.dot(level) / t.squaredNorm())).squaredNorm();
}

/// White noise of each channel, N, and how many independent samples of it were seen.
struct seen_noise {
  std::array<double, 2> rms_N{};
  double samples = 0;
};

/// What the recordings show before the release beside the steady force; nothing where that is too short.
template <class = void>
seen_noise noise_before_release(const scene_data& data, const scene_fit& fit) {
  constexpr double least_samples = 30;
  const auto problem = data.problem(fit.effects, fit.value, {1000, fit.horizon_periods, true, freedom::all}, {1, 1});
  std::array<double, 2> power{};
  seen_noise out;
  for (std::size_t t = 0; t < problem.takes(); ++t) {
    const auto& held = problem.part(t, 0);
    double passed = 0;  // the share of white noise that the band lets through
    for (int i = 0; i < 1000; ++i) passed += std::pow(problem.limits()(problem.rate_Hz(t) * (i + 0.5) / 2000), 2) / 1000;
    out.samples += static_cast<double>(held.count()) * passed;
    for (std::size_t c = 0; c < 2; ++c) power[c] += power_without_trend(held.data[c]);
  }
  if (!(out.samples > least_samples)) return {};
  for (std::size_t c = 0; c < 2; ++c) out.rms_N[c] = std::sqrt(power[c] / out.samples);
  return out;
}
ROSIN_INSTANTIATE(seen_noise noise_before_release(const scene_data&, const scene_fit&))

/// What modulates partials - a clock that is not steady, bursts - passes for noise among the lines, but not before the release.
/// By three tenths, and four standard deviations of what was seen there; by four tenths where slow noise was taken out: some of it stays
/// at the partials and passes for a trend before the release, so that the two scatter by a twelfth about 1.05 (seven strings as declared).
[[nodiscard]] inline bool is_noisier(const std::array<double, 2>& ringing, const seen_noise& still, bool was_slow = false) {
  if (!(still.samples > 0)) return false;
  const double much = std::max(was_slow ? 1.4 : 1.3, 1 + 4 / std::sqrt(2 * still.samples));
  return ringing[0] > much * still.rms_N[0] || ringing[1] > much * still.rms_N[1];
}

[[nodiscard]] inline double rms_of(const std::array<double, 2>& x) { return std::sqrt((x[0] * x[0] + x[1] * x[1]) / 2); }

/// What the last effect of a fit is worth to takes that were not fitted: by how much ln L is higher, misfit counted as noise, and
/// what it takes from the residual, rms relative to the recording's.
struct held_out_worth {
  double gain = 0, taken = 0;
};
template <class = void>
held_out_worth held_out_gain(const scene_data& data, const scene_fit& fit, const std::vector<pluck_take>& held, double noise) {
  scene_fit less = without(fit, fit.effects.size() - 1);
  less = fit_scene(data, less.effects, less.value, {{1000, fit.horizon_periods, true, data.compared()}}, {noise, noise});
  less.horizon_periods = fit.horizon_periods;
  held_out_worth out;
  double power = 0;
  for (const pluck_take& take : held) {
    const auto b = predicted(data, less, take, noise), a = predicted(data, fit, take, noise);
    out.gain += 0.5 * a[2] * (b[0] * b[0] - a[0] * a[0]) / std::max(a[1] * a[1], a[0] * a[0]);
    power += (b[0] * b[0] - a[0] * a[0]) / static_cast<double>(held.size());
  }
  out.taken = std::sqrt(std::max(0.0, power));
  return out;
}

}  // namespace detail

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
