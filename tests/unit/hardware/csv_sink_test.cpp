// SPDX-License-Identifier: MIT
#include <rosin/hardware/csv_sink.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

#include <csignal>

TEST_CASE("rows with their time, unknown values empty, at once in the file") {
  const test::temporary_folder folder;
  auto sink = rosin::csv_sink::create(folder / "a.csv", 1000, {"force_N", "velocity_m_s"});
  REQUIRE(sink.has_value());
  REQUIRE_FALSE(sink->write(std::vector<double>{0.5, -0.25, std::nan(""), 1e-9}));
  CHECK(folder.read("a.csv") == "time_s,force_N,velocity_m_s\n0,0.5,-0.25\n0.001,,1e-09\n");
  REQUIRE_FALSE(sink->write(std::vector<double>{1.0 / 3, 2}));
  REQUIRE_FALSE(sink->finish());
  CHECK(folder.read("a.csv").ends_with("\n0.002,0.3333333,2\n"));
}

TEST_CASE("a pipe that nobody reads any more, and a folder that is not there, are reasons") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  rosin::csv_sink sink{rosin::byte_link{ends[1], "out"}, 1000, {"x"}};
  ::close(ends[0]);
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  const auto why = sink.write(std::vector<double>{1});
  std::signal(SIGPIPE, before);
  REQUIRE(why);
  CHECK(why->message == "out: Broken pipe");
  CHECK_FALSE(rosin::csv_sink::create("/nowhere/a.csv", 1, {"x"}).has_value());
}
