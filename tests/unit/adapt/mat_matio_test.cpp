// SPDX-License-Identifier: MIT
#include <rosin/adapt/mat_matio.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

TEST_CASE("columns and comments are variables of a MATLAB file") {
  const test::temporary_folder folder;
  rosin::table t;
  t.comments = {"rosin", "take a"};
  t.add("force_N", {0.1, -2, 3});
  t.add("time_s", {0, 1, 2});
  REQUIRE_FALSE(rosin::save_mat(folder / "t.mat", t, rosin::overwrite::refuse));
  const std::unique_ptr<mat_t, rosin::detail::close_mat> file{Mat_Open((folder / "t.mat").c_str(), MAT_ACC_RDONLY)};
  REQUIRE(file);
  const std::unique_ptr<matvar_t, rosin::detail::free_matvar> force{Mat_VarRead(file.get(), "force_N")};
  REQUIRE(force);
  CHECK(force->class_type == MAT_C_DOUBLE);
  CHECK(force->dims[0] == 3);
  CHECK(force->dims[1] == 1);
  CHECK(static_cast<const double*>(force->data)[1] == -2);
  const std::unique_ptr<matvar_t, rosin::detail::free_matvar> comments{Mat_VarRead(file.get(), "comments")};
  REQUIRE(comments);
  CHECK(std::string(static_cast<const char*>(comments->data), comments->nbytes) == "rosin\ntake a\n");
}

TEST_CASE("names that MATLAB cannot hold, and files that exist") {
  const test::temporary_folder folder;
  rosin::table t;
  t.add("1x", {1});
  CHECK(rosin::save_mat(folder / "t.mat", t, rosin::overwrite::refuse));
  t.columns[0].name = "comments";
  CHECK(rosin::save_mat(folder / "t.mat", t, rosin::overwrite::refuse));
  t.columns[0].name = "x";
  CHECK_FALSE(rosin::save_mat(folder / "t.mat", t, rosin::overwrite::refuse));
  CHECK(rosin::save_mat(folder / "t.mat", t, rosin::overwrite::refuse));
  CHECK_FALSE(rosin::save_mat(folder / "t.mat", t, rosin::overwrite::allow));
  CHECK(std::distance(std::filesystem::directory_iterator{folder.str()}, {}) == 1);
}
