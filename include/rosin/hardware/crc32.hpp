// tier: freestanding
// SPDX-License-Identifier: MIT
//
// CRC-32 as in Ethernet, zip and PNG (reflected polynomial 0xedb88320), four bits at a time: a table of 16 words instead of 256
// is what a microcontroller can spare. The checksum of "123456789" is 0xcbf43926.
//
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace rosin {

namespace detail {

inline constexpr std::array<std::uint32_t, 16> crc32_nibbles = [] {
  std::array<std::uint32_t, 16> table{};
  for (std::uint32_t i = 0; i < 16; ++i) {
    std::uint32_t c = i;
    for (int bit = 0; bit < 4; ++bit) c = (c & 1U) != 0 ? (c >> 1U) ^ 0xedb88320U : c >> 1U;
    table[i] = c;
  }
  return table;
}();

}  // namespace detail

/// Of `count` bytes; to go on with more of them, hand over what the first ones gave.
[[nodiscard]] constexpr std::uint32_t crc32(const std::uint8_t* bytes, std::size_t count, std::uint32_t before = 0) noexcept {
  std::uint32_t c = ~before;
  for (std::size_t i = 0; i < count; ++i) {
    c ^= bytes[i];
    c = detail::crc32_nibbles[c & 15U] ^ (c >> 4U);
    c = detail::crc32_nibbles[c & 15U] ^ (c >> 4U);
  }
  return ~c;
}

}  // namespace rosin
