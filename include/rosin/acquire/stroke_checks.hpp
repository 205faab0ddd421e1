// tier: hosted
// SPDX-License-Identifier: MIT
//
// What can be wrong with a stroke: polarity, columns that were swapped, a bow that does not move, a force channel below zero, a
// sampling rate that is not the true one. What a string may do by itself (slip twice, sound flat, rattle) is no fault.
//
#pragma once

#include <rosin/acquire/ringing.hpp>
#include <rosin/acquire/signal_checks.hpp>
#include <rosin/acquire/stroke_motion.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin::detail {

/// Within 0.8 % of a rate that converters have: what a wrong header would turn a sound recording into.
[[nodiscard]] inline bool is_usual_rate(double rate_Hz) {
  for (const double family : {44100.0, 48000.0, 50000.0, 51200.0, 65536.0, 64000.0})
    for (double r = family / 8; r < 1e6; r *= 2)
      if (std::abs(rate_Hz / r - 1) < 0.008) return true;
  return false;
}

/// How much a channel repeats itself after a period, and how much it moves within half of one.
struct periodic_part {
  double correlation = 0, rms = 0, mean = 0;
};

template <class = void>
[[nodiscard]] periodic_part periodic_part_of(std::span<const double> x, double period) {
  const auto p = static_cast<std::size_t>(std::lround(period)), half = p / 2;
  periodic_part out;
  if (half == 0 || x.size() < 4 * p) return out;
  std::vector<double> moved;
  double mean = 0;
  for (std::size_t i = half; i < x.size(); ++i) moved.push_back(x[i] - x[i - half]);
  for (const double m : moved) mean += m / static_cast<double>(moved.size());
  for (const double v : x) out.mean += v / static_cast<double>(x.size());
  double own = 0, shared = 0;
  for (std::size_t i = 0; i + p < moved.size(); ++i) {
    own += ((moved[i] - mean) * (moved[i] - mean) + (moved[i + p] - mean) * (moved[i + p] - mean)) / 2;
    shared += (moved[i] - mean) * (moved[i + p] - mean);
  }
  out.correlation = own > 0 ? shared / own : 0;
  out.rms = std::sqrt(own / static_cast<double>(moved.size() - p));
  return out;
}

/// The middle half of a take: what a stroke is, whatever else the channels say.
[[nodiscard]] inline std::span<const double> middle_of(const std::vector<double>& x) noexcept {
  return std::span{x}.subspan(x.size() / 4, x.size() / 2);
}

/// A channel of the bow that vibrates as a string does, beside a force on the string's end that does not.
template <class = void>
void check_bow_columns(take_check& out, const take_signals& from, double fundamental_Hz) {
  const double period = from.sample_rate_Hz / fundamental_Hz;
  const take_signal* still = nullptr;
  for (const char* end : {"near", "far"})
    if (const auto* s = from.find(end); s != nullptr && periodic_part_of(middle_of(s->values), period).correlation < 0.2)
      still = s;
  for (const auto& s : from.signals) {
    if (s.sensor.quantity != quantity::bow_speed && s.sensor.quantity != quantity::normal_force) continue;
    const auto part = periodic_part_of(middle_of(s.values), period);
    if (still != nullptr && part.correlation > 0.5 && part.rms > 0.2 * std::abs(part.mean))
      out.add(severity::error, "swapped-channels", s.sensor.name, 0, out.duration_s,
              "is declared as " + name_of(s.sensor.quantity) + " but vibrates at the string's pitch, and channel " +
                  still->sensor.name + " does not",
              "check the columns of the file against [channels]");
  }
}

/// The ends share the mean friction as (1 - position) : position.
template <class = void>
void check_end_columns(take_check& out, const rig& r, const take& t, double near, double far) {
  const auto position = r.position_of(t);
  if (!position || near <= 0 || far <= 0) return;
  const double as_if = far / (near + far);
  if (std::abs(as_if - *position) > 0.15 && std::abs(as_if - (1 - *position)) < 0.05)
    out.add(severity::error, "swapped-channels", "", 0, out.duration_s,
            "the mean forces are shared as if bowed at " + figure(as_if) + " of the length, declared is " + figure(*position),
            "near and far are swapped, or the position counts from the wrong end");
}

template <class = void>
void check_motion(take_check& out, const take_signals& from, const stroke_motion& moved, double friction_N) {
  const double end_s = out.duration_s;
  if (!moved.speed_m_s.empty()) {
    const stroke_blocks speed{moved.speed_m_s, from.sample_rate_Hz};
    double fastest = 0;
    for (const double v : speed.mean) fastest = std::max(fastest, std::abs(v));
    if (fastest < std::max(5e-4, 5 * moved.speed_noise_m_s / std::sqrt(static_cast<double>(speed.samples))))
      out.add(severity::error, "no-motion", moved.speed_channel, 0, end_s,
              "the bow does not move: " + figure(fastest) + " m/s at most", "check the sled, its channel and which take this is");
  }
  if (moved.hint_doubted)
    out.add(severity::note, "unsteady", moved.speed_channel, 0, end_s,
            "the bow is off its steady speed or force for most of steady_s", "what is steady was sought in the channels instead");
  if (moved.normal_force_N.empty()) return;
  const auto level = stroke_blocks{moved.normal_force_N, from.sample_rate_Hz}.mean;
  const double high = quantile_of(level, 0.8), middle = quantile_of(level, 0.5);
  if (high <= 0)
    out.add(middle > -0.1 ? severity::warning : severity::error, "below-zero", moved.normal_channel, 0, end_s,
            "the normal force is below zero: " + figure(middle) + " N for half of the take",
            middle > -0.1 ? "the amplifier's zero is off by more than that: record some time with the bow off the string"
                          : "turn the polarity of this channel round, or check the columns of the file");
  else if (friction_N > 2 * (std::max(high, moved.steady_normal_force_N.value_or(0)) + 0.1))
    out.add(severity::warning, "friction-above-normal-force", moved.normal_channel, 0, end_s,
            "the string is dragged with " + figure(friction_N) + " N under a normal force of " + figure(high) + " N",
            "check the scales, and the columns of the file against [channels]");
  if (moved.normal_offset_N && std::abs(moved.normal_offset_N->value) > 3 * moved.normal_offset_N->sd)
    out.add(severity::note, "offset", moved.normal_channel, 0, end_s,
            "reads " + figure(moved.normal_offset_N->value) + " N while the bow is off the string",
            "that is taken off the normal force");
}

/// A pitch that no string makes of the declared one, and another usual sampling rate would.
template <class = void>
void check_stroke_rate(take_check& out, const rig& r, const take_signals& from) {
  const auto* near = from.find("near");
  const auto* s = near != nullptr ? near : from.signals.empty() ? nullptr : &from.signals.front();
  if (s == nullptr || s->sensor.quantity == quantity::bow_speed || s->sensor.quantity == quantity::normal_force) return;
  const double declared = r.string.fundamental_Hz;
  const auto found = find_ringing(middle_of(s->values), from.sample_rate_Hz, declared, 0);
  if (!found || found->score < 0.6 || found->at_declared > 0.5 * found->score) return;
  const double ratio = found->pitch_Hz / declared, as_if_Hz = from.sample_rate_Hz / ratio,
               limit = 0.03 + 2 * r.string.fundamental_tolerance.value_or(0.003);
  for (const double own : {0.25, 1.0 / 3, 0.5, 1.0, 2.0, 3.0, 4.0})  // it slips several times a period, or once in several
    if (std::abs(ratio / own - 1) < limit) return;
  const bool rate_is_wrong = is_usual_rate(as_if_Hz);
  out.add(rate_is_wrong ? severity::error : severity::warning, "wrong-pitch", s->sensor.name, 0, out.duration_s,
          "sounds at " + figure(found->pitch_Hz, "%.2f") + " Hz, fundamental_Hz is " + figure(declared, "%.2f") +
              (rate_is_wrong ? ": as if recorded at " + figure(as_if_Hz, "%.0f") + " samples a second" : std::string{}),
          "check the sample rate (rate_Hz of a table) and fundamental_Hz");
}

/// The mean forces on the two ends share the friction's, so they have one sign, that of the bow's motion.
template <class = void>
void check_bow(take_check& out, const rig& r, const take& declared, const take_signals& from) {
  stroke_motion moved = motion_of(declared, from);
  const take t = with_measured(declared, moved);
  const auto mean = [&](const char* name) {
    const auto at = std::find_if(out.channels.begin(), out.channels.end(), [&](const auto& c) { return c.channel == name; });
    const bool dc = r.channel(name) != nullptr && !r.channel(name)->ac_coupled_Hz && at != out.channels.end();
    return dc && std::abs(at->mean) > 0.05 * at->rms ? at->mean : 0.0;
  };
  const double near = mean("near"), far = mean("far");
  const double least = 0.03 * t.normal_force_N.value_or(0);
  const bool counts = std::min(std::abs(near), std::abs(far)) > least && near != 0 && far != 0;
  if (counts && near < 0 && far < 0)
    out.add(severity::warning, "bowed-backwards", "", 0, out.duration_s,
            "both mean forces are negative: the bow moves the other way",
            "forces are positive the way the bow moves: turn both polarities round, or slips, loops and heat will be wrong");
  else if (counts && near * far < 0)
    out.add(severity::error, "inverted-channel", near < 0 ? "near" : "far", 0, out.duration_s,
            "the mean forces on the two ends have opposite signs", "turn the polarity of one channel round");
  check_bow_columns(out, from, r.string.fundamental_Hz);
  if (counts && !out.found("swapped-channels")) check_end_columns(out, r, t, near, far);
  check_motion(out, from, moved, std::abs(near + far));
  check_stroke_rate(out, r, from);
  moved.speed_m_s.clear(), moved.normal_force_N.clear();
  out.motion = std::move(moved);
}

}  // namespace rosin::detail

#include <rosin/core/macros_back.ipp>
