// tier: hosted
// SPDX-License-Identifier: MIT
//
// What can be said of a channel without knowing what the string does: samples that are no samples, levels, rails, losses,
// offset, noise and hum.
//
#pragma once

#include <rosin/acquire/finding.hpp>
#include <rosin/acquire/hum.hpp>
#include <rosin/acquire/recording.hpp>
#include <rosin/acquire/sample_runs.hpp>
#include <rosin/acquire/stroke_motion.hpp>
#include <rosin/core/number_text.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Figures of one channel, in the sensor's unit.
struct channel_check {
  std::string channel, unit;
  double lowest = 0, highest = 0, mean = 0, rms = 0;
  double of_full_scale = 0;         ///< largest magnitude / full scale
  std::optional<double> noise_rms;  ///< where something quiet was recorded
  std::optional<hum_estimate> hum;
};

/// Findings of one take, in the order in which they were made.
struct take_check {
  std::string take, file;
  double sample_rate_Hz = 0, duration_s = 0;
  std::vector<channel_check> channels;
  std::vector<finding> findings;
  std::optional<double> release_s;  ///< pluck: when the wire broke
  std::optional<double> pitch_Hz, quality;
  std::optional<stroke_motion> motion;  ///< of a stroke; what is sample by sample in it is left out

  void add(severity level, const std::string& kind, const std::string& channel, double start_s, double end_s,
           const std::string& what, const std::string& advice) {
    findings.push_back({level, kind, take, channel, start_s, end_s, what, advice});
  }
  [[nodiscard]] bool found(const std::string& kind) const noexcept {
    return std::any_of(findings.begin(), findings.end(), [&](const auto& f) { return f.kind == kind; });
  }
};

/// "N", "m/s", "m", "Pa"; "of full scale" where the sensor is not calibrated.
[[nodiscard]] inline std::string unit_of(const sensor_channel& sensor) {
  if (!sensor.per_full_scale) return "of full scale";
  switch (sensor.quantity) {
    case quantity::string_velocity:
    case quantity::bow_speed:
      return "m/s";
    case quantity::string_displacement:
      return "m";
    case quantity::sound:
      return "Pa";
    default:
      return "N";
  }
}

namespace detail {

/// A number as a person writes it.
[[nodiscard]] inline std::string figure(double x, const char* form = "%.3g") { return number_text(x, form); }

[[nodiscard]] inline std::size_t samples_in(const std::vector<sample_span>& spans) noexcept {
  std::size_t samples = 0;
  for (const auto& s : spans) samples += s.count;
  return samples;
}

/// One finding for all spans of a kind, from the first to the last of them.
inline void report_spans(take_check& out, const take_signals& from, const std::string& channel,
                         const std::vector<sample_span>& spans, const std::string& kind, const std::string& what,
                         const std::string& advice, severity level = severity::error) {
  if (spans.empty()) return;
  const std::size_t samples = samples_in(spans);
  out.add(level, kind, channel, from.time_s(spans.front().first), from.time_s(spans.back().end()),
          what + ": " + std::to_string(samples) + " samples in " + std::to_string(spans.size()) + " place(s), first at sample " +
              std::to_string(spans.front().first),
          advice);
  out.findings.back().samples = samples;
}

[[nodiscard]] inline channel_check figures_of(const take_signal& s) {
  channel_check c{s.sensor.name, unit_of(s.sensor), 0, 0, 0, 0, 0, {}, {}};
  const auto [low, high] = std::minmax_element(s.values.begin(), s.values.end());
  c.lowest = *low;
  c.highest = *high;
  for (const double v : s.values) c.mean += v / static_cast<double>(s.values.size());
  for (const double v : s.values) c.rms += (v - c.mean) * (v - c.mean) / static_cast<double>(s.values.size());
  c.rms = std::sqrt(c.rms);
  c.of_full_scale = std::max(std::abs(c.lowest), std::abs(c.highest)) / s.full_scale;
  return c;
}

inline void check_level(take_check& out, const channel_check& c, double step, bool quiet) {
  const double range = c.highest - c.lowest;
  if (range <= 2 * step || range <= 0) {
    out.add(quiet ? severity::warning : severity::error, "silence", c.channel, 0, out.duration_s,
            quiet ? "not even noise: the channel is dead or its gain far too low" : "silent: the channel does not move at all",
            "check the sensor, its supply and the cable, and record again");
  } else if (!quiet && range < 200 * step) {
    out.add(severity::warning, "low-level", c.channel, 0, out.duration_s,
            "uses only " + figure(range / step, "%.0f") + " steps of the converter", "raise the gain before the converter");
  }
}

/// Where the mean has to be zero: nothing moves, or the channel is AC coupled and has had time to settle.
inline void check_offset(take_check& out, const take_signal& s, const channel_check& c, bool quiet) {
  const auto& ac = s.sensor.ac_coupled_Hz;
  const bool settled = ac && out.duration_s > 3 / *ac;
  const bool no_direct = s.sensor.quantity == quantity::sound || s.sensor.quantity == quantity::string_velocity;
  if (!(quiet || settled || no_direct)) return;
  const double limit = quiet ? std::max(0.01 * s.full_scale, 10 * c.rms) : std::max(0.1 * c.rms, 1e-3 * s.full_scale);
  if (std::abs(c.mean) <= limit) return;
  out.add(severity::warning, "offset", c.channel, 0, out.duration_s,
          "a mean of " + figure(c.mean) + " " + c.unit + " where there should be none",
          "set the amplifier's zero, or take the mean of a quiet take off");
}

inline void report_hum(take_check& out, channel_check& c, const take_signals& from, std::size_t first,
                       std::optional<hum_estimate> hum) {
  if (!hum) return;
  double strongest = 0;
  for (const auto& line : hum->lines) strongest = std::max(strongest, line.amplitude);
  if (strongest > 0.002 * c.rms)
    out.add(severity::warning, "hum", c.channel, from.time_s(first), out.duration_s,
            "mains hum of " + figure(hum->frequency_Hz, "%.0f") + " Hz, " + figure(strongest) + " " + c.unit +
                " in its strongest line",
            "shield and earth the sensor; what is left, a quiet take helps to model");
  c.hum = std::move(hum);
}

/// All of the above for one channel; false if its samples are not even numbers.
[[nodiscard]] inline bool check_signal(take_check& out, const take_signals& from, const take_signal& s, bool quiet) {
  const auto bad = not_finite(s.values);
  report_spans(out, from, s.sensor.name, bad, "not-a-number", "samples that are not numbers", "export the recording again");
  if (!bad.empty() || s.values.empty()) return false;
  const double step = from.float_format ? 0.0 : s.full_scale * std::ldexp(1.0, 1 - from.bits);
  channel_check c = figures_of(s);
  check_level(out, c, step, quiet);
  if (c.highest - c.lowest > 2 * step) {
    const auto cut = clipped(s.values, step, s.full_scale);
    const bool bearable = s.sensor.quantity != quantity::termination_force && samples_in(cut) * 1000 < s.values.size();
    report_spans(out, from, s.sensor.name, cut, "clipping", "clipped at " + figure(c.of_full_scale, "%.3f") + " of full scale",
                 "lower the gain and record again", bearable ? severity::warning : severity::error);
    report_spans(out, from, s.sensor.name, dropouts(s.values, step, cut), "dropouts", "samples were lost (value held or zero)",
                 "check the recorder's buffers and the disk, and record again");
    check_offset(out, s, c, quiet);
  }
  out.channels.push_back(std::move(c));
  return true;
}

}  // namespace detail
}  // namespace rosin

#include <rosin/core/macros_back.ipp>
