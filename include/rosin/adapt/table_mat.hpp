// tier: hosted
// SPDX-License-Identifier: MIT
//
// A MATLAB file (version 4, 5 or 7.3 as far as matio was built for it) as a table: each vector of real numbers is a column under its
// variable's name, each matrix is its columns, NAME(:,1) and so on. What is not as long as the longest of them (a sampling rate, a
// date) is left out. Needs matio.
//
#pragma once

#include <rosin/adapt/mat_matio.hpp>
#include <rosin/adapt/table_text.hpp>

namespace rosin {

namespace detail {

template <class Number>
void add_mat_columns(const matvar_t& from, std::size_t rows, std::size_t columns, std::vector<table_column>& to) {
  const auto* values = static_cast<const Number*>(from.data);
  for (std::size_t c = 0; c < columns; ++c) {
    table_column one{columns == 1 ? std::string{from.name} : std::string{from.name} + "(:," + std::to_string(c + 1) + ")", {}};
    for (std::size_t r = 0; r < rows; ++r) one.values.push_back(static_cast<double>(values[c * rows + r]));
    to.push_back(std::move(one));
  }
}

/// The columns of a variable, if it is a real matrix of at most 1024 of them.
inline void add_mat_variable(const matvar_t& from, std::vector<table_column>& to) {
  if (from.rank != 2 || from.isComplex != 0 || from.name == nullptr || from.data == nullptr) return;
  std::size_t rows = from.dims[0], columns = from.dims[1];
  if (rows == 1) std::swap(rows, columns);
  if (rows == 0 || columns > 1024) return;
  switch (from.data_type) {
    case MAT_T_DOUBLE:
      return add_mat_columns<double>(from, rows, columns, to);
    case MAT_T_SINGLE:
      return add_mat_columns<float>(from, rows, columns, to);
    case MAT_T_INT8:
      return add_mat_columns<std::int8_t>(from, rows, columns, to);
    case MAT_T_UINT8:
      return from.class_type == MAT_C_CHAR ? void() : add_mat_columns<std::uint8_t>(from, rows, columns, to);
    case MAT_T_INT16:
      return add_mat_columns<std::int16_t>(from, rows, columns, to);
    case MAT_T_UINT16:
      return from.class_type == MAT_C_CHAR ? void() : add_mat_columns<std::uint16_t>(from, rows, columns, to);
    case MAT_T_INT32:
      return add_mat_columns<std::int32_t>(from, rows, columns, to);
    case MAT_T_UINT32:
      return add_mat_columns<std::uint32_t>(from, rows, columns, to);
    default:
      return;
  }
}

}  // namespace detail

[[nodiscard]] inline outcome<number_table> read_mat(const std::string& path, std::size_t max_rows = all_rows) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return failure{path + ": no such file"};
  const std::unique_ptr<mat_t, detail::close_mat> file{Mat_Open(path.c_str(), MAT_ACC_RDONLY)};
  if (!file) return failure{path + ": is no MATLAB file that can be read, or it is damaged"};
  std::vector<table_column> all;
  while (const std::unique_ptr<matvar_t, detail::free_matvar> one{Mat_VarReadNext(file.get())})
    detail::add_mat_variable(*one, all);
  return keep_longest(std::move(all), path, max_rows);
}

}  // namespace rosin
