// SPDX-License-Identifier: MIT
#include <rosin/adapt/table_npy.hpp>

#include <doctest/doctest.h>

#include <support/columns_of.hpp>

#include <rosin/report/npy.hpp>
#include <support/temporary_folder.hpp>

namespace adapt_table_npy {

namespace {

/// A file as numpy.save writes it: head, then the bytes.
std::string npy(const std::string& dict, const std::string& bytes, char version = 1) {
  std::string out = "\x93NUMPY";
  out += version, out += '\0';
  rosin::detail::put_little_endian(out, dict.size(), version == 1 ? 2 : 4);
  return out + dict + bytes;
}
std::string head(const std::string& descr, const std::string& shape, const std::string& fortran = "False") {
  return "{'descr': " + descr + ", 'fortran_order': " + fortran + ", 'shape': " + shape + ", }\n";
}
std::string doubles(std::initializer_list<double> values) {
  std::string out;
  for (const double x : values) rosin::detail::put_little_endian(out, std::bit_cast<std::uint64_t>(x), 8);
  return out;
}
using test::columns;
columns values(const std::string& bytes) { return test::columns_of(rosin::parse_npy(bytes, "a.npy")); }

}  // namespace

TEST_CASE("one and two axes, either order, every kind of real number") {
  CHECK(values(npy(head("'<f8'", "(3,)"), doubles({1, 2, 3}))) == columns{{1, 2, 3}});
  CHECK(values(npy(head("'<f8'", "(2, 3)"), doubles({1, 2, 3, 4, 5, 6}))) == columns{{1, 4}, {2, 5}, {3, 6}});
  CHECK(values(npy(head("'<f8'", "(2, 3)", "True"), doubles({1, 4, 2, 5, 3, 6}), 2)) == columns{{1, 4}, {2, 5}, {3, 6}});
  CHECK(values(npy(head("'<i2'", "(2,)"), std::string("\x01\x00\xff\xff", 4))) == columns{{1, -1}});
  CHECK(values(npy(head("'>i2'", "(2,)"), std::string("\x00\x01\xff\xfe", 4))) == columns{{1, -2}});
  CHECK(values(npy(head("'|u1'", "(2,)"), std::string("\x01\xff", 2))) == columns{{1, 255}});
  CHECK(values(npy(head("'<f4'", "(1,)"), std::string("\x00\x00\x80\x3e", 4))) == columns{{0.25}});
}

TEST_CASE("what rosin writes is read with its names, and only as far as wanted") {
  const test::temporary_folder folder;
  rosin::table made;
  made.add("force_N", {1.5, -2, 3});
  made.add("it's", {4, 5, 6.25});
  REQUIRE_FALSE(rosin::save_npy(folder / "a.npy", made, rosin::overwrite::refuse));
  const auto read = rosin::read_npy(folder / "a.npy");
  REQUIRE(read);
  CHECK(read->data.columns[0].name == "force_N");
  CHECK(read->data.columns[1].name == "it's");
  CHECK(read->data.columns[1].values == std::vector<double>{4, 5, 6.25});
  CHECK(rosin::read_npy(folder / "a.npy", 2)->data.rows() == 2);
}

TEST_CASE("what is none, is cut off or holds no numbers is refused in words") {
  const auto wrong = [](const std::string& bytes) { return rosin::parse_npy(bytes, "a.npy").error(); };
  CHECK(wrong("PK") == "a.npy: is no NumPy file");
  CHECK(wrong(npy(head("'<f8'", "(3,)"), doubles({1, 2}))) == "a.npy: truncated: 3 rows promised, 2 are there");
  CHECK(wrong(npy(head("'<f8'", "(3,)"), "").substr(0, 40)) == "a.npy: truncated: it ends within its head");
  const std::string no_table = "a.npy: its head describes no table of real numbers on one or two axes";
  CHECK(wrong(npy(head("'<c16'", "(1,)"), doubles({1, 2}))) == no_table);
  CHECK(wrong(npy(head("'<f8'", "(1, 1, 1)"), doubles({1}))) == no_table);
  CHECK(wrong(npy(head("'<f8'", "()"), doubles({1}))) == no_table);
  CHECK(wrong(npy("{'descr'", doubles({1}))) == no_table);
  CHECK(wrong(npy(head("'<f8'", "(0,)"), "")) == "a.npy: holds no numbers");
  CHECK(wrong(npy(head("'<f8'", "(2, 2)"), doubles({1, 2, 3, std::nan("")}))) ==
        "a.npy: row 2: column 2 (index 1): is no finite number");
  CHECK(wrong(npy(head("'<f8'", "(18446744073709551615, 2)"), doubles({1, 2}))).find("truncated") != std::string::npos);
}

}  // namespace adapt_table_npy
