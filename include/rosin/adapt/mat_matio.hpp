// tier: hosted
// SPDX-License-Identifier: MIT
//
// A table as a MATLAB file (version 5, compressed): one column vector of doubles a column, under the column's name, and
// the comment lines as one character array `comments`. Needs matio.
//
#pragma once

#include <rosin/report/output_file.hpp>
#include <rosin/report/table.hpp>

#include <matio.h>

#include <array>
#include <memory>

namespace rosin {

namespace detail {

struct close_mat {
  void operator()(mat_t* file) const noexcept { Mat_Close(file); }
};
struct free_matvar {
  void operator()(matvar_t* variable) const noexcept { Mat_VarFree(variable); }
};

/// MATLAB's rule for a name: a letter, then up to 62 letters, digits and underscores.
[[nodiscard]] inline bool is_matlab_name(const std::string& name) noexcept {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (name.empty() || name.size() > 63 || !letter(name.front())) return false;
  for (const char c : name)
    if (!letter(c) && !(c >= '0' && c <= '9') && c != '_') return false;
  return true;
}

[[nodiscard]] inline bool put_column(mat_t* file, const table_column& column) {
  std::array<std::size_t, 2> shape{column.values.size(), 1};
  // matio takes the data by a pointer to non-const although it only reads them
  auto* data = const_cast<double*>(column.values.data());
  const std::unique_ptr<matvar_t, free_matvar> variable{
      Mat_VarCreate(column.name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, shape.data(), data, MAT_F_DONT_COPY_DATA)};
  return variable && Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_ZLIB) == 0;
}

[[nodiscard]] inline bool put_comments(mat_t* file, const table& data) {
  std::string text;
  for (const auto& line : data.comments) text += one_line(line) + "\n";
  if (text.empty()) return true;
  std::array<std::size_t, 2> shape{1, text.size()};
  const std::unique_ptr<matvar_t, free_matvar> variable{
      Mat_VarCreate("comments", MAT_C_CHAR, MAT_T_UINT8, 2, shape.data(), text.data(), 0)};
  return variable && Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_NONE) == 0;
}

}  // namespace detail

[[nodiscard]] inline std::optional<failure> save_mat(const std::string& path, const table& data, overwrite existing) {
  if (!data.is_rectangular()) return failure{path + ": the columns are not of one length"};
  for (const auto& column : data.columns)
    if (!detail::is_matlab_name(column.name) || column.name == "comments")
      return failure{path + ": \"" + column.name + "\" cannot be the name of a variable in MATLAB"};
  return replace_file(path, existing, [&](const std::string& part) -> std::string {
    errno = 0;
    const std::unique_ptr<mat_t, detail::close_mat> file{Mat_CreateVer(part.c_str(), nullptr, MAT_FT_MAT5)};
    bool written = file && detail::put_comments(file.get(), data);
    for (const auto& column : data.columns) written = written && detail::put_column(file.get(), column);
    return written ? std::string{} : "cannot be written" + detail::system_reason();
  });
}

}  // namespace rosin
