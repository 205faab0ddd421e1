// tier: hosted
// SPDX-License-Identifier: MIT
//
// Everything that can be wrong with a take before anything is fitted to it, each with channel, time and what to do about
// it. Figures that were measured on the way (levels, noise, release, pitch, decay) come with it.
//
#pragma once

#include <rosin/acquire/pluck_checks.hpp>
#include <rosin/acquire/stroke_checks.hpp>
#include <rosin/core/instantiate.hpp>

#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// The pitch of the ringing against the declared one, and how long it lasts. A pitch that is off is an error where it looks like
/// a wrong sampling rate or like another string; a bead can lower it by a tenth. True if it may be the declared string's.
template <class = void>
[[nodiscard]] bool check_ringing(take_check& out, const pluck_view& view, const take_signal& s, std::size_t start) {
  const double rate = view.signals->sample_rate_Hz;
  const std::span<const double> tail{s.values.data() + start, s.values.size() - start};
  const auto grade = view.from->has_both_forces() ? severity::error : severity::warning;
  const double t = view.signals->time_s(start);
  const auto found = find_ringing(tail, rate, view.fundamental_Hz, view.inharmonicity);
  const auto quality = find_quality(tail, rate, view.fundamental_Hz);
  if (quality) out.quality = std::min(*quality, out.quality.value_or(*quality));
  if (quality && *quality < 25)
    out.add(grade, "does-not-ring", s.sensor.name, t, out.duration_s,
            "the ringing dies within a few periods (Q about " + figure(*quality, "%.0f") + ")",
            "free the string of what touches it");
  if (!found) return false;
  const double off = found->pitch_Hz / view.fundamental_Hz - 1,
               limit = 0.015 + 2 * view.from->string.fundamental_tolerance.value_or(0.003);
  bool other_string = false;
  if (found->score < 0.3)
    out.add(severity::warning, "not-periodic", s.sensor.name, t, out.duration_s,
            "the ringing is no harmonic series near the declared pitch", "check fundamental_Hz and what else sounds");
  else if (std::abs(off) > limit) {
    const double as_if_Hz = rate / (1 + off);
    const bool rate_is_wrong = is_usual_rate(as_if_Hz);
    other_string = std::abs(off) > 0.2 || (std::abs(off) > 0.03 && rate_is_wrong);
    out.add(other_string ? grade : severity::warning, "wrong-pitch", s.sensor.name, t, out.duration_s,
            "rings at " + figure(found->pitch_Hz, "%.2f") + " Hz, fundamental_Hz is " + figure(view.fundamental_Hz, "%.2f") +
                (rate_is_wrong ? ": as if recorded at " + figure(as_if_Hz, "%.0f") + " samples a second" : std::string{}),
            rate_is_wrong ? "check the sample rate in the file's header and fundamental_Hz"
                          : "check fundamental_Hz, and whether something sits on the string");
  }
  out.pitch_Hz = found->pitch_Hz;
  return found->score >= 0.3 && !other_string;
}

/// A string that rings at a power of ten of the declared pitch, and not at it: nothing else can be judged then. True if so.
template <class = void>
[[nodiscard]] bool check_pitch_unit(take_check& out, const pluck_view& view) {
  const double rate = view.signals->sample_rate_Hz;
  for (const auto& s : view.signals->signals) {
    if (s.sensor.quantity == quantity::normal_force || s.sensor.quantity == quantity::bow_speed || s.values.size() < 64) continue;
    std::size_t release = 1;
    for (std::size_t i = 1; i + 32 < s.values.size(); ++i)
      if (std::abs(s.values[i] - s.values[i - 1]) > std::abs(s.values[release] - s.values[release - 1])) release = i;
    const std::span<const double> tail{s.values.data() + release, std::min<std::size_t>(s.values.size() - release, 1 << 17)};
    const auto declared = find_ringing(tail, rate, view.fundamental_Hz, view.inharmonicity);
    if (declared && declared->at_declared >= 0.3) return false;
    std::optional<ringing> best;
    for (const double factor : {1e-6, 1e-3, 1e-2, 1e-1, 1e1, 1e2, 1e3, 1e6}) {
      const double pitch_Hz = factor * view.fundamental_Hz;
      if (pitch_Hz < 5 || pitch_Hz > 0.2 * rate) continue;
      const auto found = find_ringing(tail, rate, pitch_Hz, std::min(view.inharmonicity, 1e-3));
      if (found && found->score > (best ? best->score : 0.6) && std::abs(found->pitch_Hz / pitch_Hz - 1) < 0.05) best = found;
    }
    if (!best) continue;
    out.pitch_Hz = best->pitch_Hz;
    out.add(severity::error, "power-of-ten", s.sensor.name, view.signals->time_s(release), out.duration_s,
            "rings at " + figure(best->pitch_Hz, "%.4g") + " Hz, fundamental_Hz is " + figure(view.fundamental_Hz, "%.4g"),
            "check the unit and the digits of fundamental_Hz; nothing else of this take was judged");
    return true;
  }
  return false;
}

/// What is recorded of the ringing, from `start` on. True if there is anything to look at.
[[nodiscard]] inline bool check_length(take_check& out, const pluck_view& view, const take_signal& s, std::size_t start) {
  constexpr double least_periods = 10;
  const double recorded_s =
      static_cast<double>(s.values.size() - std::min(start, s.values.size())) / view.signals->sample_rate_Hz;
  if (recorded_s * view.fundamental_Hz < least_periods)
    out.add(severity::warning, "short-ringing", s.sensor.name, view.signals->time_s(start), out.duration_s,
            "only " + figure(recorded_s, "%.4f") + " s of the ringing are recorded, " +
                figure(recorded_s * view.fundamental_Hz, "%.1f") + " periods: that says next to nothing",
            "record for longer after the release");
  return start + 16 < s.values.size();
}

inline void check_tail_hum(take_check& out, const pluck_view& view, const take_signal& s, std::size_t start) {
  for (auto& c : out.channels)
    if (c.channel == s.sensor.name)
      report_hum(out, c, *view.signals, start,
                 find_hum({s.values.data() + start, s.values.size() - start}, view.signals->sample_rate_Hz, view.fundamental_Hz));
}

/// A string that rings as declared at one end, at this pitch, is no other string, whatever rings loudest at the other: a heavy
/// bead may leave an octave there.
inline void doubt_other_pitch(take_check& out, double pitch_Hz) {
  out.pitch_Hz = pitch_Hz;
  for (finding& f : out.findings)
    if (f.kind == "wrong-pitch") f.level = severity::warning;
}

/// With force transducers at both ends.
template <class = void>
void check_force_pluck(take_check& out, const pluck_view& view) {
  pluck_steps steps;
  if (!check_steps(out, view, steps)) return;
  const bool whole = check_lead(out, view, steps);
  const bool levels = whole && check_coupling(out, view, steps);
  if (whole) {
    out.release_s = release_time(view, steps);
    check_step(out, view, "near", steps.near);
    check_step(out, view, "far", steps.far);
    if (!out.found("inverted-channel")) check_order(out, view, steps, levels);
  }
  std::optional<double> as_declared_Hz;
  for (const auto& [name, step] : {std::pair{"near", &steps.near}, std::pair{"far", &steps.far}}) {
    const auto& s = *view.signals->find(name);
    const auto start = step->frame + static_cast<std::size_t>(view.signals->sample_rate_Hz / view.fundamental_Hz);
    if (levels) check_tail(out, view, s, *step);
    if (!check_length(out, view, s, start)) continue;
    if (check_ringing(out, view, s, start)) as_declared_Hz = out.pitch_Hz;
    check_tail_hum(out, view, s, start);
    const std::size_t at_rest = step->frame - std::min(step->frame, start - step->frame);
    if (whole && at_rest > 32)
      for (auto& c : out.channels)
        if (c.channel == name) c.noise_rms = noise_in(s.values, at_rest);
  }
  if (as_declared_Hz) doubt_other_pitch(out, *as_declared_Hz);
}

/// With any other sensor.
template <class = void>
void check_other_pluck(take_check& out, const pluck_view& view) {
  for (const auto& s : view.signals->signals) {
    if (s.sensor.quantity == quantity::normal_force || s.sensor.quantity == quantity::bow_speed) continue;
    const auto onset = first_onset(s.values, view.signals->sample_rate_Hz, view.fundamental_Hz);
    if (!onset) continue;
    out.release_s = view.signals->time_s(*onset);
    const auto start = *onset + static_cast<std::size_t>(4 * view.signals->sample_rate_Hz / view.fundamental_Hz);
    if (!check_length(out, view, s, start)) continue;
    (void)check_ringing(out, view, s, start);
    check_tail_hum(out, view, s, start);
  }
}

inline void check_quiet(take_check& out, const take_signals& signals, double fundamental_Hz) {
  for (const auto& s : signals.signals)
    for (auto& c : out.channels) {
      if (c.channel != s.sensor.name) continue;
      c.noise_rms = c.rms;
      report_hum(out, c, signals, 0, find_hum(s.values, signals.sample_rate_Hz, 1e6 * fundamental_Hz));
    }
}

}  // namespace detail

/// All checks of one take.
template <class = void>
[[nodiscard]] take_check check_take(const rig& r, const take& t, const take_signals& signals) {
  take_check out{t.name, signals.file, signals.sample_rate_Hz, signals.time_s(signals.frames()), {}, {}, {}, {}, {}, {}};
  bool sound = true;
  for (const auto& s : signals.signals) sound = detail::check_signal(out, signals, s, t.kind == take_kind::quiet) && sound;
  if (!sound || out.found("silence")) return out;
  const rig_values values = values_of(r);
  double inharmonicity = 0;
  if (values.bending_stiffness_Nm2 && values.tension_N && values.length_m)
    inharmonicity =
        9.8696 * values.bending_stiffness_Nm2->value / (values.tension_N->value * std::pow(values.length_m->value, 2));
  const detail::pluck_view view{&r, &t, &signals, r.string.fundamental_Hz, inharmonicity};
  if (t.kind == take_kind::quiet) detail::check_quiet(out, signals, r.string.fundamental_Hz);
  else if (t.kind == take_kind::bow) detail::check_bow(out, r, t, signals);
  else if (detail::check_pitch_unit(out, view)) return out;
  else if (r.has_both_forces()) detail::check_force_pluck(out, view);
  else detail::check_other_pluck(out, view);
  return out;
}
ROSIN_INSTANTIATE(take_check check_take(const rig&, const take&, const take_signals&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
