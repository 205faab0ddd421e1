// SPDX-License-Identifier: MIT
//
// What the rig file is going to say about a take, and the rig file that says it. A take has its name, and a note that keeps it
// (rig_leftovers.hpp), before anything is recorded; it joins the file when its first samples are on the disk. The file is read
// again each time, changed under the folder's lock and replaced whole: others may change it meanwhile, and all that is in it stays.
//
#pragma once

#include "command_line.hpp"

#include <rosin/acquire/rig.hpp>
#include <rosin/core/outcome.hpp>

#include <memory>

namespace tool {

struct take_plan {
  std::string name, kind = "bow";
  std::optional<double> force_N, force_tolerance, position, speed_m_s, normal_force_N;
  bool hold_out = false;

  [[nodiscard]] std::string file() const { return name + ".wav"; }
};
void add_take_options(CLI::App& command, take_plan& given);

class rig_file_writer {
public:
  /// The rig.toml of `folder`; where there is none, all but the takes of the rig file `like`. What a kill has left in the folder is
  /// put in order; else nothing is changed.
  [[nodiscard]] static rosin::outcome<rig_file_writer> open(const std::string& folder, const std::string& like);

  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }
  [[nodiscard]] std::string path() const { return folder_ + "/rig.toml"; }
  /// What was put in order, since the beginning; a line each.
  [[nodiscard]] const std::vector<std::string>& repaired() const noexcept { return repaired_; }

  /// The rig with this take, which gets a name that is free if it has none; fails, before anything is recorded, where the rig file
  /// would be none, or where the name is taken.
  [[nodiscard]] rosin::outcome<rosin::rig> plan(take_plan& take);
  /// The same, and the name is this take's from now on, until it is done or given up.
  [[nodiscard]] rosin::outcome<rosin::rig> reserve(take_plan& take);

  /// Puts the take that was reserved into the file.
  [[nodiscard]] std::optional<rosin::failure> put();
  /// The take is whole: it is in the file, with remarks as comments below it, and the note goes. `sound` false: the recording has
  /// not got its final head, and the note stays.
  [[nodiscard]] std::optional<rosin::failure> finish(const std::vector<std::string>& remarks, bool sound);
  /// Nothing was recorded.
  void give_up() noexcept { reserved_.reset(); }

private:
  /// A take's note, and its lock; gone with it, unless the take was begun.
  class reservation;
  struct reservation_end {
    void operator()(reservation* r) const noexcept;
  };

  [[nodiscard]] std::optional<rosin::failure> read_again();
  [[nodiscard]] std::string free_name(const std::string& kind) const;
  [[nodiscard]] std::string why_taken(const take_plan& take) const;

  std::string folder_, text_, described_;  ///< described: of a folder that has no rig file yet
  std::vector<std::string> repaired_;
  std::unique_ptr<reservation, reservation_end> reserved_;
};

}  // namespace tool
