// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the head of a WAV file says, against what the file holds. Programs that write into a pipe cannot know a length, others
// never come back to write it, and a recording may have lost its end: all of them look alike to a library that takes what is
// there. So the chunks are walked here:
//
//     "RIFF" size "WAVE" { id size bytes [pad] } ...     RF64, BW64: the chunk ds64 holds the sizes, in 64 bits
//
// A size of samples stands for "until the end" where it is all ones, nothing although no chunk follows, or one of those near 2^31
// and 2^32 that writers of streams put there, and the file is shorter.
//
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <istream>
#include <optional>
#include <string>
#include <string_view>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct riff_layout {
  bool big_endian = false;
  std::uint64_t end = 0;                       ///< of the file, or of what the head calls it where that tells more
  std::string format;                          ///< what the chunk "fmt " holds; empty: there is none
  std::optional<std::uint64_t> data_offset;    ///< where the samples begin
  std::optional<std::uint64_t> data_promised;  ///< bytes of samples by the header; empty: a stream of unknown length
  std::optional<std::uint64_t> second_data;    ///< where another chunk of samples begins

  [[nodiscard]] std::uint64_t data_present() const noexcept { return data_offset && end > *data_offset ? end - *data_offset : 0; }
  /// A number of `bytes` bytes in the chunk "fmt ", which is that long.
  [[nodiscard]] std::uint32_t format_number(std::size_t at, std::size_t bytes) const noexcept {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
      value |= std::uint32_t{static_cast<unsigned char>(format[at + i])} << 8 * (big_endian ? bytes - 1 - i : i);
    return value;
  }
};

/// whole: nothing follows. beginning: of a stream; the samples are not looked for at any end.
enum class riff_extent { whole, beginning };

namespace detail {

/// Chunks of a file, one after the other.
struct riff_cursor {
  std::istream* in;
  std::uint64_t end;
  bool big_endian = false;

  [[nodiscard]] std::string bytes(std::uint64_t at, std::size_t count) const {
    std::string out(count, '\0');
    in->clear();
    in->seekg(static_cast<std::streamoff>(at));
    in->read(out.data(), static_cast<std::streamsize>(count));
    out.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in->gcount())));
    return out;
  }
  [[nodiscard]] std::optional<std::uint64_t> number(std::uint64_t at, std::size_t count) const {
    const std::string text = bytes(at, count);
    if (text.size() < count) return std::nullopt;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i)
      value |= std::uint64_t{static_cast<unsigned char>(text[i])} << 8 * (big_endian ? count - 1 - i : i);
    return value;
  }
  [[nodiscard]] static bool is_name(std::string_view id) noexcept {
    return id.size() == 4 && std::all_of(id.begin(), id.end(), [](char c) { return c >= ' ' && c <= '~'; });
  }
  [[nodiscard]] static bool is_usual(std::string_view id) noexcept {
    constexpr std::array<std::string_view, 12> usual{"data", "fmt ", "fact", "PEAK", "LIST", "JUNK",
                                                     "junk", "bext", "iXML", "cue ", "id3 ", "ID3 "};
    return std::find(usual.begin(), usual.end(), id) != usual.end();
  }
  /// Where the chunk after this one begins. Some writers forget the pad after an odd one.
  [[nodiscard]] std::uint64_t next(std::uint64_t at, std::uint64_t size) const {
    const std::uint64_t here = at + 8 + size;
    if (size % 2 == 0) return here;
    const std::string both = bytes(here, 5), unpadded = both.substr(0, 4), padded = both.size() == 5 ? both.substr(1) : "";
    if (is_usual(padded)) return here + 1;
    return is_usual(unpadded) || (is_name(unpadded) && !is_name(padded)) ? here : here + 1;
  }
  /// Nothing but chunks from here to the end.
  [[nodiscard]] bool chunks_follow(std::uint64_t at) const {
    while (at + 8 <= end && is_name(bytes(at, 4))) at = next(at, number(at + 4, 4).value_or(0));
    return at == end || at == end + 1;
  }
};

/// Sizes that stand for none: all ones, and less than a mebibyte from 2^31 or 2^32.
[[nodiscard]] constexpr bool is_no_size(std::uint64_t size) noexcept {
  constexpr std::uint64_t about = 1U << 20U, half = 1ULL << 31U, full = 1ULL << 32U;
  return (size > half - about && size < half + about) || (size > full - about && size < full) || size >= 1ULL << 62U;
}

struct riff_sizes {
  std::uint64_t riff = 0, data = 0;  ///< of 64 bits where there is a ds64; 0: not told
};

inline void note_data(riff_layout& out, const riff_cursor& cursor, std::uint64_t offset, std::uint64_t size,
                      const riff_sizes& wide, riff_extent extent) {
  out.data_offset = offset;
  if ((size == 0xffffffffU || size == 0) && wide.data > 0) size = wide.data;
  const bool whole = extent == riff_extent::whole;
  const bool none = size == 0 ? !whole || (out.end > offset + 8 && !cursor.chunks_follow(offset))
                              : is_no_size(size) && !(whole && size <= out.data_present());
  if (!none) out.data_promised = size;
  if (none && wide.riff > offset && wide.riff + 8 < out.end) out.end = wide.riff + 8;
}

}  // namespace detail

/// The layout of a WAV, RF64 or BW64 file; empty where the stream is none of them.
[[nodiscard]] inline std::optional<riff_layout> read_riff_layout(std::istream& in, riff_extent extent = riff_extent::whole) {
  riff_layout out;
  in.clear();
  out.end = static_cast<std::uint64_t>(std::max<std::streamoff>(0, in.seekg(0, std::ios::end).tellg()));
  detail::riff_cursor cursor{&in, out.end};
  const std::string form = cursor.bytes(0, 4);
  if (form != "RIFF" && form != "RIFX" && form != "RF64" && form != "BW64") return std::nullopt;
  out.big_endian = cursor.big_endian = form == "RIFX";
  if (cursor.bytes(8, 4) != "WAVE") return std::nullopt;
  detail::riff_sizes wide{cursor.number(4, 4).value_or(0), 0};
  for (std::uint64_t at = 12; at + 8 <= cursor.end;) {
    const std::string id = cursor.bytes(at, 4);
    const std::uint64_t size = cursor.number(at + 4, 4).value_or(0);
    if (out.data_offset && !cursor.is_name(id)) break;
    if (id == "ds64") wide = {cursor.number(at + 8, 8).value_or(0), cursor.number(at + 16, 8).value_or(0)};
    if (id == "fmt " && out.format.empty()) out.format = cursor.bytes(at + 8, std::min<std::size_t>(size, 1024));
    if (id == "data" && out.data_offset) return out.second_data = at, out;
    if (id == "data") {
      detail::note_data(out, cursor, at + 8, size, wide, extent);
      if (extent == riff_extent::beginning || !out.data_promised) break;
    }
    at = cursor.next(at, id == "data" ? *out.data_promised : size);
  }
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
