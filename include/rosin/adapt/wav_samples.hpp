// tier: hosted
// SPDX-License-Identifier: MIT
//
// What libsndfile is shown of a WAV file: a head with nothing in it but the format and a length that is right, and then the
// samples. It never sees the file's own head, so that no odd chunk, version or size in there can mislead it, and whatever keeps the
// samples from being read is said here, in words. A stream is shown the same way; it is as long as it turns out to be.
//
#pragma once

#include <rosin/adapt/riff_layout.hpp>
#include <rosin/core/outcome.hpp>

#include <sndfile.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <memory>

#include <rosin/core/macros_aside.ipp>

namespace rosin::detail {

struct close_sndfile {
  void operator()(SNDFILE* file) const noexcept { sf_close(file); }
};
using sndfile_handle = std::unique_ptr<SNDFILE, close_sndfile>;

/// Where bytes come from.
struct byte_source {
  virtual ~byte_source() = default;
  /// So many bytes from there on, fewer at the end only.
  virtual std::size_t read(std::uint64_t at, char* to, std::size_t count) = 0;
  /// What is there has to come first.
  [[nodiscard]] virtual bool waits(std::uint64_t) const noexcept { return false; }
};

class file_bytes final : public byte_source {
public:
  explicit file_bytes(const std::string& path) : in_{path, std::ios::binary} {}
  std::size_t read(std::uint64_t at, char* to, std::size_t count) override {
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(at));
    in_.read(to, static_cast<std::streamsize>(count));
    return static_cast<std::size_t>(std::max<std::streamsize>(0, in_.gcount()));
  }
  [[nodiscard]] std::istream& stream() noexcept { return in_; }

private:
  std::ifstream in_;
};

/// A pipe: its first bytes can be read again, the rest once.
class pipe_bytes final : public byte_source {
public:
  explicit pipe_bytes(int fd) : fd_{fd} {}
  std::size_t read(std::uint64_t at, char* to, std::size_t count) override {
    std::size_t done = 0;
    if (at < first_.size()) done = first_.copy(to, count, static_cast<std::size_t>(at));
    if (at + done != given_) return done;
    const std::size_t from_pipe = fetch(to + done, count - done);
    if (first_.size() == given_ && given_ < most_) first_.append(to + done, from_pipe);
    given_ += from_pipe;
    return done + from_pipe;
  }
  /// The first bytes, so many of them at least if they come.
  [[nodiscard]] const std::string& first(std::size_t least) {
    std::string more(least > first_.size() ? least - first_.size() : 0, '\0');
    if (!more.empty()) (void)read(given_, more.data(), more.size());
    return first_;
  }
  [[nodiscard]] bool waits(std::uint64_t at) const noexcept override { return at >= first_.size(); }
  static constexpr std::size_t most_ = 1U << 20U;

private:
  [[nodiscard]] std::size_t fetch(char* to, std::size_t count) const {
    std::size_t done = 0;
    while (done < count) {
      const ssize_t got = ::read(fd_, to + done, count - done);
      if (got > 0) done += static_cast<std::size_t>(got);
      else if (got == 0 || errno != EINTR) break;
    }
    return done;
  }
  int fd_;
  std::string first_;
  std::uint64_t given_ = 0;
};

/// The shortest head there is. RF64 where the size asks for it; with the most significant byte first there is no such form.
[[nodiscard]] inline std::string plain_wav_head(const riff_layout& layout, std::uint64_t data_bytes) {
  if (layout.big_endian) data_bytes = std::min<std::uint64_t>(data_bytes, 0xf0000000U);
  const auto number = [&](std::uint64_t value, std::size_t bytes) {
    std::string out(bytes, '\0');
    for (std::size_t i = 0; i < bytes; ++i)
      out[layout.big_endian ? bytes - 1 - i : i] = static_cast<char>(i < 8 ? value >> 8 * i & 0xffU : 0U);
    return out;
  };
  constexpr std::uint64_t ones = 0xffffffffU;
  const std::string format =
      "fmt " + number(layout.format.size(), 4) + layout.format + std::string(layout.format.size() % 2, '\0');
  const std::uint64_t riff = 4 + 36 + format.size() + 8 + data_bytes + data_bytes % 2;
  if (riff < ones)
    return (layout.big_endian ? "RIFX" : "RIFF") + number(riff - 36, 4) + "WAVE" + format + "data" + number(data_bytes, 4);
  return "RF64" + number(ones, 4) + "WAVEds64" + number(28, 4) + number(riff, 8) + number(data_bytes, 8) + number(0, 12) +
         format + "data" + number(ones, 4);
}

/// A head of our own, then the samples, as libsndfile's virtual file.
class shown_wav {
public:
  shown_wav(std::unique_ptr<byte_source> from, std::string head, std::uint64_t offset, std::uint64_t bytes)
      : from_{std::move(from)}, head_{std::move(head)}, offset_{offset}, length_{head_.size() + bytes} {}

  [[nodiscard]] sndfile_handle open(SF_INFO& info) {
    SF_VIRTUAL_IO calls{[](void* self) { return static_cast<sf_count_t>(static_cast<shown_wav*>(self)->length_); },
                        [](sf_count_t by, int whence, void* self) { return static_cast<shown_wav*>(self)->seek(by, whence); },
                        [](void* to, sf_count_t count, void* self) {
                          return static_cast<shown_wav*>(self)->read(static_cast<char*>(to), static_cast<std::uint64_t>(count));
                        },
                        [](const void*, sf_count_t, void*) { return sf_count_t{0}; },
                        [](void* self) { return static_cast<sf_count_t>(static_cast<shown_wav*>(self)->at_); }};
    return sndfile_handle{sf_open_virtual(&calls, SFM_READ, &info, this)};
  }
  /// The next byte may have to be waited for.
  [[nodiscard]] bool waits() const noexcept {
    return from_->waits(offset_ + std::max<std::uint64_t>(at_, head_.size()) - head_.size());
  }

private:
  [[nodiscard]] sf_count_t seek(sf_count_t by, int whence) noexcept {
    const std::uint64_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? at_ : length_;
    return static_cast<sf_count_t>(at_ = from + static_cast<std::uint64_t>(by));
  }
  [[nodiscard]] sf_count_t read(char* to, std::uint64_t count) {
    count = std::min(count, length_ - std::min(length_, at_));
    std::size_t done = at_ < head_.size() ? head_.copy(to, static_cast<std::size_t>(count), static_cast<std::size_t>(at_)) : 0;
    if (done < count) done += from_->read(offset_ + at_ + done - head_.size(), to + done, static_cast<std::size_t>(count) - done);
    at_ += done;
    return static_cast<sf_count_t>(done);
  }
  std::unique_ptr<byte_source> from_;
  std::string head_;
  std::uint64_t offset_, length_, at_ = 0;
};

/// Why samples of this format cannot be read, in words; empty where they can, or libsndfile knows more about it.
[[nodiscard]] inline std::string format_chunk_problem(const riff_layout& layout) {
  if (layout.format.empty()) return "has no chunk \"fmt \": nobody can know what its samples are";
  if (layout.format.size() < 16)
    return "its chunk \"fmt \" is " + std::to_string(layout.format.size()) + " bytes long instead of 16 or more";
  const auto coding = layout.format_number(0, 2), channels = layout.format_number(2, 2), rate = layout.format_number(4, 4),
             frame = layout.format_number(12, 2), bits = layout.format_number(14, 2);
  if (channels == 0) return "its header says that it has 0 channels";
  if (rate == 0) return "its header says 0 samples a second: the rate has to be written there";
  const bool exact = coding == 1 || coding == 3 || coding == 0xfffe;
  if (exact && (bits == 0 || frame % channels != 0 || bits > 8 * (frame / channels)))
    return "its header says " + std::to_string(bits) + " bits a sample and " + std::to_string(frame) + " bytes for a frame of " +
           std::to_string(channels) + ": that contradicts itself";
  return {};
}

/// The same of the whole file.
[[nodiscard]] inline std::string wav_problem(const riff_layout& layout) {
  if (!layout.data_offset) return "truncated: the file ends before its samples begin";
  if (layout.second_data)
    return "holds two chunks of samples, at byte " + std::to_string(*layout.data_offset - 8) + " and at byte " +
           std::to_string(*layout.second_data) + ": nobody can know which one is the recording; export it again";
  if (auto why = format_chunk_problem(layout); !why.empty()) return why;
  if (!layout.data_promised || *layout.data_promised <= layout.data_present()) return {};
  return "truncated: the header promises " + std::to_string(*layout.data_promised) + " bytes of samples, the file holds " +
         std::to_string(layout.data_present());
}

}  // namespace rosin::detail

#include <rosin/core/macros_back.ipp>
