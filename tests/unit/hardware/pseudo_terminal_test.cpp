// SPDX-License-Identifier: MIT
#include <rosin/hardware/pseudo_terminal.hpp>

#include <doctest/doctest.h>

TEST_CASE("every byte passes unchanged, both ways, and the other side is told when the device is gone") {
  auto pair = rosin::pseudo_terminal::open();
  REQUIRE(pair);
  const auto host = rosin::byte_link::open(pair->path(), 921600);
  REQUIRE(host);
  std::string all;
  for (int i = 0; i < 256; ++i) all.push_back(static_cast<char>(i));
  for (const auto& [from, to] : {std::pair{&pair->device(), &*host}, std::pair{&*host, &pair->device()}}) {
    REQUIRE_FALSE(from->write(all));
    std::string got;
    std::array<std::uint8_t, 64> bytes{};
    while (got.size() < 256) {
      const auto part = to->read(bytes, std::chrono::seconds{1});
      REQUIRE(part.bytes > 0);
      got.append(reinterpret_cast<const char*>(bytes.data()), part.bytes);
    }
    CHECK(got == all);
  }
  std::array<std::uint8_t, 8> bytes{};
  CHECK(host->read(bytes, std::chrono::milliseconds{5}).bytes == 0);
  { const auto gone = *std::move(pair); }
  const auto after = host->read(bytes, std::chrono::milliseconds{500});
  CHECK(after.gone);
  CHECK(after.problem.find("the device is gone") != std::string::npos);
}
