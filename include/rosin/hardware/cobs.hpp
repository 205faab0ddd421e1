// tier: freestanding
// SPDX-License-Identifier: MIT
//
// Consistent overhead byte stuffing (Cheshire & Baker 1999): bytes without any zero, so that a zero can mark where a packet
// ends. Whoever joins in the middle, or has lost some bytes, is in step again at the next zero. It costs one byte in 254.
//
//     11 00 00 22  -->  02 11 01 02 22        each code byte: how far it is to the next zero
//
#pragma once

#include <cstddef>
#include <cstdint>

namespace rosin {

/// Room that an encoded packet may need, without the zero at its end.
[[nodiscard]] constexpr std::size_t cobs_room(std::size_t count) noexcept { return count + count / 254 + 1; }

/// Writes byte for byte into memory of at least cobs_room(all bytes): begin() once, put() each byte, end().
class cobs_writer {
public:
  constexpr explicit cobs_writer(std::uint8_t* out) noexcept : out_{out} {}

  constexpr void put(std::uint8_t byte) noexcept {
    if (byte != 0) {
      out_[at_++] = byte;
      if (at_ - code_ < 255) return;
    }
    close_run();
  }
  /// Number of bytes written.
  constexpr std::size_t end() noexcept {
    if (code_ + 1 == at_ && full_) return code_;  // the last byte filled a run of 254: nothing is open
    out_[code_] = static_cast<std::uint8_t>(at_ - code_);
    return at_;
  }

private:
  constexpr void close_run() noexcept {
    full_ = at_ - code_ == 255;
    out_[code_] = static_cast<std::uint8_t>(at_ - code_);
    code_ = at_++;
  }

  std::uint8_t* out_;
  std::size_t code_ = 0, at_ = 1;
  bool full_ = false;
};

/// Decodes in place; the number of bytes, or 0 where it is no encoded packet (a zero inside, a run beyond the end).
[[nodiscard]] constexpr std::size_t cobs_decode(std::uint8_t* bytes, std::size_t count) noexcept {
  std::size_t to = 0;
  for (std::size_t at = 0; at < count;) {
    const std::size_t run = bytes[at++];
    if (run == 0 || at + run - 1 > count) return 0;
    for (std::size_t i = 1; i < run; ++i) {
      if (bytes[at] == 0) return 0;
      bytes[to++] = bytes[at++];
    }
    if (run < 255 && at < count) bytes[to++] = 0;
  }
  return to;
}

}  // namespace rosin
