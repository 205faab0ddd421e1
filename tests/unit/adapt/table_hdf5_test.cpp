// SPDX-License-Identifier: MIT
#include <rosin/adapt/table_hdf5.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

namespace adapt_table_hdf5 {

namespace {

using rosin::detail::hdf5_handle;

void put(hid_t where, const char* name, std::vector<hsize_t> shape, const std::vector<double>& values, hid_t type) {
  const hdf5_handle space{H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose};
  const hdf5_handle set{H5Dcreate2(where, name, type, *space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose};
  REQUIRE(H5Dwrite(*set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
}

}  // namespace

TEST_CASE("data sets are columns under their paths, two axes are columns, what is shorter is left out") {
  const test::temporary_folder folder;
  {
    const hdf5_handle file{H5Fcreate((folder / "a.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
    REQUIRE(file);
    put(*file, "near", {3}, {1, 2, 3}, H5T_IEEE_F64LE);
    put(*file, "rate", {1}, {50000}, H5T_IEEE_F64LE);
    const hdf5_handle group{H5Gcreate2(*file, "stroke", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose};
    put(*group, "both", {3, 2}, {1, -1, 2, -2, 3, -3}, H5T_STD_I16BE);
  }
  const auto read = rosin::read_hdf5(folder / "a.h5");
  CHECK(read.error() == "");
  REQUIRE(read);
  REQUIRE(read->data.columns.size() == 3);
  CHECK(read->data.find("near")->values == std::vector<double>{1, 2, 3});
  REQUIRE(read->data.find("stroke/both[:,1]") != nullptr);
  CHECK(read->data.find("stroke/both[:,1]")->values == std::vector<double>{-1, -2, -3});
  CHECK(rosin::read_hdf5(folder / "a.h5", 2)->data.rows() == 2);
}

TEST_CASE("a file that is none") {
  const test::temporary_folder folder;
  CHECK(rosin::read_hdf5(folder / "none.h5").error() == folder / "none.h5: no such file");
  CHECK(rosin::read_hdf5(folder.write("b.h5", "text")).error() ==
        folder / "b.h5: is no HDF5 file that can be read, or it is damaged");
}

}  // namespace adapt_table_hdf5
