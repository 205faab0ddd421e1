// tier: hosted
// SPDX-License-Identifier: MIT
//
// Frames from a microcontroller: packets (frame_packet.hpp) over a serial line. The format is what the packets say; a device
// that changes it in mid-stream has to be opened anew. Corrupted and doubled packets, gaps and restarts are counted. A line on
// which something else talks is told as such; where nothing comes for half a second, a "?" is sent once, which a G-code
// controller (the sled, when two lines were swapped) answers.
//
#pragma once

#include <rosin/hardware/byte_link.hpp>
#include <rosin/hardware/line_witness.hpp>

#include <algorithm>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

class serial_source {
public:
  /// Waits for the first sound packet, for at most `patience` or until `stop` becomes true.
  [[nodiscard]] static outcome<serial_source> open(byte_link link, std::chrono::milliseconds patience = std::chrono::seconds{2},
                                                   const std::atomic<bool>* stop = nullptr) {
    serial_source out{std::move(link)};
    const deadline until{patience, stop}, quiet{std::min(patience / 2, std::chrono::milliseconds{500})};
    line_witness witness;
    for (bool asked = false; !out.current_;) {
      const auto got = out.fetch(until.slice(), &witness);
      if (out.current_) break;
      if (got.gone) return failure{got.problem};
      if (until.stopped()) return failure{out.link_.name() + ": stopped before a packet of frames came"};
      if (until.over() || witness.controller())
        return failure{out.link_.name() + ": no packet of frames came" +
                       (out.decoder_.counts().corrupted > 0 && !witness.controller() ? ", only damaged ones: " : ": ") +
                       witness.in_words()};
      if (!asked && quiet.over()) {
        asked = true;
        (void)out.link_.write("?", std::chrono::milliseconds{50});
      }
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
  [[nodiscard]] link_read fetch(std::chrono::milliseconds patience, line_witness* witness = nullptr) {
    std::array<std::uint8_t, 16384> bytes;
    link_read got = link_.read(bytes, patience);
    decoder_.push(std::span{bytes}.first(got.bytes));
    if (witness != nullptr) witness->push(std::span{bytes}.first(got.bytes));
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

#include <rosin/core/macros_back.ipp>
