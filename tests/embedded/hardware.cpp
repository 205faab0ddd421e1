// SPDX-License-Identifier: MIT
#include <rosin/hardware/cobs.hpp>
#include <rosin/hardware/crc32.hpp>
#include <rosin/hardware/frame_packet.hpp>

extern "C" std::size_t rosin_send_frames(const std::int32_t* interleaved, std::uint16_t frames,
                                         const std::uint8_t** bytes) noexcept {
  static rosin::packet_encoder<rosin::packet_room(64, 2, 24)> encoder{
      {.stream = 1, .channels = 2, .bits = 24, .rate_mHz = 128000000}};
  const std::size_t size = encoder.encode(interleaved, frames);
  *bytes = encoder.data();
  return size;
}
extern "C" std::size_t rosin_receive_bytes(std::uint8_t* bytes, std::size_t count) noexcept {
  return rosin::cobs_decode(bytes, count);
}
