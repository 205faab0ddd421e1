// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a pluck has to look like. Both forces fall by the breaking force F when the release reaches them, near first where
// beta < 1/2: t_near - t_far = (2 beta - 1) / (2 f0). Before that they stand at F (1 - beta) and F beta. So an inverted
// channel steps upwards; with swapped channels both the order of arrival and the ratio of the levels belong to 1 - beta.
//
// All of that is about the first step. In the ringing, too, either end steps twice a period, now up, now down: a take that begins in
// there has a first step that tells nothing of polarity, order or level. What proves a release is a period in which nothing moves
// before the first one.
//
#pragma once

#include <rosin/acquire/release.hpp>
#include <rosin/acquire/rig_values.hpp>
#include <rosin/acquire/ringing.hpp>
#include <rosin/acquire/signal_checks.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin::detail {

/// What is known of a pluck when the checks begin.
struct pluck_view {
  const rig* from;
  const take* what;
  const take_signals* signals;
  double fundamental_Hz, inharmonicity;
};

struct pluck_steps {
  step_arrival near, far;
  double near_level = 0, far_level = 0;  ///< before the release
};

[[nodiscard]] inline double level_before(const std::vector<double>& x, std::size_t step, double rate, double fundamental) {
  const auto ahead = static_cast<std::size_t>(rate / fundamental);  // what runs ahead of the step is left out
  const std::size_t end = step > 2 * ahead ? step - ahead : std::max<std::size_t>(1, step / 2);
  double sum = 0;
  for (std::size_t i = 0; i < end; ++i) sum += x[i];
  return sum / static_cast<double>(end);
}

/// "; a force_N of ... or a scale of ... would agree", where a power of ten does.
[[nodiscard]] inline std::string likely_scale(const pluck_view& view, const std::string& channel, double height) {
  const double force = view.what->force_N.value_or(0), scale = view.from->channel(channel)->per_full_scale.value_or(0);
  if (!(force > 0 && height != 0)) return {};
  const double off = std::log10(std::abs(height) / force), power = std::round(off);
  if (power == 0 || std::abs(off - power) > 0.12) return {};
  return ": off by a power of ten; force_N = " + figure(force * std::pow(10.0, power)) +
         ", or newtons_per_full_scale = " + figure(scale / std::pow(10.0, power)) + " of this channel, would agree";
}

/// The step against the wire's force, both tolerances allowed for.
[[nodiscard]] inline bool scale_is_wrong(const pluck_view& view, const std::string& channel, const step_arrival& step) {
  const double tolerance = 0.25 + gain_tolerance_of(*view.from->channel(channel)) + force_tolerance_of(*view.what);
  const double force = view.what->force_N.value_or(0), ratio = std::abs(step.height) / force;
  return force > 0 && (ratio > 1 + tolerance || ratio < 1 / (1 + tolerance));
}

/// What the recording holds of the time before the release.
enum class lead_in { none, short_one, enough };

/// A stretch of one period before the step, and before what runs ahead of it, in which nothing moves: no ringing has one.
[[nodiscard]] inline bool at_rest_before(const std::vector<double>& x, const step_arrival& step, double period) {
  constexpr double ahead = 0.25, least = 0.15;  // periods; of the step: plucked at 0.03 of its length a string rings with 0.17
  const auto end = static_cast<std::ptrdiff_t>(static_cast<double>(step.frame) - ahead * period),
             begin = end - static_cast<std::ptrdiff_t>(period);
  if (begin < 0) return false;
  double mean = 0, square = 0;
  for (auto i = begin; i < end; ++i) mean += x[static_cast<std::size_t>(i)] / static_cast<double>(end - begin);
  for (auto i = begin; i < end; ++i)
    square += std::pow(x[static_cast<std::size_t>(i)] - mean, 2) / static_cast<double>(end - begin);
  return std::sqrt(square) < least * std::abs(step.height);
}

/// Less than `least` periods at rest are too few for the level that was held. Less than one period does not prove a release: it has to
/// look like one at the declared place, at least.
[[nodiscard]] inline lead_in lead_of(const pluck_view& view, const pluck_steps& steps) {
  constexpr double least = 0.3, aside = 0.06;  // periods; of the length
  const double period = view.signals->sample_rate_Hz / view.fundamental_Hz;
  if (at_rest_before(view.signals->near_N(), steps.near, period) || at_rest_before(view.signals->far_N(), steps.far, period))
    return lead_in::enough;
  const double near = static_cast<double>(steps.near.frame) / period, far = static_cast<double>(steps.far.frame) / period;
  const auto declared = view.from->position_of(*view.what);
  const bool downwards = steps.near.height < 0 && steps.far.height < 0;
  const bool whole =
      std::max(near, far) < 1.5 && !scale_is_wrong(view, "near", steps.near) && !scale_is_wrong(view, "far", steps.far);
  const bool in_place = !declared || std::abs(0.5 + near - far - *declared) < aside;
  return whole && downwards && in_place && std::min(near, far) > least ? lead_in::short_one : lead_in::none;
}

/// True if the steps can be judged.
inline bool check_lead(take_check& out, const pluck_view& view, const pluck_steps& steps) {
  const double first = view.signals->time_s(std::min(steps.near.frame, steps.far.frame));
  const std::string advice = "keep more of the time before the release (rosin record --before)";
  const lead_in lead = lead_of(view, steps);
  if (lead == lead_in::none)
    out.add(severity::error, "begins-late", "", 0, first,
            "begins after the release, or a fraction of a period before it: the ends move " + figure(1e3 * first) +
                " ms after the beginning, a period is " + figure(1e3 / view.fundamental_Hz) +
                " ms; polarity, order of the channels, gains and place cannot be told from it",
            advice);
  else if (lead == lead_in::short_one)
    out.add(severity::warning, "short-lead", "", 0, first,
            "only " + figure(1e3 * first) +
                " ms before the release are recorded, less than a period: that it is the release, and no " +
                "later return of it, cannot be told",
            advice);
  return lead != lead_in::none;
}

inline void check_step(take_check& out, const pluck_view& view, const std::string& channel, const step_arrival& step) {
  const double t = view.signals->time_s(step.frame), force = view.what->force_N.value_or(0);
  if (step.height > 0)
    out.add(severity::error, "inverted-channel", channel, t, t, "the release steps upwards by " + figure(step.height) + " N",
            "turn the polarity of this channel round (both: the take was plucked against the way the bow moves)");
  if (scale_is_wrong(view, channel, step))
    out.add(severity::warning, "wrong-scale", channel, t, t,
            "the release steps by " + figure(std::abs(step.height)) + " N, force_N is " + figure(force) +
                likely_scale(view, channel, step.height),
            "check newtons_per_full_scale, force_N and whether the wire broke at once");
}

/// The levels before the release: near zero means that the sensors do not pass them.
inline bool check_coupling(take_check& out, const pluck_view& view, const pluck_steps& steps) {
  const double force = view.what->force_N.value_or(std::abs(steps.near.height));
  if (std::abs(steps.near_level) + std::abs(steps.far_level) > 0.25 * force) return true;
  for (const char* name : {"near", "far"})
    if (!view.from->channel(name)->ac_coupled_Hz)
      out.add(severity::warning, "undeclared-ac-coupling", name, 0, view.signals->time_s(steps.near.frame),
              "the deflecting force before the release does not show: the sensor seems to be AC coupled",
              "declare ac_coupled_Hz of the channel, or record DC coupled");
  return false;
}

inline void check_order(take_check& out, const pluck_view& view, const pluck_steps& steps, bool levels) {
  const auto declared = view.from->position_of(*view.what);
  const double rate = view.signals->sample_rate_Hz;
  if (!declared || std::abs(*declared - 0.5) < 0.04) return;
  const double lag = static_cast<double>(steps.near.frame) - static_cast<double>(steps.far.frame);
  const double by_arrival = 0.5 + lag / rate * view.fundamental_Hz;
  const double sum = steps.near_level + steps.far_level;
  const double by_level = levels && sum != 0 ? steps.far_level / sum : by_arrival;
  const double t = view.signals->time_s(steps.near.frame);
  const auto mirrored = [&](double beta) { return std::abs(beta - (1 - *declared)) < 0.5 * std::abs(beta - *declared); };
  const std::string figures = "the release reaches the ends as if plucked at " + figure(by_arrival, "%.3f") +
                              (levels ? ", the levels before it say " + figure(by_level, "%.3f") : std::string{}) +
                              ", declared is " + figure(*declared, "%.3f");
  if (mirrored(by_arrival) && mirrored(by_level))
    out.add(severity::error, "swapped-channels", "", 0, t, figures,
            "near and far are swapped, or position counts from the wrong end");
  else if (std::abs(by_level - *declared) > 0.06 || std::abs(by_arrival - *declared) > 0.06)
    out.add(severity::warning, "wrong-position", "", 0, t, figures, "check the position, the gains and the fundamental");
}

/// What the ends do after the ringing has been averaged out: nothing is left of the deflection.
inline void check_tail(take_check& out, const pluck_view& view, const take_signal& s, const step_arrival& step) {
  const auto period = view.signals->sample_rate_Hz / view.fundamental_Hz;
  const auto left = static_cast<double>(s.values.size() - step.frame);
  const auto count = static_cast<std::size_t>(std::floor(left / 2 / period) * period);
  if (count == 0 || s.sensor.ac_coupled_Hz || left < 16 * period) return;
  double mean = 0;
  for (std::size_t i = s.values.size() - count; i < s.values.size(); ++i) mean += s.values[i] / static_cast<double>(count);
  if (std::abs(mean) > 0.03 * std::abs(step.height))
    out.add(severity::warning, "offset", s.sensor.name, out.duration_s - view.signals->time_s(count), out.duration_s,
            "the ringing's mean is " + figure(mean) + " N instead of zero",
            "set the zero of the amplifier with the string at rest");
}

/// The release at the string, from its arrival at both ends.
[[nodiscard]] inline double release_time(const pluck_view& view, const pluck_steps& steps) {
  const double arrivals = view.signals->time_s(steps.near.frame) + view.signals->time_s(steps.far.frame);
  return arrivals / 2 - 1 / (4 * view.fundamental_Hz);
}

/// True if the take holds a release.
inline bool check_steps(take_check& out, const pluck_view& view, pluck_steps& steps) {
  bool all = true;
  for (const auto& [name, step, level] :
       {std::tuple{"near", &steps.near, &steps.near_level}, std::tuple{"far", &steps.far, &steps.far_level}}) {
    const auto& x = view.signals->find(name)->values;
    const double rate = view.signals->sample_rate_Hz, force = view.what->force_N.value_or(0);
    const auto found = rosin::find_release_step(x, rate, view.fundamental_Hz);
    if (found && std::abs(found->height) > 0.2 * force && std::abs(found->height) > 0) {
      *step = *found;
      *level = level_before(x, found->frame, rate, view.fundamental_Hz);
      continue;
    }
    all = false;
    out.add(severity::error, "no-release", name, 0, out.duration_s,
            "no release: the largest step is " + figure(found ? std::abs(found->height) : 0) + " N, force_N is " + figure(force) +
                (found ? likely_scale(view, name, found->height) : std::string{}),
            "check that the take holds the pluck, and the channel's scale");
  }
  return all;
}

}  // namespace rosin::detail

#include <rosin/core/macros_back.ipp>
