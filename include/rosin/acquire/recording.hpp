// tier: hosted
// SPDX-License-Identifier: MIT
//
// A recording in memory, and one take of a rig in the units of its sensors.
//
// A sample of a recording is a fraction of full scale: 16-bit PCM -32768 ... 32767 becomes -1 ... 1 - 2^-15. Floating
// point files are taken as they are. The channel map of the rig turns it into newtons (metres per second, ...).
//
#pragma once

#include <rosin/acquire/rig.hpp>
#include <rosin/core/outcome.hpp>

#include <cmath>
#include <cstddef>

namespace rosin {

struct recording {
  std::string file;  ///< for messages
  double sample_rate_Hz = 0;
  std::vector<std::vector<double>> channels;  ///< all of one length
  int bits = 16;                              ///< of a sample in the file
  bool float_format = false;

  [[nodiscard]] std::size_t frames() const noexcept { return channels.empty() ? 0 : channels.front().size(); }
  [[nodiscard]] double duration_s() const noexcept { return static_cast<double>(frames()) / sample_rate_Hz; }
  /// One step of the converter, in units of full scale; 0 for floating point.
  [[nodiscard]] double step() const noexcept { return float_format ? 0.0 : std::ldexp(1.0, 1 - bits); }
};

/// One channel of a take.
struct take_signal {
  sensor_channel sensor;
  std::vector<double> values;  ///< in the SI unit of the quantity; in full scales where the sensor is not calibrated
  double full_scale = 1;       ///< in the same unit
};

/// A take as its sensors saw it.
struct take_signals {
  std::string name, file;
  double sample_rate_Hz = 0;
  int bits = 16;
  bool float_format = false;
  std::vector<take_signal> signals;  ///< in the order of the rig's channels; unused ones are left out

  [[nodiscard]] const take_signal* find(const std::string& channel) const noexcept {
    for (const auto& s : signals)
      if (s.sensor.name == channel) return &s;
    return nullptr;
  }
  /// Of the forces on the two terminations; precondition: the rig has_both_forces().
  [[nodiscard]] const std::vector<double>& near_N() const noexcept { return find("near")->values; }
  [[nodiscard]] const std::vector<double>& far_N() const noexcept { return find("far")->values; }
  [[nodiscard]] std::size_t frames() const noexcept { return signals.empty() ? 0 : signals.front().values.size(); }
  [[nodiscard]] double time_s(std::size_t frame) const noexcept { return static_cast<double>(frame) / sample_rate_Hz; }
};

/// One channel out of a recording, in the sensor's unit. Precondition: the recording has the channel.
[[nodiscard]] inline take_signal signal_of(const recording& from, const sensor_channel& sensor) {
  take_signal out{sensor, from.channels.at(static_cast<std::size_t>(sensor.index)), sensor.per_full_scale.value_or(1)};
  for (double& x : out.values) x *= out.full_scale;
  return out;
}

/// A take's channels by the rig's channel map; fails where the recording has too few of them.
[[nodiscard]] inline outcome<take_signals> signals_of(const rig& r, const take& t, const recording& from) {
  take_signals out{t.name, from.file, from.sample_rate_Hz, from.bits, from.float_format, {}};
  for (const auto& sensor : r.channels) {
    if (static_cast<std::size_t>(sensor.index) >= from.channels.size())
      return failure{from.file + ": has " + std::to_string(from.channels.size()) + " channel(s), but " + r.file + ":" +
                     std::to_string(sensor.line) + ": channels." + sensor.name + ".index is " + std::to_string(sensor.index)};
    if (sensor.quantity != quantity::unused) out.signals.push_back(signal_of(from, sensor));
  }
  return out;
}

}  // namespace rosin
