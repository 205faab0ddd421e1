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

namespace rosin {

/// A FrameSource.
class sndfile_source {
public:
  [[nodiscard]] static outcome<sndfile_source> open(const std::string& path) {
    SF_INFO info{};
    auto file = detail::open_audio(path, info);
    if (!file) return failure{file.error()};
    return sndfile_source{*std::move(file), info, path, -1};
  }
  /// A pipe that is open already, as descriptor 0. `bare`: no header, little-endian samples in this format.
  [[nodiscard]] static outcome<sndfile_source> open_pipe(int fd, const std::optional<frame_format>& bare = std::nullopt) {
    const std::string name = fd == 0 ? "standard input" : "descriptor " + std::to_string(fd);
    SF_INFO info{};
    if (bare) {
      const int bits = bare->bits > 24 ? SF_FORMAT_PCM_32 : bare->bits > 16 ? SF_FORMAT_PCM_24 : SF_FORMAT_PCM_16;
      info.format = SF_FORMAT_RAW | SF_ENDIAN_LITTLE | (bare->float_format ? SF_FORMAT_FLOAT : bits);
      info.channels = bare->channels;
      info.samplerate = static_cast<int>(std::lround(bare->sample_rate_Hz));
    }
    detail::sndfile_handle file{sf_open_fd(fd, SFM_READ, &info, 0)};
    if (!file) return failure{name + ": " + sf_strerror(nullptr)};
    info.frames = std::max<sf_count_t>(1, info.frames);  // a pipe does not know
    if (const auto why = detail::format_problem(info); !why.empty()) return failure{name + ": " + why};
    return sndfile_source{std::move(file), info, name, fd};
  }

  [[nodiscard]] frame_format format() const noexcept { return format_; }

  [[nodiscard]] frame_read read(std::span<double> interleaved, std::chrono::milliseconds patience) {
    if (fd_ >= 0) {
      pollfd wait{fd_, POLLIN, 0};
      if (::poll(&wait, 1, static_cast<int>(patience.count())) <= 0) return {};
    }
    const auto wanted = static_cast<sf_count_t>(interleaved.size() / static_cast<std::size_t>(format_.channels));
    const sf_count_t got = sf_readf_double(file_.get(), interleaved.data(), wanted);
    frame_read out{static_cast<std::size_t>(std::max<sf_count_t>(0, got)), 0, got < wanted, {}};
    if (const int error = sf_error(file_.get()); error != SF_ERR_NO_ERROR) out.problem = name_ + ": " + sf_error_number(error);
    given_ += got;
    if (out.ended && fd_ < 0 && given_ < promised_)
      out.problem =
          name_ + ": damaged: " + std::to_string(promised_) + " frames promised, " + std::to_string(given_) + " could be read";
    return out;
  }

private:
  sndfile_source(detail::sndfile_handle file, const SF_INFO& info, std::string name, int fd)
      : file_{std::move(file)}, name_{std::move(name)}, fd_{fd}, promised_{info.frames == SF_COUNT_MAX ? 0 : info.frames} {
    const int bits = detail::sample_bits(info.format);
    format_ = {static_cast<double>(info.samplerate), info.channels, std::abs(bits), bits < 0, false};
  }

  detail::sndfile_handle file_;
  std::string name_;
  int fd_;
  sf_count_t promised_, given_ = 0;
  frame_format format_;
};

static_assert(FrameSource<sndfile_source>);

}  // namespace rosin
