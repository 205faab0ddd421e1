// tier: hosted
// SPDX-License-Identifier: MIT
//
// Frames from a microcontroller: packets (frame_packet.hpp) over a serial line. The format is what the packets say; a device
// that changes it in mid-stream has to be opened anew. Corrupted and doubled packets, gaps and restarts are counted.
//
#pragma once

#include <rosin/hardware/byte_link.hpp>
#include <rosin/hardware/packet_decoder.hpp>

#include <algorithm>

namespace rosin {

class serial_source {
public:
  /// Waits for the first sound packet.
  [[nodiscard]] static outcome<serial_source> open(byte_link link, std::chrono::milliseconds patience = std::chrono::seconds{2}) {
    serial_source out{std::move(link)};
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (!out.current_) {
      const auto got = out.fetch(std::chrono::milliseconds{20});
      if (out.current_) break;
      if (got.gone) return failure{got.problem};
      if (std::chrono::steady_clock::now() > deadline)
        return failure{out.link_.name() + ": no packet of frames came" +
                       (out.decoder_.counts().corrupted > 0 ? ", only damaged ones" : "")};
    }
    out.format_ = out.current_->format;
    return out;
  }

  [[nodiscard]] frame_format format() const noexcept { return format_; }
  [[nodiscard]] const packet_counts& counts() const noexcept { return decoder_.counts(); }

  [[nodiscard]] frame_read read(std::span<double> interleaved, std::chrono::milliseconds patience) {
    frame_read out;
    const auto deadline = std::chrono::steady_clock::now() + patience;
    while (!current_) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
      const link_read got = fetch(std::max(left, std::chrono::milliseconds{0}));
      if (!current_ && got.gone) return {0, 0, true, got.problem};
      if (!current_ && left.count() <= 0) return out;
    }
    const auto width = static_cast<std::size_t>(format_.channels);
    const std::size_t room = interleaved.size() / width * width;
    std::size_t filled = 0;
    while (current_ && filled < room) {
      if (used_ == 0 && !begin_packet(out, filled)) return out;
      const std::size_t count = std::min(room - filled, current_->samples.size() - used_);
      std::copy_n(current_->samples.begin() + static_cast<std::ptrdiff_t>(used_), count,
                  interleaved.begin() + static_cast<std::ptrdiff_t>(filled));
      filled += count;
      used_ += count;
      out.frames = filled / width;
      if (used_ == current_->samples.size()) advance();
    }
    return out;
  }

private:
  explicit serial_source(byte_link link) noexcept : link_{std::move(link)} {}

  /// False: what was filled so far has to be given first, or nothing may follow.
  [[nodiscard]] bool begin_packet(frame_read& out, std::size_t filled) {
    const bool other = !(current_->format == format_);
    if (filled > 0 && (current_->lost > 0 || current_->restarted || other)) return false;
    if (other) {
      out.ended = true;
      out.problem = link_.name() + ": rate, channels or bits changed in mid-stream";
      return false;
    }
    out.lost = filled == 0 ? current_->lost : out.lost;
    if (current_->restarted) out.problem = link_.name() + ": the device started anew; how many frames are missing is not known";
    return true;
  }
  void advance() {
    current_ = decoder_.next();
    used_ = 0;
  }
  [[nodiscard]] link_read fetch(std::chrono::milliseconds patience) {
    std::array<std::uint8_t, 16384> bytes;
    link_read got = link_.read(bytes, patience);
    decoder_.push(std::span{bytes}.first(got.bytes));
    if (!current_) advance();
    return got;
  }

  byte_link link_;
  packet_decoder decoder_;
  std::optional<decoded_packet> current_;
  std::size_t used_ = 0;
  frame_format format_;
};

static_assert(FrameSource<serial_source>);

}  // namespace rosin
