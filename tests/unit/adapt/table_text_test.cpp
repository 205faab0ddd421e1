// SPDX-License-Identifier: MIT
#include <rosin/adapt/table_text.hpp>

#include <doctest/doctest.h>

#include <support/columns_of.hpp>

#include <support/temporary_folder.hpp>

namespace adapt_table_text {

namespace {

std::string wrong(std::string_view text) { return rosin::parse_table_text(text, "a.csv").error(); }

using test::columns;
columns values(std::string_view text, std::size_t max_rows = rosin::all_rows) {
  return test::columns_of(rosin::parse_table_text(text, "a.csv", max_rows));
}

}  // namespace

TEST_CASE("any separator, any line ends, with and without a header, comments and quotes") {
  const columns two{{1, 3}, {-2.5e-3, 4}};
  for (const char* text : {"1,-2.5e-3\n3,4\n", "1,-2.5e-3\r\n3,4\r\n", "1,-2.5e-3\r3,4\r", "1;-2.5e-3\n3;4", "1\t-2.5e-3\n3\t4\n",
                           "a,b\n1,-2.5e-3\n3,4\n", "\xef\xbb\xbf\"a\",\"b\"\n1,-2.5e-3\n3,4\n",
                           " 1 , -2.5e-3 \n\n# later\n+3,\"4\"\n", "% no header\n1,-2.5e-3,\n3,4,\n", "1,-0.0025\n3,4\n\n\n"}) {
    CAPTURE(text);
    CHECK(values(text) == two);
  }
  const auto named = rosin::parse_table_text("force (N);v\n1;2\n", "a.csv");
  REQUIRE(named);
  CHECK(named->data.columns[0].name == "force (N)");
  CHECK(rosin::column_text(named->data, 1) == "column 2 (v)");
  CHECK(values("5\n6\n") == columns{{5, 6}});
  CHECK(values("1,2\n3,4\n5,x\n", 2) == columns{{1, 3}, {2, 4}});
  CHECK(values("1e-400,2\n") == columns{{0}, {2}});
}

TEST_CASE("what is no table of numbers is said by line, column and reason") {
  CHECK(wrong("1.5,2\n3\n") == "a.csv:2: has 1 column(s), the first line has 2");
  CHECK(wrong("1,2\n3,4,5.5\n") == "a.csv:2: has 3 column(s), the first line has 2");
  CHECK(wrong("1,2\n3,4,5\n") ==
        "a.csv:2: has 3 column(s), the first line has 2; if its numbers have decimal commas, export it with points");
  CHECK(wrong("1;2;\n3;\n") == "a.csv:2: has 2 column(s), the first line has 3");
  CHECK(wrong("1,2\r\n3,four\r\n") == "a.csv:2: column 2 (index 1): \"four\" is not a number");
  CHECK(wrong("a,b\n1,2\n3,4 N\n") == "a.csv:3: column 2 (b): \"4 N\" is not a number");
  CHECK(wrong("1,2\n3,nan\n") == "a.csv:2: column 2 (index 1): \"nan\" is no finite number");
  CHECK(wrong("NaN,2\n") == "a.csv:1: column 1 (index 0): \"NaN\" is no finite number");
  CHECK(wrong("1,2\n-inf,2\n") == "a.csv:2: column 1 (index 0): \"-inf\" is no finite number");
  CHECK(wrong("1,2\n,2\n") == "a.csv:2: column 1 (index 0): is empty");
  CHECK(wrong("1\n\n2\n") == "a.csv:2: column 1 (index 0): is empty");
  CHECK(wrong("1,2\n3,1e999\n") == "a.csv:2: column 2 (index 1): \"1e999\" is too large for a number");
  CHECK(wrong("1 2\n3 4\n").find("columns are separated by commas, semicolons or tabs") != std::string::npos);
  CHECK(wrong("1,2\n3,4 5\n").find("columns are separated by commas") != std::string::npos);
  CHECK(wrong("a,b\n") == "a.csv: holds no numbers");
  CHECK(wrong("") == "a.csv: holds no numbers");
  CHECK(wrong(std::string_view{"1,\0", 3}) == "a.csv: is no text: byte 3 is zero");
  CHECK(wrong("\xff\xfe"
              "1") == "a.csv: is a text in UTF-16: export it as plain text (UTF-8)");
}

TEST_CASE("decimal commas are told, between semicolons and where they hide between commas") {
  CHECK(wrong("1;2\n0,045;2\n") == "a.csv:2: column 1 (index 0): \"0,045\" has a decimal comma: export the table with points");
  CHECK(wrong("0,045\t1,5\n").find("has a decimal comma") != std::string::npos);
  const std::string hidden = "seems to have decimal commas between columns that commas separate: export it with points";
  CHECK(wrong("0,045,1,25\n") == "a.csv:1: " + hidden);
  CHECK(wrong("1,5,1,25\n2,5,0,075\n") == "a.csv:2: " + hidden);
  CHECK(wrong("1,2\n0,5,0,5\n") == "a.csv:2: " + hidden);
  CHECK(values("00123.5,2\n") == columns{{123.5}, {2}});
  CHECK(values("1,2,3,4\n5,6,7,8\n").size() == 4);
}

TEST_CASE("a file: its beginning alone, and rows by their lines") {
  const test::temporary_folder folder;
  std::string text = "# made by a machine\nt,x\n";
  for (int i = 0; i < 20000; ++i) text += std::to_string(i) + "," + std::to_string(2 * i) + "\n";
  const std::string path = folder.write("a.csv", text);
  const auto head = rosin::read_table_text(path, 5);
  REQUIRE(head);
  CHECK(head->data.rows() == 5);
  const auto all = rosin::read_table_text(path);
  REQUIRE(all);
  CHECK(all->data.rows() == 20000);
  CHECK(all->data.columns[1].values.back() == 39998);
  CHECK(all->place_of("a.csv", 0) == "a.csv:3");
  CHECK(all->place_of("a.csv", 100) == "a.csv:103");
  CHECK(rosin::parse_table_text("1\n# x\n2\n3\n", "b")->place_of("b", 2) == "b:4");
  CHECK(rosin::read_table_text(folder / "none.csv").error() == folder / "none.csv: no such file");
  CHECK(rosin::read_table_text(folder.write("empty.csv", "")).error() == folder / "empty.csv: is empty");
  CHECK(rosin::read_table_text(folder.str()).error() == folder.str() + ": is a folder");
}

}  // namespace adapt_table_text
