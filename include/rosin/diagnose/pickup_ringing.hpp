// tier: hosted
// SPDX-License-Identifier: MIT
//
// What one channel heard of one pluck, before any law: the partials as tracks at baseband (partials.hpp), each with how much
// information it holds. Likelihoods of all that is asked of such tracks later have one form. Of a track with M real numbers of
// which a model leaves the energy R (noise and whatever else it lacks),
//
//     ln L = -M/2 ln R,
//
// the noise not being known but taken from what is left. So a model that is wrong in other ways gains less, not more.
//
#pragma once

#include <rosin/calibrate/pickup_fit.hpp>
#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/core/number_text.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What a channel's partials have to be multiplied by to be slopes of the string, all but for one factor.
enum class pickup_kind { force, velocity, displacement, sound };

/// One channel of one pluck as it was recorded.
struct pickup_signal {
  std::string take, channel;
  double rate_Hz = 0;
  std::vector<double> values;
  pickup_kind kind = pickup_kind::sound;
  double position = 0;                                                 ///< of the sensor, fraction of the length; 0: unknown
  double from_s = -1, to_s = std::numeric_limits<double>::infinity();  ///< to be looked at; -1: from the release on

  /// Whether the slopes of the string follow from it, but for one factor.
  [[nodiscard]] bool tells_slopes() const { return kind == pickup_kind::force || (kind != pickup_kind::sound && position > 0); }
};

/// The partials of a stretch of it.
struct pickup_ringing {
  double fundamental_Hz = 0, tolerance_Hz = 0, start_s = 0, stop_s = 0;
  std::vector<partial_track> tracks;  ///< one line each
  std::vector<double> power;          ///< of each at the start, as slope of the string where the sensor is known

  [[nodiscard]] double strength() const {
    double sum = 0;
    for (const double p : power) sum += p;
    return sum;
  }
};

/// Real numbers in the band of a track.
[[nodiscard]] inline double numbers_in(const partial_track& t) {
  return 2 * detail::filled_with_noise(t.window, t.rate_Hz) * static_cast<double>(t.samples.size());
}
[[nodiscard]] inline double log_likelihood(const partial_track& t, double residual) {
  return -0.5 * numbers_in(t) * std::log(std::max(residual, 1e-300));
}

namespace detail {

/// Power at the start by energy and decay, whatever the model.
inline double power_at_start(const partial_track& t) {
  const double a = as_one(t).decay_per_s, lasts = static_cast<double>(t.samples.size()) / t.rate_Hz;
  return energy_of(t.samples) / t.rate_Hz * 2 * a / std::max(-std::expm1(-2 * a * lasts), 1e-12);
}

/// Slopes of the string against what the sensor shows of mode n; near a node nothing is known, and little is made of it.
inline double slope_weight(pickup_kind kind, double position, int n) {
  if (kind == pickup_kind::force || kind == pickup_kind::sound || !(position > 0)) return 1;
  const double shape = std::pow(std::sin(std::numbers::pi * n * position), 2);
  return (kind == pickup_kind::velocity ? 1.0 : double(n) * n) / std::max(shape, 0.1);
}

}  // namespace detail

/// The tracks that say most, at most so many, by their place in the ringing.
[[nodiscard]] inline std::vector<std::size_t> clearest(const pickup_ringing& r, std::size_t at_most = 24) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < r.tracks.size(); ++i)
    order.emplace_back(-detail::energy_of(r.tracks[i].samples) / std::max(noise_of(r.tracks[i]).away, 1e-300), i);
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < std::min(at_most, order.size()); ++k) out.push_back(order[k].second);
  return out;
}

/// The partials between from_s and to_s, and at places where a law `foretold` some. Fails as fit_pickup does.
template <class = void>
[[nodiscard]] outcome<pickup_ringing> listen(const pickup_signal& s, double nominal_Hz,
                                             const std::vector<numbered_frequency>& foretold = {},
                                             const pickup_options& options = {}) {
  if (const auto problem = detail::pickup_input_problem(s.values, s.rate_Hz, nominal_Hz, options); !problem.empty())
    return failure{problem};
  const std::span<const double> all{s.values};
  const double end = std::min(s.to_s, static_cast<double>(all.size()) / s.rate_Hz), least = std::max(0.15, 12 / nominal_Hz);
  const failure brief{"signal: less than " + number_text(least) + " s of ringing to look at"};
  if (!(end > least)) return brief;
  const baseband_bank bank{all, s.rate_Hz, std::min(64.0, 0.45 * nominal_Hz)};
  const double begin = s.from_s >= 0 ? s.from_s
                                     : detail::sound_begins_s(all.first(static_cast<std::size_t>(end * s.rate_Hz)), s.rate_Hz) +
                                           std::max(options.skip_s, bank.settling_s());
  const double stop = end - bank.settling_s() / 2;
  if (!(stop - begin > least)) return brief;
  pickup_ringing r{0, 0, begin, stop, {}, {}};
  const double seen = std::min(stop - begin, std::max(1.0, 50 / nominal_Hz));
  auto found = find_partials(all.subspan(static_cast<std::size_t>(begin * s.rate_Hz), static_cast<std::size_t>(seen * s.rate_Hz)),
                             s.rate_Hz, nominal_Hz, options.search_range, options.partials_at_most);
  for (const auto& partial : foretold) {
    std::erase_if(found.partials, [&](const numbered_frequency& p) { return p.number == partial.number; });
    found.partials.push_back(partial);
  }
  r.fundamental_Hz = found.fundamental_Hz;
  r.tolerance_Hz = std::min(0.12 * found.fundamental_Hz, 3.0);
  r.tracks = detail::pickup_tracks(bank, found, begin, stop, options.highest_Hz, r.tolerance_Hz);
  for (auto& t : r.tracks) t.fit = fit_one_line(t.samples, t.rate_Hz, t.fit.model.centre_Hz, 1.5 * r.tolerance_Hz);
  if (r.tracks.size() < 4) return failure{"partials: fewer than four stand out near multiples of the nominal fundamental"};
  for (const auto& t : r.tracks)
    r.power.push_back(detail::power_at_start(t) * detail::slope_weight(s.kind, s.position, t.number));
  return r;
}
ROSIN_INSTANTIATE(outcome<pickup_ringing> listen(const pickup_signal&, double, const std::vector<numbered_frequency>&,
                                                 const pickup_options&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
