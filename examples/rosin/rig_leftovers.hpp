// SPDX-License-Identifier: MIT
//
// What is in a rig folder besides what rig.toml names: takes that are being recorded, and what is left where a recording was
// killed. While a take is recorded, a note stands beside it, locked, that says what rig.toml is going to say:
//
//     NAME.recording.toml   from when the name is given out until the take is whole and in rig.toml
//
// So whoever comes later, knows: a note that is locked is left alone, with its recording; one that nobody holds was left by a kill,
// and tells how the take gets into rig.toml.
//
#pragma once

#include "command_line.hpp"

#include <rosin/core/outcome.hpp>
#include <rosin/hardware/file_lock.hpp>

namespace tool {

/// Path of the note on a take.
[[nodiscard]] std::string note_path(const std::string& folder, const std::string& take);
/// What a note says: for a new folder the description of the rig comes before the take.
[[nodiscard]] std::string note_text(const std::string& take, const std::string& described, const std::string& block);

/// The folder's lock, under which rig.toml and notes are changed.
[[nodiscard]] rosin::outcome<rosin::file_lock> lock_folder(const std::string& folder);

/// Puts a take into rig.toml, if its recording is not there yet, with remarks below it. Where there is no rig.toml, `described`
/// stands before it. Waits a little where somebody is just writing the file. Needs the folder's lock.
[[nodiscard]] std::optional<rosin::failure> join_rig_file(const std::string& folder, const std::string& recording,
                                                          const std::string& described, const std::string& block,
                                                          const std::vector<std::string>& remarks,
                                                          std::chrono::milliseconds patience = std::chrono::seconds{2});

/// For people, one thing a line: what is being recorded, what a kill has left. `named`: the recordings that rig.toml names, if
/// it can be read. Nothing is changed.
[[nodiscard]] std::vector<std::string> leftovers_in(const std::string& folder,
                                                    const std::optional<std::vector<std::string>>& named);
/// Puts in order what a kill has left; what was done. Needs the folder's lock.
[[nodiscard]] std::vector<std::string> repair_folder(const std::string& folder);

/// Why nobody else may write into the folder: something is being recorded there.
[[nodiscard]] std::optional<rosin::failure> recording_in(const std::string& folder);
/// Why a file may not be written, even if it may be overwritten: somebody is writing it.
[[nodiscard]] std::optional<rosin::failure> being_written(const std::string& path);

}  // namespace tool
