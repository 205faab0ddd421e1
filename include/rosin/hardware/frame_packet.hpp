// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Frames on a serial line, as a microcontroller sends them. A packet tells all that is needed to read it, so the computer may
// join at any time; the number of its first frame tells whether, and how much, was lost before it, on the line or in the
// microcontroller. Little endian:
//
//     byte  0       'R'
//           1       stream: any number that changes when the device starts anew
//           2       channels            3    bits: 16, 24 or 32, two's complement
//           4 ..  5 frames              6 ..  9 sampling rate in mHz
//          10 .. 13 number of the first frame, modulo 2^32
//          14 ..    samples, frame by frame; then CRC-32 of all that stands before it
//
// sent COBS encoded (cobs.hpp), with a zero byte after it. The encoder needs neither heap nor library: it is meant for firmware.
// packet_decoder.hpp is its counterpart.
//
#pragma once

#include <rosin/hardware/cobs.hpp>
#include <rosin/hardware/crc32.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace rosin {

inline constexpr std::size_t packet_head_bytes = 14, packet_tail_bytes = 4;
inline constexpr std::uint8_t packet_mark = 0x52;  // 'R'

struct packet_format {
  std::uint8_t stream = 0, channels = 2, bits = 16;
  std::uint32_t rate_mHz = 0;
};

/// Bytes on the line for a packet of so many frames, with its zero.
[[nodiscard]] constexpr std::size_t packet_room(std::size_t frames, std::size_t channels, std::size_t bits) noexcept {
  return cobs_room(packet_head_bytes + frames * channels * (bits / 8) + packet_tail_bytes) + 1;
}

/// Encodes into its own memory of Room bytes.
template <std::size_t Room>
class packet_encoder {
public:
  constexpr explicit packet_encoder(const packet_format& format, std::uint32_t first_frame = 0) noexcept
      : format_{format}, next_frame_{first_frame} {}

  /// A packet of these frames (interleaved, right-aligned integers). The number of bytes at data(); 0: it does not fit, and
  /// its frames count as lost.
  constexpr std::size_t encode(const std::int32_t* interleaved, std::uint16_t frames) noexcept {
    const std::uint32_t first = next_frame_;
    next_frame_ += frames;
    if (packet_room(frames, format_.channels, format_.bits) > Room) return 0;
    cobs_writer out{bytes_.data()};
    std::uint32_t check = 0;
    const auto put = [&](std::uint32_t value, int count) {
      for (int i = 0; i < count; ++i) {
        const auto byte = static_cast<std::uint8_t>((value >> (8 * i)) & 0xffU);
        check = crc32(&byte, 1, check);
        out.put(byte);
      }
    };
    put(packet_mark, 1), put(format_.stream, 1), put(format_.channels, 1), put(format_.bits, 1);
    put(frames, 2), put(format_.rate_mHz, 4), put(first, 4);
    const std::size_t count = std::size_t{frames} * format_.channels;
    for (std::size_t i = 0; i < count; ++i) put(static_cast<std::uint32_t>(interleaved[i]), format_.bits / 8);
    put(check, 4);
    const std::size_t size = out.end();
    bytes_[size] = 0;
    return size + 1;
  }
  /// Frames that the converter gave and that could not be sent: the receiver has to know.
  constexpr void skip(std::uint32_t frames) noexcept { next_frame_ += frames; }

  [[nodiscard]] constexpr const std::uint8_t* data() const noexcept { return bytes_.data(); }

private:
  packet_format format_;
  std::uint32_t next_frame_;
  std::array<std::uint8_t, Room> bytes_{};
};

}  // namespace rosin
