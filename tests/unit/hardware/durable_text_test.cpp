// SPDX-License-Identifier: MIT
#include <rosin/hardware/durable_text.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

#include <sys/wait.h>
#include <csignal>

TEST_CASE("the text is there, whole, and nothing else is left; what cannot be written is named") {
  const test::temporary_folder folder;
  REQUIRE_FALSE(rosin::replace_durably(folder / "a", "one"));
  REQUIRE_FALSE(rosin::replace_durably(folder / "a", "two"));
  CHECK(folder.read("a") == "two");
  CHECK_FALSE(std::filesystem::exists(folder / "a.part"));
  const auto why = rosin::replace_durably(folder / "none/a", "x");
  REQUIRE(why);
  CHECK(why->message.find("none/a: No such file") != std::string::npos);
}

TEST_CASE("killed while it is being replaced again and again: one of the texts is there, never a part") {
  const test::temporary_folder folder;
  const std::string one(30000, '1'), two(50000, '2');
  REQUIRE_FALSE(rosin::replace_durably(folder / "a", one));
  for (int trial = 0; trial < 5; ++trial) {
    const pid_t child = ::fork();
    if (child == 0)
      for (bool first = true;; first = !first)
        if (rosin::replace_durably(folder / "a", first ? two : one)) ::_exit(1);
    ::usleep(static_cast<useconds_t>(3000 + 2311 * trial));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const std::string text = folder.read("a");
    CHECK((text == one || text == two));
  }
}
