// SPDX-License-Identifier: MIT
//
// The plucks of a rig with force transducers at both ends, as a fit takes them, and what is known before it.
//
#pragma once

#include "rig_input.hpp"

#include <rosin/calibrate/pluck_layout.hpp>

namespace tool {

struct rig_plucks {
  std::vector<rosin::pluck_take> takes, held_out;
  std::vector<std::string> warnings;
  bool incomplete = false;  ///< some had to be left out
};

/// Reads every pluck; those with an error are left out and named. All that are to be fitted have one rate: that of the first. Where
/// every one lost samples, what they are before that is used, and said.
[[nodiscard]] rig_plucks read_plucks(const rosin::rig& rig, provenance& from);

/// No pluck that is to be fitted holds its release, and nothing else is wrong with them: what rings can be used.
[[nodiscard]] bool all_begin_late(const rosin::rig& rig, provenance& from);

/// The effects that [model] physics declares, and what of them a fit of plucks has options for.
[[nodiscard]] std::vector<std::string> physics_of(const rosin::rig& rig);
[[nodiscard]] rosin::pluck_options options_for(const std::vector<std::string>& physics);

/// Nominal values; of the rig's declared inharmonicity only where it is known.
[[nodiscard]] rosin::pluck_guess guess_of(const rosin::rig& rig, const rosin::rig_values& values);

}  // namespace tool
