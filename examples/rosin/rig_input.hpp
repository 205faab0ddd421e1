// SPDX-License-Identifier: MIT
//
// A rig and its takes for a subcommand: read, checked, and with everything that was assumed on the way.
//
#pragma once

#include "provenance.hpp"

#include <rosin/acquire/checks.hpp>
#include <rosin/acquire/rig_values.hpp>
#include <rosin/adapt/rig_folder.hpp>
#include <rosin/propagate/string_parameters.hpp>

namespace tool {

/// The tables that this build of the tool reads.
[[nodiscard]] const rosin::table_formats& table_formats();
#ifdef ROSIN_TOOL_HDF5
void add_hdf5_tables(rosin::table_formats& to);
#endif

/// The rig with the headers of all its recordings checked; the rig file itself joins the inputs.
[[nodiscard]] rosin::outcome<rosin::rig_folder> open_rig(const std::string& path, provenance& from);

/// What contradicts itself in the rig file, a sentence each.
[[nodiscard]] std::vector<std::string> doubts_of(const rosin::rig_folder& folder);

struct checked_take {
  rosin::take_signals signals;
  rosin::take_check check;
};

/// A take read and checked; the recording joins the inputs. What the checks found is in the result, errors as well.
[[nodiscard]] rosin::outcome<checked_take> read_take(const rosin::rig& rig, const rosin::take& take, provenance& from);

/// The same, and whatever is more than a note joins the warnings; nothing where the take cannot be read at all.
[[nodiscard]] std::optional<checked_take> read_telling(const rosin::rig& rig, const rosin::take& take, provenance& from,
                                                       std::vector<std::string>& warnings);

/// Why nothing can be done, and what was noticed on the way, which mostly tells the reason.
[[nodiscard]] rosin::failure failed(const std::string& why, const std::vector<std::string>& noticed);

/// As read_take, but a take with an error is refused: nothing sound can be calculated from it.
[[nodiscard]] rosin::outcome<checked_take> read_sound_take(const rosin::rig& rig, const rosin::take& take, provenance& from);

/// "pluck-1.wav: take pluck-1 (rig.toml:34), channel near, 0.0041 s: clipped ...; lower the gain ..."
[[nodiscard]] std::string sentence(const rosin::rig& rig, const rosin::finding& finding);
/// The same for a list of warnings, which says by itself what its lines are.
[[nodiscard]] std::string warning_of(const rosin::rig& rig, const rosin::finding& finding);
[[nodiscard]] json to_json(const rosin::finding& finding);

/// The nominal string. Where the rig file gives the impedance, the tension is the one that belongs to it, and `assumed`
/// says so. Fails where length or tension are unknown: then there are no SI units to calculate in.
[[nodiscard]] rosin::outcome<rosin::string_parameters> nominal_string(const rosin::rig& rig, std::vector<std::string>& assumed);

}  // namespace tool
