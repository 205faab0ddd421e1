// SPDX-License-Identifier: MIT
//
// The rig file that goes with simulated recordings: the one they were made from, without what only the simulation
// knows ([simulate], [friction], start_s). Everything else stays as it was written, comments included.
//
#pragma once

#include <rosin/core/outcome.hpp>

#include <string>

namespace tool {

/// `text` is a rig file without errors; `file` is its name for messages.
[[nodiscard]] rosin::outcome<std::string> declaration(const std::string& text, const std::string& file);

}  // namespace tool
