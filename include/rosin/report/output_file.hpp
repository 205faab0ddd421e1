// tier: hosted
// SPDX-License-Identifier: MIT
//
// A result goes to a file next to its place and takes that place only when it is complete: whoever finds the file finds
// all of it. Nothing is overwritten unless the caller says so.
//
#pragma once

#include <rosin/core/outcome.hpp>

#include <filesystem>
#include <fstream>
#include <optional>

namespace rosin {

enum class overwrite { refuse, allow };

/// The reason why nothing may be written there, if there is one.
[[nodiscard]] inline std::optional<failure> cannot_write(const std::string& path, overwrite existing) {
  std::error_code ignored;
  const std::filesystem::path place{path};
  if (std::filesystem::is_directory(place, ignored)) return failure{path + ": is a folder"};
  if (existing == overwrite::refuse && std::filesystem::exists(place, ignored)) return failure{path + ": exists already"};
  const auto folder = place.parent_path();
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored))
    return failure{path + ": the folder " + folder.string() + " does not exist"};
  return std::nullopt;
}

/// Calls write(stream), then puts the file in its place. Empty: it is there; otherwise what went wrong.
template <class Write>
[[nodiscard]] std::optional<failure> write_file(const std::string& path, overwrite existing, Write write) {
  if (auto why = cannot_write(path, existing)) return why;
  const std::string part = path + ".part";
  std::error_code error;
  {
    std::ofstream stream{part, std::ios::binary | std::ios::trunc};
    if (stream) write(stream);
    stream.close();
    if (!stream) {
      std::filesystem::remove(part, error);
      return failure{path + ": cannot be written"};
    }
  }
  std::filesystem::rename(part, path, error);
  if (!error) return std::nullopt;
  return failure{path + ": " + error.message()};
}

}  // namespace rosin
