// tier: hosted
// SPDX-License-Identifier: MIT
//
// A rig with its recordings: every file is opened and held against the channel map before anything is calculated, so that
// all that is wrong with a folder is said at once. Needs toml++ 3 and libsndfile.
//
#pragma once

#include <rosin/adapt/audio_sndfile.hpp>
#include <rosin/adapt/rig_toml.hpp>
#include <rosin/adapt/table_recording.hpp>

namespace rosin {

struct rig_folder {
  rosin::rig rig;
  std::vector<audio_format> formats;  ///< of each take
  std::vector<std::string> notes;     ///< what is odd but no reason to stop
  std::vector<finding> doubts;        ///< values of the rig file that contradict one another
};

namespace detail {

inline void check_format(const rig_folder& folder, const take& t, const audio_format& format, problem_log& log) {
  const std::string place = "take \"" + t.name + "\".file";
  const std::string file = folder.rig.path_of(t.file);
  for (const auto& c : folder.rig.channels)
    if (const auto column = column_of(c, static_cast<std::size_t>(format.channels), format.columns); !column)
      log.add(t.line, place, file + ": " + column.error());
  const int first = folder.formats.front().channels;
  if (first > 0 && first != format.channels)
    log.add(t.line, place,
            file + ": has " + std::to_string(format.channels) + " channel(s), the first take has " + std::to_string(first));
  if (folder.rig.string.fundamental_Hz * 2 >= format.sample_rate_Hz)
    log.add(t.line, place,
            file + ": a sample rate of " + value_range::number(format.sample_rate_Hz) + " Hz cannot hold the fundamental of " +
                value_range::number(folder.rig.string.fundamental_Hz) + " Hz");
}

inline void note_unnamed_channels(rig_folder& folder) {
  const auto& channels = folder.rig.channels;
  for (int i = 0; !folder.formats.empty() && i < folder.formats.front().channels; ++i)
    if (i != folder.rig.files.time_column && std::none_of(channels.begin(), channels.end(), [&](const auto& c) {
          const auto at = column_of(c, static_cast<std::size_t>(folder.formats.front().channels), folder.formats.front().columns);
          return at && *at == static_cast<std::size_t>(i);
        }))
      folder.notes.push_back("channel " + std::to_string(i) + " of the recordings is not named in [channels]: it is not used");
}

inline void note_shared_files(rig_folder& folder) {
  const auto& takes = folder.rig.takes;
  for (std::size_t i = 0; i < takes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (takes[i].file == takes[j].file)
        folder.notes.push_back("takes " + takes[j].name + " and " + takes[i].name + " are the same file " + takes[i].file);
}

inline void note_untold_lengths(rig_folder& folder) {
  for (std::size_t i = 0; i < folder.formats.size(); ++i)
    if (!folder.formats[i].length_told)
      folder.notes.push_back(folder.rig.path_of(folder.rig.takes[i].file) +
                             ": its header does not tell how long it is: what is there was read, " +
                             std::to_string(folder.formats[i].frames) + " frames");
}

/// What the beginning of a table tells.
[[nodiscard]] inline outcome<audio_format> read_table_format(const std::string& path, const table_clock& clock,
                                                             const table_formats& formats) {
  constexpr std::size_t enough_rows = 100;
  auto table = read_table(path, formats, enough_rows);
  if (!table) return failure{table.error()};
  const auto rate = rate_of(*table, path, clock);
  if (!rate) return failure{rate.error()};
  audio_format out{*rate, static_cast<int>(table->data.columns.size()), 64, true, 0, true, {}};
  for (auto& c : table->data.columns) out.columns.push_back(std::move(c.name));
  return out;
}

/// What the head of a take's file says, whatever it is.
[[nodiscard]] inline outcome<audio_format> read_format(const rig& r, const take& t, const table_formats& formats) {
  if (table_ending(t.file).empty()) return read_audio_format(r.path_of(t.file));
  return read_table_format(r.path_of(t.file), clock_of(r, t), formats);
}

}  // namespace detail

/// The rig and the headers of its recordings, or everything that is wrong with them.
[[nodiscard]] inline outcome<rig_folder> open_rig_folder(const std::string& path,
                                                         const table_formats& formats = plain_table_formats()) {
  auto loaded = load_rig(path);
  if (!loaded) return failure{loaded.error()};
  rig_folder out{*std::move(loaded), {}, {}, {}};
  out.doubts = check_magnitudes(out.rig);
  problem_log log{out.rig.file};
  for (const take& t : out.rig.takes) {
    const auto format = detail::read_format(out.rig, t, formats);
    if (!format) log.add(t.line, "take \"" + t.name + "\".file", format.error());
    out.formats.push_back(format ? *format : audio_format{});
    if (format) detail::check_format(out, t, *format, log);
  }
  if (!log.empty()) {
    for (const finding& f : out.doubts) log.add(0, "", f.what);
    return log.to_failure();
  }
  detail::note_unnamed_channels(out);
  detail::note_shared_files(out);
  detail::note_untold_lengths(out);
  return out;
}

/// A take's file, whatever it is.
[[nodiscard]] inline outcome<recording> load_recording(const rig& r, const take& t,
                                                       const table_formats& formats = plain_table_formats()) {
  const std::string path = r.path_of(t.file);
  auto read = table_ending(t.file).empty() ? read_audio(path) : read_table_recording(path, clock_of(r, t), formats);
  if (read) return read;
  return failure{r.file + ":" + std::to_string(t.line) + ": take \"" + t.name + "\".file: " + read.error()};
}

/// A take read and in the units of its sensors.
[[nodiscard]] inline outcome<take_signals> load_take(const rig& r, const take& t,
                                                     const table_formats& formats = plain_table_formats()) {
  const auto read = load_recording(r, t, formats);
  if (!read) return failure{read.error()};
  return signals_of(r, t, *read);
}

}  // namespace rosin
