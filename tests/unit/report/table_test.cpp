// SPDX-License-Identifier: MIT
#include <rosin/report/table.hpp>

#include <doctest/doctest.h>

namespace report_table {

TEST_CASE("columns are found by name and have to be of one length") {
  rosin::table t;
  CHECK(t.rows() == 0);
  CHECK(t.is_rectangular());
  t.add("time_s", {0, 1, 2}, 12);
  t.add("force_N", {1, 2, 3});
  CHECK(t.rows() == 3);
  CHECK(t.is_rectangular());
  CHECK(t.find("force_N")->values[1] == 2);
  CHECK(t.find("time_s")->digits == 12);
  CHECK(t.find("force") == nullptr);
  t.add("velocity_m_s", {1});
  CHECK_FALSE(t.is_rectangular());
}

}  // namespace report_table
