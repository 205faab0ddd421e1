// tier: hosted
// SPDX-License-Identifier: MIT
//
// A rig with its recordings: every file is opened and held against the channel map before anything is calculated, so that
// all that is wrong with a folder is said at once. Needs toml++ 3 and libsndfile.
//
#pragma once

#include <rosin/adapt/audio_sndfile.hpp>
#include <rosin/adapt/rig_toml.hpp>

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
    if (c.index >= format.channels)
      log.add(t.line, place,
              file + ": has " + std::to_string(format.channels) + " channel(s), but channels." + c.name + ".index is " +
                  std::to_string(c.index));
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
    if (std::none_of(channels.begin(), channels.end(), [i](const auto& c) { return c.index == i; }))
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

}  // namespace detail

/// The rig and the headers of its recordings, or everything that is wrong with them.
[[nodiscard]] inline outcome<rig_folder> open_rig_folder(const std::string& path) {
  auto loaded = load_rig(path);
  if (!loaded) return failure{loaded.error()};
  rig_folder out{*std::move(loaded), {}, {}, {}};
  out.doubts = check_magnitudes(out.rig);
  problem_log log{out.rig.file};
  for (const take& t : out.rig.takes) {
    const auto format = read_audio_format(out.rig.path_of(t.file));
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

/// A take read and in the units of its sensors.
[[nodiscard]] inline outcome<take_signals> load_take(const rig& r, const take& t) {
  const auto audio = read_audio(r.path_of(t.file));
  if (!audio) return failure{r.file + ":" + std::to_string(t.line) + ": take \"" + t.name + "\".file: " + audio.error()};
  return signals_of(r, t, *audio);
}

}  // namespace rosin
