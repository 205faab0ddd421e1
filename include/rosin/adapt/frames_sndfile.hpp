// tier: hosted
// SPDX-License-Identifier: MIT
//
// Frames out of files and out of a pipe, through libsndfile: WAV, RF64, FLAC, ...; from standard input also bare samples, whose
// rate and width then have to be said. A source that waits: nothing is lost if nobody asks.
//
#pragma once

#include <rosin/adapt/audio_sndfile.hpp>
#include <rosin/hardware/frames.hpp>

#include <poll.h>

#include <cerrno>
#include <sstream>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// A stream that begins with a head of its own: the layout as soon as its samples begin, or why there is none.
[[nodiscard]] inline outcome<std::optional<riff_layout>> read_stream_layout(pipe_bytes& from) {
  for (std::size_t wanted = 12; wanted <= pipe_bytes::most_; wanted += 64) {
    const std::string& first = from.first(wanted);
    std::istringstream in{first};
    auto layout = read_riff_layout(in, riff_extent::beginning);
    if (!layout && first.size() >= 12) return std::optional<riff_layout>{};
    if (layout && layout->data_offset) return layout;
    if (first.size() < wanted) return failure{first.empty() ? "nothing came" : "ended before its samples began"};
  }
  return failure{"no samples begin in its first " + std::to_string(pipe_bytes::most_) + " bytes"};
}

}  // namespace detail

/// A FrameSource.
class sndfile_source {
public:
  [[nodiscard]] static outcome<sndfile_source> open(const std::string& path) {
    auto opened = detail::open_audio(path);
    if (!opened) return failure{opened.error()};
    return sndfile_source{*std::move(opened), path, -1};
  }
  /// A pipe that is open already, as descriptor 0. `bare`: no header, little-endian samples in this format.
  [[nodiscard]] static outcome<sndfile_source> open_pipe(int fd, const std::optional<frame_format>& bare = std::nullopt) {
    const std::string name = fd == 0 ? "standard input" : "descriptor " + std::to_string(fd);
    auto opened = bare ? open_bare(fd, *bare) : open_stream(fd);
    if (!opened) return failure{name + ": " + opened.error()};
    if (!opened->file) return failure{detail::unreadable(name)};
    if (opened->info.frames <= 0) opened->info.frames = SF_COUNT_MAX;  // a pipe does not know
    if (const auto why = detail::format_problem(opened->info); !why.empty()) return failure{name + ": " + why};
    return sndfile_source{*std::move(opened), name, fd};
  }

  [[nodiscard]] frame_format format() const noexcept { return format_; }

  [[nodiscard]] frame_read read(std::span<double> interleaved, std::chrono::milliseconds patience) {
    if (fd_ >= 0 && (!from_.shown || from_.shown->waits())) {
      pollfd wait{fd_, POLLIN, 0};
      if (::poll(&wait, 1, static_cast<int>(patience.count())) <= 0) return {};
    }
    const auto wanted = static_cast<sf_count_t>(interleaved.size() / static_cast<std::size_t>(format_.channels));
    const sf_count_t got = sf_readf_double(from_.file.get(), interleaved.data(), wanted);
    frame_read out{static_cast<std::size_t>(std::max<sf_count_t>(0, got)), 0, got < wanted, {}};
    if (const int error = sf_error(from_.file.get()); error != SF_ERR_NO_ERROR)
      out.problem = name_ + ": " + sf_error_number(error);
    given_ += got;
    if (out.ended && from_.length_told && given_ < from_.info.frames)
      out.problem = name_ + ": ended early or is damaged: " + std::to_string(from_.info.frames) + " frames promised, " +
                    std::to_string(given_) + " could be read";
    return out;
  }

private:
  sndfile_source(detail::opened_audio from, std::string name, int fd) : from_{std::move(from)}, name_{std::move(name)}, fd_{fd} {
    const int bits = detail::sample_bits(from_.info.format);
    format_ = {static_cast<double>(from_.info.samplerate), from_.info.channels, std::abs(bits), bits < 0, false};
    from_.length_told = from_.length_told && from_.info.frames < sf_count_t{1} << 50;  // all that is endless is more
  }
  /// A WAV file or anything else that can be read from its beginning to its end.
  [[nodiscard]] static outcome<detail::opened_audio> open_stream(int fd) {
    constexpr std::uint64_t endless = 1ULL << 60U;
    auto bytes = std::make_unique<detail::pipe_bytes>(fd);
    const auto layout = detail::read_stream_layout(*bytes);
    if (!layout) return failure{layout.error()};
    detail::opened_audio out;
    if (*layout) {
      const riff_layout& is = **layout;
      if (const auto why = detail::format_chunk_problem(is); !why.empty()) return failure{why};
      const std::uint64_t size = is.data_promised.value_or(endless);
      out.shown = std::make_unique<detail::shown_wav>(std::move(bytes), detail::plain_wav_head(is, size), *is.data_offset, size);
    } else {
      out.shown = std::make_unique<detail::shown_wav>(std::move(bytes), std::string{}, 0, endless);
    }
    out.file = out.shown->open(out.info);
    return out;
  }
  [[nodiscard]] static outcome<detail::opened_audio> open_bare(int fd, const frame_format& bare) {
    detail::opened_audio out;
    const int bits = bare.bits > 24 ? SF_FORMAT_PCM_32 : bare.bits > 16 ? SF_FORMAT_PCM_24 : SF_FORMAT_PCM_16;
    out.info.format = SF_FORMAT_RAW | SF_ENDIAN_LITTLE | (bare.float_format ? SF_FORMAT_FLOAT : bits);
    out.info.channels = bare.channels;
    out.info.samplerate = static_cast<int>(std::lround(bare.sample_rate_Hz));
    out.file = detail::sndfile_handle{sf_open_fd(fd, SFM_READ, &out.info, 0)};
    return out;
  }

  detail::opened_audio from_;
  std::string name_;
  int fd_;
  sf_count_t given_ = 0;
  frame_format format_;
};

static_assert(FrameSource<sndfile_source>);

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
