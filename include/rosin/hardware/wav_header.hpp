// tier: hosted
// SPDX-License-Identifier: MIT
//
// The head of a WAV file that is still being written, always of one length. While the recording runs both sizes are all ones,
// which stands for "until the end of the file": so the head never has to be touched, is never wrong, and whatever the disk
// holds when the power fails is a readable file. At the end it is replaced by one with the true sizes; beyond 4 GB that is an
// RF64 head (EBU Tech 3306), for which a JUNK chunk keeps the room.
//
//     RIFF|RF64 size WAVE   JUNK|ds64 28 ...   fmt  40 (extensible) ...   data size
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/hardware/frames.hpp>

#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

namespace rosin {

inline constexpr std::size_t wav_head_bytes = 12 + 36 + 48 + 8;
using wav_head = std::array<std::uint8_t, wav_head_bytes>;

/// Bytes of a sample in the file.
[[nodiscard]] constexpr std::size_t sample_bytes(const frame_format& f) noexcept {
  return f.float_format || f.bits > 24 ? 4 : f.bits > 16 ? 3 : 2;
}

namespace detail {

struct byte_cursor {
  std::uint8_t* at;

  void text(std::string_view letters) noexcept {
    for (const char c : letters) *at++ = static_cast<std::uint8_t>(c);
  }
  void number(std::uint64_t value, int bytes) noexcept {
    for (int i = 0; i < bytes; ++i) *at++ = static_cast<std::uint8_t>((value >> (8 * i)) & 0xffU);
  }
};

inline void put_format(byte_cursor& out, const frame_format& f) noexcept {
  const auto bytes = sample_bytes(f), width = static_cast<std::size_t>(f.channels);
  const auto rate = static_cast<std::uint64_t>(std::llround(f.sample_rate_Hz));
  out.text("fmt ");
  out.number(40, 4);
  out.number(0xfffe, 2);  // extensible: more than two channels or 16 bits
  out.number(width, 2);
  out.number(rate, 4);
  out.number(rate * bytes * width, 4);
  out.number(bytes * width, 2);
  out.number(8 * bytes, 2);
  out.number(22, 2);
  out.number(8 * bytes, 2);
  out.number(0, 4);  // the channels are no loudspeakers
  out.number(f.float_format ? 3 : 1, 2);
  for (const unsigned byte : {0x00U, 0x00U, 0x00U, 0x00U, 0x10U, 0x00U, 0x80U, 0x00U, 0x00U, 0xaaU, 0x00U, 0x38U, 0x9bU, 0x71U})
    out.number(byte, 1);
}

}  // namespace detail

/// data_bytes empty: still being written.
[[nodiscard]] inline wav_head make_wav_head(const frame_format& f, std::optional<std::uint64_t> data_bytes) noexcept {
  wav_head head{};
  detail::byte_cursor out{head.data()};
  constexpr std::uint64_t unknown = 0xffffffffU;
  const std::uint64_t riff = data_bytes ? *data_bytes + *data_bytes % 2 + wav_head_bytes - 8 : unknown;
  const bool large = data_bytes && riff >= unknown;
  out.text(large ? "RF64" : "RIFF");
  out.number(large ? unknown : riff, 4);
  out.text("WAVE");
  out.text(large ? "ds64" : "JUNK");
  out.number(28, 4);
  out.number(large ? riff : 0, 8);
  out.number(large ? *data_bytes : 0, 8);
  out.number(large ? *data_bytes / (sample_bytes(f) * static_cast<std::size_t>(f.channels)) : 0, 8);
  out.number(0, 4);
  detail::put_format(out, f);
  out.text("data");
  out.number(large || !data_bytes ? unknown : *data_bytes, 4);
  return head;
}

/// One sample as it stands in the file: the nearest step of the converter (clipped), or floating point.
inline void put_sample(std::uint8_t* to, double x, const frame_format& f) noexcept {
  detail::byte_cursor out{to};
  if (f.float_format) {
    const auto value = static_cast<float>(x);
    std::uint32_t bits = 0;
    static_assert(sizeof bits == sizeof value);
    std::memcpy(&bits, &value, sizeof bits);
    out.number(bits, 4);
    return;
  }
  const std::size_t bytes = sample_bytes(f);
  const double half = std::ldexp(1.0, static_cast<int>(8 * bytes) - 1);
  const double code = std::isnan(x) ? 0 : std::fmin(std::fmax(std::nearbyint(x * half), -half), half - 1);
  out.number(static_cast<std::uint64_t>(static_cast<std::int64_t>(code)), static_cast<int>(bytes));
}

}  // namespace rosin
