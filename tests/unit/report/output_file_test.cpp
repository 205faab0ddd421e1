// SPDX-License-Identifier: MIT
#include <rosin/report/output_file.hpp>

#include <doctest/doctest.h>

#include <support/comma_locale.hpp>
#include <support/temporary_folder.hpp>

#include <sys/stat.h>

#include <thread>

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

TEST_CASE("a link is followed, to what is there and to what is not there yet") {
  const test::temporary_folder folder;
  const auto hello = [](std::ostream& out) { out << "hello"; };
  folder.write("target", "old");
  std::filesystem::create_symlink("target", folder / "link");
  std::filesystem::create_symlink("link", folder / "second");
  std::filesystem::create_symlink("later", folder / "dangling");
  CHECK(rosin::write_file(folder / "second", rosin::overwrite::refuse, hello));
  CHECK_FALSE(rosin::write_file(folder / "second", rosin::overwrite::allow, hello));
  CHECK(folder.read("target") == "hello");
  CHECK(std::filesystem::is_symlink(folder / "link"));
  CHECK_FALSE(rosin::write_file(folder / "dangling", rosin::overwrite::refuse, hello));
  CHECK(folder.read("later") == "hello");
  CHECK(std::filesystem::is_symlink(folder / "dangling"));
  std::filesystem::create_symlink("round", folder / "round");
  CHECK(rosin::write_file(folder / "round", rosin::overwrite::allow, hello));
}

TEST_CASE("pipes and devices are written to, and stay what they are") {
  const test::temporary_folder folder;
  const std::string pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  std::string got;
  std::thread reader{[&] { got = folder.read("pipe"); }};
  CHECK_FALSE(rosin::write_file(pipe, rosin::overwrite::refuse, [](std::ostream& out) { out << "hello"; }));
  reader.join();
  CHECK(got == "hello");
  CHECK(std::filesystem::is_fifo(pipe));
  CHECK_FALSE(rosin::write_file("/dev/null", rosin::overwrite::refuse, [](std::ostream& out) { out << "hello"; }));
  CHECK(std::filesystem::is_character_file("/dev/null"));
  CHECK(rosin::replace_file("/dev/null", rosin::overwrite::allow, [](const std::string&) { return std::string{}; }));
  if (std::filesystem::exists("/dev/full")) {
    const auto full = rosin::write_file("/dev/full", rosin::overwrite::allow, [](std::ostream& out) { out << "hello"; });
    REQUIRE(full);
    CHECK(full->message == "/dev/full: cannot be written: No space left on device");
  }
}

TEST_CASE("standard output by its names") {
  CHECK(rosin::is_standard_output("/dev/stdout"));
  CHECK(rosin::is_standard_output("/dev/fd/1"));
  CHECK_FALSE(rosin::is_standard_output("/dev/fd/2"));
  CHECK_FALSE(rosin::is_standard_output("stdout"));
}

TEST_CASE("whoever might read a file may read what replaces it") {
  const test::temporary_folder folder;
  folder.write("a", "old");
  std::filesystem::permissions(folder / "a", std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  CHECK_FALSE(rosin::write_file(folder / "a", rosin::overwrite::allow, [](std::ostream& out) { out << "new"; }));
  CHECK(std::filesystem::status(folder / "a").permissions() ==
        (std::filesystem::perms::owner_read | std::filesystem::perms::owner_write));
}

TEST_CASE("what cannot be written says why, and leaves nothing") {
  const test::temporary_folder folder;
  std::filesystem::create_directory(folder / "a.part");
  const auto why = rosin::write_file(folder / "a", rosin::overwrite::allow, [](std::ostream& out) { out << "new"; });
  REQUIRE(why);
  CHECK(why->message == folder / "a" + ": cannot be written: Is a directory");
}

TEST_CASE("numbers in a file do not depend on the locale of the program") {
  const test::comma_locale german;
  const test::temporary_folder folder;
  CHECK_FALSE(rosin::write_file(folder / "a", rosin::overwrite::allow, [](std::ostream& out) { out << 12345 << ' ' << 0.5; }));
  CHECK(folder.read("a") == "12345 0.5");
}

}  // namespace report_output_file
