// tier: hosted
// SPDX-License-Identifier: MIT
//
// Something that was found in a recording: how bad it is, in which take and channel, from when to when, what it is and
// what to do about it.
//
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace rosin {

/// note: worth knowing. warning: results will suffer. error: results would be wrong.
enum class severity { note, warning, error };
inline constexpr std::array severity_names{"note", "warning", "error"};
[[nodiscard]] inline std::string name_of(severity level) { return severity_names.at(static_cast<std::size_t>(level)); }

struct finding {
  severity level = severity::note;
  std::string kind;           ///< a short name that stays: "clipping", "swapped-channels", ...
  std::string take, channel;  ///< channel is empty where the take as a whole is meant
  double start_s = 0, end_s = 0;
  std::string what, advice;
  std::size_t samples = 0;  ///< so many of those from start to end are meant; 0: not counted
};

[[nodiscard]] inline bool has_error(const std::vector<finding>& findings) noexcept {
  for (const auto& f : findings)
    if (f.level == severity::error) return true;
  return false;
}

}  // namespace rosin
