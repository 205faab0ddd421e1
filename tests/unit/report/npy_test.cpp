// SPDX-License-Identifier: MIT
#include <rosin/report/npy.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

#include <cstring>

namespace report_npy {

TEST_CASE("the bytes of a NumPy file, format 1.0") {
  const test::temporary_folder folder;
  rosin::table t;
  t.add("time_s", {0.5, 1});
  t.add("it's", {-2, 3});
  REQUIRE_FALSE(rosin::save_npy(folder / "t.npy", t, rosin::overwrite::refuse));
  const std::string bytes = folder.read("t.npy");
  REQUIRE(bytes.size() > 10);
  CHECK(bytes.substr(0, 8) == std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t length = static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  CHECK((10 + length) % 64 == 0);
  CHECK(bytes[9 + length] == '\n');
  const std::string dict = bytes.substr(10, length);
  CHECK(dict.find("{'descr': [('time_s', '<f8'), ('it\\'s', '<f8'), ], 'fortran_order': False, 'shape': (2,), }") == 0);
  REQUIRE(bytes.size() == 10 + length + 4 * 8);
  double values[4];
  std::memcpy(values, bytes.data() + 10 + length, sizeof values);
  CHECK(values[0] == 0.5);
  CHECK(values[1] == -2);
  CHECK(values[2] == 1);
  CHECK(values[3] == 3);
}

TEST_CASE("so many columns that the header needs format 2.0") {
  const test::temporary_folder folder;
  rosin::table t;
  for (int i = 0; i < 5000; ++i) t.add("column_" + std::to_string(i), {1.0 * i});
  REQUIRE_FALSE(rosin::save_npy(folder / "t.npy", t, rosin::overwrite::refuse));
  const std::string bytes = folder.read("t.npy");
  CHECK(bytes[6] == 2);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, 4);
  CHECK(bytes.size() == 12 + length + 5000 * 8);
  CHECK((12 + length) % 64 == 0);
}

TEST_CASE("an empty table and ragged columns are refused") {
  const test::temporary_folder folder;
  rosin::table t;
  CHECK(rosin::save_npy(folder / "t.npy", t, rosin::overwrite::refuse));
  t.add("x", {1});
  t.add("y", {});
  CHECK(rosin::save_npy(folder / "t.npy", t, rosin::overwrite::refuse));
}

}  // namespace report_npy
