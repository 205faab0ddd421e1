// SPDX-License-Identifier: MIT
#include <rosin/report/output_file.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

namespace report_output_file {

TEST_CASE("nothing is overwritten unless the caller says so") {
  const test::temporary_folder folder;
  const auto hello = [](std::ostream& out) { out << "hello"; };
  const auto bye = [](std::ostream& out) { out << "bye"; };
  CHECK_FALSE(rosin::write_file(folder / "a", rosin::overwrite::refuse, hello));
  CHECK(folder.read("a") == "hello");
  const auto why = rosin::write_file(folder / "a", rosin::overwrite::refuse, bye);
  REQUIRE(why);
  CHECK(why->message == folder / "a" + ": exists already");
  CHECK(folder.read("a") == "hello");
  CHECK_FALSE(rosin::write_file(folder / "a", rosin::overwrite::allow, bye));
  CHECK(folder.read("a") == "bye");
}

TEST_CASE("folders are no files, and missing folders are named") {
  const test::temporary_folder folder;
  CHECK(rosin::cannot_write(folder.str(), rosin::overwrite::allow));
  const auto why = rosin::cannot_write(folder / "no/a", rosin::overwrite::allow);
  REQUIRE(why);
  CHECK(why->message.find("does not exist") != std::string::npos);
}

TEST_CASE("a writer that fails leaves nothing behind") {
  const test::temporary_folder folder;
  CHECK(rosin::write_file(folder / "a", rosin::overwrite::refuse, [](std::ostream& out) {
    out << "half";
    out.setstate(std::ios::failbit);
  }));
  CHECK(std::filesystem::is_empty(folder.str()));
}

}  // namespace report_output_file
