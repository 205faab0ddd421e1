// tier: hosted
// SPDX-License-Identifier: MIT
//
// A recording in memory, and one take of a rig in the units of its sensors.
//
// A sample of a recording is a fraction of full scale: 16-bit PCM -32768 ... 32767 becomes -1 ... 1 - 2^-15. Floating
// point files are taken as they are, and so are tables of numbers (.csv, .npy, ...), whose columns are the channels. The channel
// map of the rig turns it into newtons (metres per second, ...).
//
#pragma once

#include <rosin/acquire/rig.hpp>
#include <rosin/core/outcome.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The ending of a file's name that makes it a table, in small letters; empty: it is a sound file.
[[nodiscard]] inline std::string_view table_ending(std::string_view file) noexcept {
  constexpr std::array<std::string_view, 6> endings{".csv", ".tsv", ".npy", ".mat", ".h5", ".hdf5"};
  for (const auto& ending : endings) {
    if (file.size() <= ending.size()) continue;
    const auto alike = [](char a, char b) { return a == b || (a >= 'A' && a <= 'Z' && a - 'A' + 'a' == b); };
    const auto tail = file.substr(file.size() - ending.size());
    if (std::equal(tail.begin(), tail.end(), ending.begin(), alike)) return ending;
  }
  return {};
}

struct recording {
  std::string file;  ///< for messages
  double sample_rate_Hz = 0;
  std::vector<std::vector<double>> channels{};  ///< all of one length
  int bits = 16;                                ///< of a sample in the file
  bool float_format = false;
  std::vector<std::string> columns{};  ///< names of a table's columns, where it has them
  bool is_table = false;               ///< nothing is its full scale

  [[nodiscard]] std::size_t frames() const noexcept { return channels.empty() ? 0 : channels.front().size(); }
  [[nodiscard]] double duration_s() const noexcept { return static_cast<double>(frames()) / sample_rate_Hz; }
  /// One step of the converter, in units of full scale; 0 for floating point.
  [[nodiscard]] double step() const noexcept { return float_format ? 0.0 : std::ldexp(1.0, 1 - bits); }
};

/// One channel of a take.
struct take_signal {
  sensor_channel sensor;
  std::vector<double> values;  ///< in the SI unit of the quantity; in full scales where the sensor is not calibrated
  double full_scale = 1;       ///< in the same unit; of a table, which has none, the largest magnitude
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

/// Where a channel stands among the columns, or why it does not; `place` stands before the key.
[[nodiscard]] inline outcome<std::size_t> column_of(const sensor_channel& sensor, std::size_t width,
                                                    const std::vector<std::string>& names, const std::string& place = {}) {
  const std::string key = place + "channels." + sensor.name + (sensor.column.empty() ? ".index" : ".column");
  if (sensor.column.empty()) {
    if (static_cast<std::size_t>(sensor.index) < width) return static_cast<std::size_t>(sensor.index);
    return failure{"has " + std::to_string(width) + " channel(s), but " + key + " is " + std::to_string(sensor.index)};
  }
  const auto at = std::find(names.begin(), names.end(), sensor.column);
  if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
  std::string known;
  for (const auto& name : names)
    if (!name.empty() && known.size() < 200) known += (known.empty() ? "" : ", ") + name;
  return failure{"has " + (known.empty() ? "no named columns" : "the columns " + known) + ", but " + key + " is \"" +
                 sensor.column + "\""};
}

/// One channel out of a recording, in the sensor's unit. Precondition: the recording has the column.
[[nodiscard]] inline take_signal signal_of(const recording& from, const sensor_channel& sensor, std::size_t column) {
  const double scale = sensor.per_full_scale.value_or(1);
  take_signal out{sensor, from.channels.at(column), scale};
  for (double& x : out.values) x *= scale;
  if (!from.is_table || out.values.empty()) return out;
  const auto [low, high] = std::minmax_element(out.values.begin(), out.values.end());
  const double largest = std::max(std::abs(*low), std::abs(*high));
  out.full_scale = largest > 0 ? largest : 1;
  return out;
}

/// A take's channels by the rig's channel map; fails where the recording has too few of them.
[[nodiscard]] inline outcome<take_signals> signals_of(const rig& r, const take& t, const recording& from) {
  take_signals out{t.name, from.file, from.sample_rate_Hz, from.bits, from.float_format, {}};
  for (const auto& sensor : r.channels) {
    const auto column = column_of(sensor, from.channels.size(), from.columns, r.file + ":" + std::to_string(sensor.line) + ": ");
    if (!column) return failure{from.file + ": " + column.error()};
    if (sensor.quantity != quantity::unused) out.signals.push_back(signal_of(from, sensor, *column));
  }
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
