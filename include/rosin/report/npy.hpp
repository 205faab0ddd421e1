// tier: hosted
// SPDX-License-Identifier: MIT
//
// A table as a NumPy file (format 1.0, 2.0 where the header is long): a structured array of little-endian float64, one
// field a column, so that numpy.load(file)["force_N"] is the column. Comments have no place in it.
//
#pragma once

#include <rosin/report/output_file.hpp>
#include <rosin/report/table.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <ostream>
#include <string_view>

namespace rosin {

namespace detail {

/// A number of bytes, the least significant first.
inline void put_little_endian(std::string& out, std::uint64_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) out += static_cast<char>(static_cast<unsigned char>(value >> (8 * i)));
}

/// Quoted the way Python reads it.
[[nodiscard]] inline std::string python_text(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return out + "'";
}

/// Everything before the samples; its length is a multiple of 64.
[[nodiscard]] inline std::string npy_header(const table& data) {
  std::string dict = "{'descr': [";
  for (const auto& c : data.columns) dict += "(" + python_text(c.name) + ", '<f8'), ";
  dict += "], 'fortran_order': False, 'shape': (" + std::to_string(data.rows()) + ",), }";
  const bool large = dict.size() + 75 > 65535;
  const std::size_t fixed = large ? 12 : 10;
  dict.append(63 - (fixed + dict.size()) % 64, ' ');
  dict += '\n';
  std::string out = "\x93NUMPY";
  put_little_endian(out, large ? 2 : 1, 1);
  put_little_endian(out, 0, 1);
  put_little_endian(out, dict.size(), large ? 4 : 2);
  return out + dict;
}

}  // namespace detail

inline void write_npy(std::ostream& out, const table& data) {
  out << detail::npy_header(data);
  std::string bytes;
  for (std::size_t row = 0; row < data.rows(); ++row) {
    for (const auto& c : data.columns) detail::put_little_endian(bytes, std::bit_cast<std::uint64_t>(c.values[row]), 8);
    if (bytes.size() > 60000) out << std::exchange(bytes, std::string{});
  }
  out << bytes;
}

[[nodiscard]] inline std::optional<failure> save_npy(const std::string& path, const table& data, overwrite existing) {
  if (!data.is_rectangular()) return failure{path + ": the columns are not of one length"};
  if (data.columns.empty()) return failure{path + ": a NumPy file needs at least one column"};
  return write_file(path, existing, [&](std::ostream& out) { write_npy(out, data); });
}

}  // namespace rosin
