// SPDX-License-Identifier: MIT
#include <rosin/hardware/byte_link.hpp>

#include <doctest/doctest.h>

#include <support/temporary_folder.hpp>

TEST_CASE("what cannot be opened is named, with the reason") {
  const auto none = rosin::byte_link::open("/nowhere/tty", 115200);
  REQUIRE_FALSE(none);
  CHECK(none.error() == "/nowhere/tty: No such file or directory");
}

TEST_CASE("a pipe: bytes in order, patience, and its end") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  rosin::byte_link in{ends[0], "in"};
  std::array<std::uint8_t, 8> bytes{};
  {
    rosin::byte_link out{ends[1], "out"};
    const auto before = std::chrono::steady_clock::now();
    CHECK(in.read(bytes, std::chrono::milliseconds{30}).bytes == 0);
    CHECK(std::chrono::steady_clock::now() - before >= std::chrono::milliseconds{29});
    REQUIRE_FALSE(out.write("abc"));
    CHECK(in.read(bytes, std::chrono::milliseconds{30}).bytes == 3);
    CHECK(bytes[2] == 'c');
  }
  CHECK(in.read(bytes, std::chrono::milliseconds{30}).gone);
}

TEST_CASE("a reader that takes nothing is not waited for without end") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  REQUIRE(::fcntl(ends[1], F_SETFL, O_NONBLOCK) == 0);
  const rosin::byte_link in{ends[0], "in"}, out{ends[1], "out"};
  const auto why = out.write(std::string(1 << 20, 'x'), std::chrono::milliseconds{30});
  REQUIRE(why);
  CHECK(why->message == "out: takes no bytes");
}
