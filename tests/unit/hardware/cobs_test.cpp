// SPDX-License-Identifier: MIT
#include <rosin/hardware/cobs.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace {

using bytes = std::vector<std::uint8_t>;

bytes encoded(const bytes& plain) {
  bytes out(rosin::cobs_room(plain.size()));
  rosin::cobs_writer writer{out.data()};
  for (const auto b : plain) writer.put(b);
  out.resize(writer.end());
  return out;
}
bytes counting(int from, int to) {
  bytes out;
  for (int i = from; i <= to; ++i) out.push_back(static_cast<std::uint8_t>(i));
  return out;
}

}  // namespace

TEST_CASE("the published examples") {
  CHECK(encoded({0}) == bytes{1, 1});
  CHECK(encoded({0, 0}) == bytes{1, 1, 1});
  CHECK(encoded({0, 0x11, 0}) == bytes{1, 2, 0x11, 1});
  CHECK(encoded({0x11, 0x22, 0, 0x33}) == bytes{3, 0x11, 0x22, 2, 0x33});
  CHECK(encoded({0x11, 0, 0, 0}) == bytes{2, 0x11, 1, 1, 1});
  bytes full = counting(1, 254), expected = full;
  expected.insert(expected.begin(), 255);
  CHECK(encoded(full) == expected);
  full.push_back(255);
  expected.insert(expected.end(), {2, 255});
  CHECK(encoded(full) == expected);
}

TEST_CASE("random bytes come back, hold no zero and fit the room; broken ones are refused or harmless") {
  std::mt19937 random{2};
  for (int trial = 0; trial < 3000; ++trial) {
    bytes plain(random() % 800);
    const unsigned zeros = random() % 3 == 0 ? 2 : 400;
    for (auto& b : plain) b = random() % zeros == 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(1 + random() % 255);
    bytes line = encoded(plain);
    REQUIRE(std::count(line.begin(), line.end(), 0) == 0);
    REQUIRE(line.size() <= rosin::cobs_room(plain.size()));
    bytes broken = line;
    line.resize(rosin::cobs_decode(line.data(), line.size()));
    REQUIRE(line == plain);
    if (broken.empty()) continue;
    broken[random() % broken.size()] = static_cast<std::uint8_t>(random());
    broken.resize(random() % (broken.size() + 1));
    REQUIRE(rosin::cobs_decode(broken.data(), broken.size()) <= broken.size());
  }
}
