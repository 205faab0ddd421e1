// SPDX-License-Identifier: MIT
#include <rosin/hardware/frame_packet.hpp>

#include <doctest/doctest.h>

TEST_CASE("a packet byte by byte as the header's table says") {
  rosin::packet_encoder<128> encoder{{.stream = 7, .channels = 2, .bits = 16, .rate_mHz = 128000000}, 0x01020304};
  const std::array<std::int32_t, 4> samples{1, -2, 0x1234, -32768};
  const std::size_t size = encoder.encode(samples.data(), 2);
  REQUIRE(size == 14 + 8 + 4 + 1 + 1);
  CHECK(encoder.data()[size - 1] == 0);
  std::array<std::uint8_t, 128> plain{};
  for (std::size_t i = 0; i + 1 < size; ++i) {
    plain[i] = encoder.data()[i];
    CHECK(plain[i] != 0);
  }
  REQUIRE(rosin::cobs_decode(plain.data(), size - 1) == 26);
  const std::array<std::uint8_t, 22> expected{'R', 7, 2, 16, 2, 0,    0x00, 0x20, 0xa1, 0x07, 4,
                                              3,   2, 1, 1,  0, 0xfe, 0xff, 0x34, 0x12, 0x00, 0x80};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CAPTURE(i);
    CHECK(plain[i] == expected[i]);
  }
  std::uint32_t check = 0;
  for (std::size_t i = 0; i < 4; ++i) check |= std::uint32_t{plain[22 + i]} << (8 * i);
  CHECK(check == rosin::crc32(plain.data(), 22));
}

TEST_CASE("what does not fit is not sent, and its frames are counted") {
  rosin::packet_encoder<40> encoder{{.stream = 1, .channels = 2, .bits = 32, .rate_mHz = 1000}};
  const std::array<std::int32_t, 20> samples{};
  CHECK(encoder.encode(samples.data(), 10) == 0);
  REQUIRE(encoder.encode(samples.data(), 1) > 0);
  std::array<std::uint8_t, 40> plain{};
  for (std::size_t i = 0; i < 40; ++i) plain[i] = encoder.data()[i];
  REQUIRE(rosin::cobs_decode(plain.data(), 27) > 14);
  CHECK(plain[10] == 10);
}
