// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the headers of a WAV file promise against what the file holds. libsndfile reads a truncated file without a word:
// it takes the samples that are there. A recording that lost its end has to be named, so the chunks are walked here.
//
//     "RIFF" size "WAVE" { id size bytes [pad] } ...     RF64: the chunk ds64 holds the 64-bit sizes
//
#pragma once

#include <array>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <string_view>

namespace rosin {

struct riff_layout {
  std::uint64_t file_bytes = 0;
  std::optional<std::uint64_t> data_offset;    ///< where the samples begin
  std::optional<std::uint64_t> data_promised;  ///< bytes of samples by the header; empty: a stream of unknown length
  bool format_chunk = false;

  [[nodiscard]] std::uint64_t data_present() const noexcept {
    return data_offset && file_bytes > *data_offset ? file_bytes - *data_offset : 0;
  }
};

namespace detail {

struct riff_cursor {
  std::istream* in;
  bool big_endian;

  [[nodiscard]] std::optional<std::string> tag() const {
    std::array<char, 4> bytes{};
    if (!in->read(bytes.data(), bytes.size())) return std::nullopt;
    return std::string{bytes.data(), bytes.size()};
  }
  [[nodiscard]] std::optional<std::uint64_t> number(std::size_t count) const {
    std::array<unsigned char, 8> bytes{};
    if (!in->read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count))) return std::nullopt;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t shift = 8 * (big_endian ? count - 1 - i : i);
      value |= std::uint64_t{bytes[i]} << shift;
    }
    return value;
  }
};

/// The data chunk: a size of all ones, or of nothing although bytes follow, stands for "until the end".
inline void note_data(riff_layout& out, std::uint64_t offset, std::uint64_t size, std::optional<std::uint64_t> ds64) {
  out.data_offset = offset;
  if (ds64 && size == 0xffffffffU) out.data_promised = ds64;
  else if (size != 0xffffffffU && !(size == 0 && out.file_bytes > offset + 8)) out.data_promised = size;
}

}  // namespace detail

/// The layout of a WAV or RF64 file; empty where the stream is neither.
[[nodiscard]] inline std::optional<riff_layout> read_riff_layout(std::istream& in) {
  riff_layout out;
  out.file_bytes = static_cast<std::uint64_t>(in.seekg(0, std::ios::end).tellg());
  in.seekg(0);
  detail::riff_cursor cursor{&in, false};
  const auto form = cursor.tag();
  if (!form || (*form != "RIFF" && *form != "RIFX" && *form != "RF64")) return std::nullopt;
  cursor.big_endian = *form == "RIFX";
  if (!cursor.number(4) || cursor.tag() != "WAVE") return std::nullopt;
  std::optional<std::uint64_t> ds64;
  for (std::uint64_t at = 12; at + 8 <= out.file_bytes && !out.data_offset;) {
    in.clear();
    in.seekg(static_cast<std::streamoff>(at));
    const auto id = cursor.tag();
    const auto size = cursor.number(4);
    if (!id || !size) break;
    if (*id == "ds64" && cursor.number(8)) ds64 = cursor.number(8);
    if (*id == "fmt ") out.format_chunk = true;
    if (*id == "data") detail::note_data(out, at + 8, *size, ds64);
    at += 8 + *size + *size % 2;
  }
  return out;
}

}  // namespace rosin
