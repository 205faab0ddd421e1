// SPDX-License-Identifier: MIT
#include <rosin/report/csv.hpp>

#include <doctest/doctest.h>

#include <support/comma_locale.hpp>
#include <support/temporary_folder.hpp>

#include <numbers>

namespace report_csv {

namespace {

const double unknown = std::numeric_limits<double>::quiet_NaN();

rosin::outcome<rosin::table> read(const std::string& text) {
  std::istringstream in{text};
  return rosin::read_csv(in, "a.csv");
}

}  // namespace

TEST_CASE("comments, header, rows; an unknown value is an empty field") {
  rosin::table t;
  t.comments = {"rosin 0.1.0", "take bow-1"};
  t.add("time_s", {0, 1.0 / 128000, 2.0 / 128000}, 12);
  t.add("force_N", {unknown, -0.125, 1e-7});
  std::ostringstream out;
  rosin::write_csv(out, t);
  CHECK(out.str() == "# rosin 0.1.0\n# take bow-1\ntime_s,force_N\n0,\n7.8125e-06,-0.125\n1.5625e-05,1e-07\n");
}

TEST_CASE("what was written is read back, to the digits asked for") {
  const test::temporary_folder folder;
  rosin::table t;
  t.comments = {"a"};
  t.add("x", {std::numbers::pi, unknown, -1e300, 5e-324}, 17);
  t.add("y", {std::numbers::pi, 0, unknown, 1}, 4);
  REQUIRE_FALSE(rosin::save_csv(folder / "t.csv", t, rosin::overwrite::refuse));
  const auto back = rosin::read_csv(folder / "t.csv");
  REQUIRE(back);
  CHECK(back->comments == t.comments);
  CHECK(back->find("x")->values[0] == std::numbers::pi);
  CHECK(std::isnan(back->find("x")->values[1]));
  CHECK(back->find("x")->values[2] == -1e300);
  CHECK(back->find("y")->values[0] == 3.142);
  CHECK(back->rows() == 4);
}

TEST_CASE("many rows") {
  const test::temporary_folder folder;
  rosin::table t;
  std::vector<double> x(20000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<double>(i) / 7;
  t.add("x", x, 17);
  t.add("y", x, 17);
  REQUIRE_FALSE(rosin::save_csv(folder / "t.csv", t, rosin::overwrite::refuse));
  const auto back = rosin::read_csv(folder / "t.csv");
  REQUIRE(back);
  CHECK(back->find("x")->values == x);
  CHECK(back->find("y")->values == x);
}

TEST_CASE("files from elsewhere: CR LF, byte order mark, quotes, spaces, plus signs, blank lines") {
  const auto t = read("\xef\xbb\xbf\"a\", b \r\n\r\n +1 ,\"2.5\"\r\n-3e2,\r\n");
  REQUIRE(t);
  REQUIRE(t->columns.size() == 2);
  CHECK(t->columns[1].name == "b");
  CHECK(t->columns[0].values == std::vector<double>{1, -300});
  CHECK(t->columns[1].values[0] == 2.5);
  CHECK(std::isnan(t->columns[1].values[1]));
}

TEST_CASE("a column of one: an empty line is a row without a value") {
  const auto t = read("a\n1\n\n3\n");
  REQUIRE(t);
  REQUIRE(t->rows() == 3);
  CHECK(std::isnan(t->columns[0].values[1]));
}

TEST_CASE("whatever stands in comments and names, the table is read again") {
  rosin::table t;
  t.comments = {"rig first line\nsecond line, of two\r\n\ttitle", "\"quoted\" 100 % #", ""};
  t.add("a,b", {1, 2});
  t.add("say \"x\"", {3, unknown});
  t.add("#c\n[d]", {5, 6});
  std::ostringstream out;
  rosin::write_csv(out, t);
  CHECK(out.str() ==
        "# rig first line second line, of two   title\n# \"quoted\" 100 % #\n# \n"
        "\"a,b\",\"say \"\"x\"\"\",\"#c [d]\"\n1,3,5\n2,,6\n");
  const auto back = read(out.str());
  REQUIRE(back);
  CHECK(back->comments[0] == "rig first line second line, of two   title");
  CHECK(back->comments[1] == t.comments[1]);
  CHECK(back->columns[0].name == "a,b");
  CHECK(back->columns[1].name == "say \"x\"");
  CHECK(back->columns[2].name == "#c [d]");
  CHECK(back->columns[2].values == t.columns[2].values);
}

TEST_CASE("tables are the same in a program with decimal commas") {
  rosin::table t;
  t.add("x", {12345.5, -1e-7});
  const test::comma_locale german;
  std::ostringstream out;
  rosin::write_csv(out, t);
  CHECK(out.str() == "x\n12345.5\n-1e-07\n");
  CHECK(read(out.str())->columns[0].values == t.columns[0].values);
}

TEST_CASE("what is no table is named with its line") {
  CHECK(read("").error() == "a.csv: holds no header line");
  CHECK(read("# only\n").error() == "a.csv: holds no header line");
  CHECK(read("a,b\n1,x\n").error() == "a.csv:2: \"x\" is not a number");
  CHECK(read("a,b\n1,2\n1,2,3\n").error() == "a.csv:3: has 3 fields, the header has 2");
  CHECK(read("a,b\n1,2\n1\n").error() == "a.csv:3: has 1 fields, the header has 2");
  CHECK(read("a\n1e999\n").error() == "a.csv:2: \"1e999\" is not a number");
  CHECK_FALSE(rosin::read_csv("/nonexistent.csv"));
}

TEST_CASE("columns of different length are not written") {
  const test::temporary_folder folder;
  rosin::table t;
  t.add("x", {1, 2});
  t.add("y", {1});
  CHECK(rosin::save_csv(folder / "t.csv", t, rosin::overwrite::refuse));
}

}  // namespace report_csv
