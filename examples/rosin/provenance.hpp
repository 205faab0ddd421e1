// SPDX-License-Identifier: MIT
//
// Where a result comes from: version of the tool, the files that were read with their checksums, the options used. It
// stands in every result: as an object in JSON, as comment lines above a table.
//
#pragma once

#include "command_line.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace tool {

struct input_file {
  std::string path, sha256;
  std::uint64_t bytes = 0;
};

struct provenance {
  std::string command;
  std::vector<input_file> inputs;
  std::vector<std::pair<std::string, std::string>> options;  ///< as given on the command line

  /// The command's name and every option that was given.
  explicit provenance(const CLI::App& used);

  /// Reads the whole file for its checksum; the reason if it cannot be read.
  [[nodiscard]] std::optional<rosin::failure> add_input(const std::string& path);

  [[nodiscard]] json to_json() const;
  [[nodiscard]] std::vector<std::string> comment_lines() const;
};

/// SHA-256 of a file as 64 hexadecimal digits.
[[nodiscard]] rosin::outcome<input_file> fingerprint(const std::string& path);

}  // namespace tool
