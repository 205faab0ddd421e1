// tier: hosted
// SPDX-License-Identifier: MIT
//
// An HDF5 file as a table: each data set of real numbers on one axis is a column under its path (without the first slash), each on
// two axes is its columns, PATH[:,0] and so on. What is not as long as the longest of them is left out. Needs the HDF5 library.
//
#pragma once

#include <rosin/adapt/table_text.hpp>

#include <hdf5.h>

#include <array>

namespace rosin {

namespace detail {

/// A handle of the HDF5 library, closed by the function that belongs to it.
class hdf5_handle {
public:
  hdf5_handle(hid_t id, herr_t (*close)(hid_t)) noexcept : id_{id}, close_{close} {}
  hdf5_handle(const hdf5_handle&) = delete;
  hdf5_handle& operator=(const hdf5_handle&) = delete;
  ~hdf5_handle() {
    if (id_ >= 0) close_(id_);
  }
  [[nodiscard]] hid_t operator*() const noexcept { return id_; }
  explicit operator bool() const noexcept { return id_ >= 0; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

struct hdf5_reading {
  std::vector<table_column> columns;
  std::string damaged;  ///< a data set that could not be read
};

/// The columns of a data set, if it is of real numbers on one or two axes.
inline void add_hdf5_set(hid_t file, const char* name, hdf5_reading& to) {
  const hdf5_handle set{H5Dopen2(file, name, H5P_DEFAULT), H5Dclose};
  if (!set) return;
  const hdf5_handle type{H5Dget_type(*set), H5Tclose}, space{H5Dget_space(*set), H5Sclose};
  if (!type || !space || (H5Tget_class(*type) != H5T_FLOAT && H5Tget_class(*type) != H5T_INTEGER)) return;
  const int axes = H5Sget_simple_extent_ndims(*space);
  if (axes != 1 && axes != 2) return;
  std::array<hsize_t, 2> size{1, 1};
  H5Sget_simple_extent_dims(*space, size.data(), nullptr);
  if (size[0] == 0 || size[1] == 0 || size[1] > 1024 || size[0] > (hsize_t{1} << 29) / size[1]) return;
  std::vector<double> values(static_cast<std::size_t>(size[0] * size[1]));
  if (H5Dread(*set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    to.damaged = name;
    return;
  }
  const auto rows = static_cast<std::size_t>(size[0]), columns = static_cast<std::size_t>(size[1]);
  for (std::size_t c = 0; c < columns; ++c) {
    table_column one{axes == 1 ? std::string{name} : std::string{name} + "[:," + std::to_string(c) + "]", {}};
    for (std::size_t r = 0; r < rows; ++r) one.values.push_back(values[r * columns + c]);
    to.columns.push_back(std::move(one));
  }
}

inline herr_t visit_hdf5(hid_t file, const char* name, const H5O_info_t* info, void* to) noexcept {
  if (info->type == H5O_TYPE_DATASET) add_hdf5_set(file, name, *static_cast<hdf5_reading*>(to));
  return 0;
}

inline herr_t visit_all_hdf5(hid_t file, hdf5_reading& to) noexcept {
#if H5_VERSION_GE(1, 12, 0)
  return H5Ovisit3(file, H5_INDEX_NAME, H5_ITER_INC, visit_hdf5, &to, H5O_INFO_BASIC);
#else
  return H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit_hdf5, &to, H5O_INFO_BASIC);
#endif
}

}  // namespace detail

[[nodiscard]] inline outcome<number_table> read_hdf5(const std::string& path, std::size_t max_rows = all_rows) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return failure{path + ": no such file"};
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // it would print its own stack of reasons
  const detail::hdf5_handle file{H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (!file) return failure{path + ": is no HDF5 file that can be read, or it is damaged"};
  detail::hdf5_reading all;
  if (detail::visit_all_hdf5(*file, all) < 0 || !all.damaged.empty())
    return failure{path + ": " + (all.damaged.empty() ? "" : all.damaged + ": ") + "is damaged"};
  return keep_longest(std::move(all.columns), path, max_rows);
}

}  // namespace rosin
