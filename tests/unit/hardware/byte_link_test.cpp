// SPDX-License-Identifier: MIT
#include <rosin/hardware/byte_link.hpp>

#include <doctest/doctest.h>

#include <rosin/hardware/pseudo_terminal.hpp>

#include <support/temporary_folder.hpp>

#include <thread>

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

TEST_CASE("a reader that takes a little now and then does not put the end off; a descriptor that blocks does not block") {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  const rosin::byte_link in{ends[0], "in"}, out{ends[1], "out"};
  std::jthread slow{[&](const std::stop_token& stop) {
    std::array<std::uint8_t, 4096> some{};
    while (!stop.stop_requested()) {
      (void)in.read(some, std::chrono::milliseconds{1});
      std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
  }};
  const auto begin = std::chrono::steady_clock::now();
  REQUIRE(out.write(std::string(1 << 24, 'x'), std::chrono::milliseconds{200}));
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::milliseconds{900});
  std::atomic<bool> stop{true};
  CHECK(out.write(std::string(1 << 24, 'x'), rosin::deadline{std::chrono::seconds{60}, &stop}));
}

TEST_CASE("a serial line has one user") {
  auto pair = rosin::pseudo_terminal::open();
  REQUIRE(pair);
  auto first = rosin::byte_link::open(pair->path(), 115200);
  REQUIRE(first);
  const auto second = rosin::byte_link::open(pair->path(), 115200);
  REQUIRE_FALSE(second);
  CHECK(second.error().find("is in use already") != std::string::npos);
  { const auto gone = *std::move(first); }
  CHECK(rosin::byte_link::open(pair->path(), 115200));
}
