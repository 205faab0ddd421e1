// SPDX-License-Identifier: MIT
//
// What the rig file is going to say about a take, and the rig file that says it. A take joins the file when its first samples
// are on the disk; the file is replaced whole, so at any time it is one that can be read.
//
#pragma once

#include "command_line.hpp"

#include <rosin/acquire/rig.hpp>
#include <rosin/core/outcome.hpp>

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
  /// The rig.toml of `folder`; where there is none, all but the takes of the rig file `like`. The folder is made.
  [[nodiscard]] static rosin::outcome<rig_file_writer> open(const std::string& folder, const std::string& like);

  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }
  [[nodiscard]] std::string path() const { return folder_ + "/rig.toml"; }
  /// "pluck-3", the first that is free.
  [[nodiscard]] std::string free_name(const std::string& kind) const;

  /// The rig with this take; fails, before anything is recorded, where the rig file would be none.
  [[nodiscard]] rosin::outcome<rosin::rig> with(const take_plan& take) const;

  /// Puts the take into the file; remarks become comments below it. May be called again for the take that was added last.
  [[nodiscard]] std::optional<rosin::failure> put(const take_plan& take, const std::vector<std::string>& remarks = {});
  /// The take is done: what is put next comes after it.
  void keep() { text_ = std::move(latest_), latest_ = text_; }

private:
  std::string folder_, text_, latest_;
};

}  // namespace tool
