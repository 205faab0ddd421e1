// SPDX-License-Identifier: MIT
//
// A folder of recordings as somebody left it: which files belong together, what stands in them, and what can be said of each without
// knowing the string. Recognised are sound files, tables of numbers, and the layout in which calibrated strokes of a bowing machine were
// made public: whole_N.csv with the columns normal force, bow speed, force at the bridge, force at the nut, beside it beta_N.csv and
// timestamp_N.csv. What such a stroke's speed was, its channel tells, and never the name of a folder.
//
#pragma once

#include <rosin/acquire/checks.hpp>
#include <rosin/adapt/table_recording.hpp>

namespace tool {

struct init_request {
  std::string folder, out;         ///< out: where rig.toml goes; empty: into the folder
  std::vector<std::string> takes;  ///< patterns of names; empty: all
  std::optional<std::pair<double, double>> beta;
  std::size_t every = 1;
  bool binary = false, force = false, json = false;
  int threads = 0;

  [[nodiscard]] const std::string& rig_folder() const noexcept { return out.empty() ? folder : out; }
};

struct column_figures {
  std::string name;
  double lowest = 0, highest = 0, mean = 0;
};

/// One recording, and what was found out about it.
struct found_take {
  std::string path, name, file;                             ///< as it is reached from here; of the take; from the rig's folder
  std::string kind;                                         ///< by the file's name; empty: unknown
  bool machine_layout = false;                              ///< whole_N.csv
  std::optional<double> beta;                               ///< beta_N.csv
  std::optional<std::pair<double, double>> steady_samples;  ///< timestamp_N.csv
  double rate_Hz = 0;                                       ///< 0: the file does not tell
  std::size_t frames = 0;
  bool is_table = false;
  std::vector<column_figures> columns;
  rosin::stroke_motion motion;  ///< of a stroke whose channels are known
  std::vector<std::string> remarks;
  std::string problem;  ///< why it is left out
};

/// What the columns of the public layout are, and its rate, which the files do not tell.
inline constexpr std::array machine_columns{"normal_force_N", "bow_speed_m_s", "near_N", "far_N"};
inline constexpr double machine_rate_Hz = 50000;

/// All recordings that are asked for, in natural order; nothing in them is read but the small files beside strokes.
[[nodiscard]] rosin::outcome<std::vector<found_take>> find_recordings(const init_request& given, std::vector<std::string>& notes);

/// Reads one recording and says what is in it, or its `problem`; writes its binary form if asked.
void examine(found_take& one, const init_request& given);

/// The rig file.
[[nodiscard]] std::string rig_text(const std::vector<found_take>& takes, const init_request& given, const std::string& from);

}  // namespace tool
