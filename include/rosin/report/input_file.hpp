// tier: hosted
// SPDX-License-Identifier: MIT
//
// All that a file holds, or why it cannot be had: it is not there, a folder, not ours to read, or empty (none of the formats here is).
//
#pragma once

#include <rosin/report/output_file.hpp>

#include <sstream>

namespace rosin {

[[nodiscard]] inline outcome<std::string> read_file(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return failure{path + ": cannot be read: is a folder"};
  errno = 0;
  std::ifstream in{path, std::ios::binary};
  std::ostringstream text;
  if (!in) return failure{path + ": cannot be read" + detail::system_reason()};
  if (in.peek() == std::ifstream::traits_type::eof())
    return failure{path + (in.bad() ? ": cannot be read" + detail::system_reason() : std::string{": is empty"})};
  if (!(text << in.rdbuf())) return failure{path + ": cannot be read" + detail::system_reason()};
  return std::move(text).str();
}

}  // namespace rosin
