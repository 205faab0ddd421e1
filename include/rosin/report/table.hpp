// tier: hosted
// SPDX-License-Identifier: MIT
//
// Named columns of numbers with comment lines above: what a result is before it becomes a file. NaN stands for a value
// that cannot be known; it is never made up.
//
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace rosin {

/// What a comment line holds: line breaks and other control characters have become spaces.
[[nodiscard]] inline std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

struct table_column {
  std::string name;  ///< with its unit, as force_N
  std::vector<double> values;
  int digits = 9;  ///< significant ones in a text file
};

struct table {
  std::vector<std::string> comments;
  std::vector<table_column> columns;

  [[nodiscard]] std::size_t rows() const noexcept { return columns.empty() ? 0 : columns.front().values.size(); }
  [[nodiscard]] const table_column* find(const std::string& name) const noexcept {
    for (const auto& c : columns)
      if (c.name == name) return &c;
    return nullptr;
  }
  void add(std::string name, std::vector<double> values, int digits = 9) {
    columns.push_back({std::move(name), std::move(values), digits});
  }
  /// All columns of one length.
  [[nodiscard]] bool is_rectangular() const noexcept {
    for (const auto& c : columns)
      if (c.values.size() != rows()) return false;
    return true;
  }
};

}  // namespace rosin
