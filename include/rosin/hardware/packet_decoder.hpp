// tier: hosted
// SPDX-License-Identifier: MIT
//
// The other end of frame_packet.hpp: bytes as they come from the line, in pieces of any size, into frames. What arrives damaged
// is dropped and counted; what arrives twice is dropped and counted; what is missing is found by the number of the next packet
// that is sound, and its length said. Nothing on the line can make it read or write out of bounds or grow.
//
#pragma once

#include <rosin/hardware/frame_packet.hpp>
#include <rosin/hardware/frames.hpp>

#include <cmath>
#include <deque>
#include <vector>

namespace rosin {

struct packet_counts {
  std::uint64_t packets = 0, frames = 0;  ///< that were sound and new
  std::uint64_t lost_frames = 0, gaps = 0, corrupted = 0, doubled = 0, restarts = 0;
};

/// Frames of one packet.
struct decoded_packet {
  frame_format format;
  std::uint64_t lost = 0;  ///< frames missing before it
  bool restarted = false;  ///< the device started anew before it: how much is missing, nobody knows
  std::vector<double> samples;
};

class packet_decoder {
public:
  static constexpr std::size_t longest = 65536;  ///< bytes of one packet on the line

  /// Takes bytes from the line.
  void push(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) {
      if (byte != 0 && pending_.size() < longest) pending_.push_back(byte);
      else if (byte != 0) overlong_ = true;
      else end_of_packet();
    }
  }
  /// The next packet in order, if there is one.
  [[nodiscard]] std::optional<decoded_packet> next() {
    if (ready_.empty()) return std::nullopt;
    decoded_packet out = std::move(ready_.front());
    ready_.pop_front();
    return out;
  }
  [[nodiscard]] const packet_counts& counts() const noexcept { return counts_; }

private:
  [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t count) const noexcept {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value |= std::uint32_t{pending_[at + i]} << (8 * i);
    return value;
  }
  [[nodiscard]] bool sound(std::size_t size) const noexcept {
    if (size < packet_head_bytes + packet_tail_bytes || pending_[0] != packet_mark) return false;
    if (crc32(pending_.data(), size - packet_tail_bytes) != number(size - packet_tail_bytes, packet_tail_bytes)) return false;
    const std::size_t channels = pending_[2], bits = pending_[3], frames = number(4, 2);
    if (channels == 0 || frames == 0 || (bits != 16 && bits != 24 && bits != 32) || number(6, 4) == 0) return false;
    return size == packet_head_bytes + frames * channels * (bits / 8) + packet_tail_bytes;
  }
  void end_of_packet() {
    const bool started = !pending_.empty(), joined = joined_;
    const std::size_t size = overlong_ ? 0 : cobs_decode(pending_.data(), pending_.size());
    joined_ = true;  // what comes before the first zero may be half a packet: no fault of the line
    if (sound(size)) take();
    else if (started && joined) ++counts_.corrupted;
    pending_.clear();
    overlong_ = false;
  }
  /// Precondition: the packet is sound.
  void take() {
    const std::uint32_t first = number(10, 4), frames = number(4, 2);
    decoded_packet out;
    out.format = {number(6, 4) / 1000.0, pending_[2], pending_[3], false, true};
    out.restarted = stream_ && *stream_ != pending_[1];
    if (stream_ && !out.restarted) {
      const std::uint32_t ahead = first - expected_;
      if (ahead >= 0x80000000U) {
        ++counts_.doubled;
        return;
      }
      out.lost = ahead;
    }
    counts_.gaps += out.lost > 0 ? 1U : 0U;
    counts_.lost_frames += out.lost;
    counts_.restarts += out.restarted ? 1U : 0U;
    ++counts_.packets;
    counts_.frames += frames;
    stream_ = pending_[1];
    expected_ = first + frames;
    read_samples(out, frames);
    ready_.push_back(std::move(out));
  }
  void read_samples(decoded_packet& out, std::size_t frames) {
    const std::size_t bytes = pending_[3] / 8U, count = frames * pending_[2];
    const int shift = 32 - pending_[3];
    out.samples.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto left_aligned = static_cast<std::int32_t>(number(packet_head_bytes + i * bytes, bytes) << shift);
      out.samples[i] = static_cast<double>(left_aligned) * 0x1p-31;
    }
  }

  std::vector<std::uint8_t> pending_;
  std::deque<decoded_packet> ready_;
  packet_counts counts_;
  std::optional<std::uint8_t> stream_;
  std::uint32_t expected_ = 0;
  bool overlong_ = false, joined_ = false;
};

}  // namespace rosin
