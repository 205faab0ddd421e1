// SPDX-License-Identifier: MIT
#include <rosin/hardware/crc32.hpp>

#include <doctest/doctest.h>

#include <boost/crc.hpp>

#include <random>
#include <vector>

TEST_CASE("the check value of the standard, and Boost's CRC of random bytes, whole and in parts") {
  const std::array<std::uint8_t, 9> digits{'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  static_assert(rosin::crc32(std::array<std::uint8_t, 9>{'1', '2', '3', '4', '5', '6', '7', '8', '9'}.data(), 9) == 0xcbf43926U);
  CHECK(rosin::crc32(digits.data(), 9) == 0xcbf43926U);
  std::mt19937 random{1};
  for (std::size_t size = 0; size < 300; size += 7) {
    std::vector<std::uint8_t> bytes(size);
    for (auto& b : bytes) b = static_cast<std::uint8_t>(random());
    boost::crc_32_type other;
    other.process_bytes(bytes.data(), size);
    CHECK(rosin::crc32(bytes.data(), size) == other.checksum());
    CHECK(rosin::crc32(bytes.data() + size / 3, size - size / 3, rosin::crc32(bytes.data(), size / 3)) == other.checksum());
  }
}
