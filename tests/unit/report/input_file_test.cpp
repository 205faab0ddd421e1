// SPDX-License-Identifier: MIT
#include <rosin/report/input_file.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

namespace report_input_file {

TEST_CASE("all of a file, or why it cannot be had") {
  const test::temporary_folder folder;
  const std::string text{"a\0b\r\n\xff", 6};
  folder.write("a", text);
  folder.write("empty", "");
  CHECK(*rosin::read_file(folder / "a") == text);
  CHECK(rosin::read_file(folder / "empty").error() == folder / "empty" + ": is empty");
  CHECK(rosin::read_file(folder / "none").error() == folder / "none" + ": cannot be read: No such file or directory");
  CHECK(rosin::read_file(folder.str()).error() == folder.str() + ": cannot be read: is a folder");
}

}  // namespace report_input_file
