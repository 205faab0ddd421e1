// SPDX-License-Identifier: MIT
#include <rosin/adapt/table_mat.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

namespace adapt_table_mat {

TEST_CASE("vectors are columns under their names, a matrix is its columns, what is shorter is left out") {
  const test::temporary_folder folder;
  rosin::table made;
  made.comments.push_back("a comment is no column");
  made.add("near_N", {1, 2, 3});
  made.add("far_N", {4, 5, 6});
  REQUIRE_FALSE(rosin::save_mat(folder / "a.mat", made, rosin::overwrite::refuse));
  {
    std::unique_ptr<mat_t, rosin::detail::close_mat> file{Mat_Open((folder / "a.mat").c_str(), MAT_ACC_RDWR)};
    REQUIRE(file);
    std::array<std::size_t, 2> one{1, 1}, shape{3, 2};
    double rate = 50000;
    std::array<std::int16_t, 6> raw{1, 2, 3, -1, -2, -3};
    const std::unique_ptr<matvar_t, rosin::detail::free_matvar> fs{
        Mat_VarCreate("fs", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, one.data(), &rate, 0)};
    const std::unique_ptr<matvar_t, rosin::detail::free_matvar> data{
        Mat_VarCreate("raw", MAT_C_INT16, MAT_T_INT16, 2, shape.data(), raw.data(), 0)};
    REQUIRE(Mat_VarWrite(file.get(), fs.get(), MAT_COMPRESSION_NONE) == 0);
    REQUIRE(Mat_VarWrite(file.get(), data.get(), MAT_COMPRESSION_NONE) == 0);
  }
  const auto read = rosin::read_mat(folder / "a.mat");
  CHECK(read.error() == "");
  REQUIRE(read);
  REQUIRE(read->data.columns.size() == 4);
  CHECK(read->data.find("near_N")->values == std::vector<double>{1, 2, 3});
  CHECK(read->data.find("raw(:,2)")->values == std::vector<double>{-1, -2, -3});
  CHECK(rosin::read_mat(folder / "a.mat", 2)->data.rows() == 2);
}

TEST_CASE("a file that is none or holds no number") {
  const test::temporary_folder folder;
  CHECK(rosin::read_mat(folder / "none.mat").error() == folder / "none.mat: no such file");
  CHECK(rosin::read_mat(folder.write("b.mat",
                                     "no MATLAB file, but long enough to hold a head of 128 bytes of text, if "
                                     "somebody tried to read it as one, which somebody does here on purpose"))
            .error()
            .starts_with(folder / "b.mat: "));
  rosin::table made;
  made.add("x", {1, std::nan("")});
  REQUIRE_FALSE(rosin::save_mat(folder / "c.mat", made, rosin::overwrite::refuse));
  CHECK(rosin::read_mat(folder / "c.mat").error() == folder / "c.mat: row 2: column 1 (x): is no finite number");
}

}  // namespace adapt_table_mat
