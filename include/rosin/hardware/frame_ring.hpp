// tier: hosted
// SPDX-License-Identifier: MIT
//
// Between the thread that must never wait (a driver's callback) and the one that may (a disk): a ring of frames for one writer
// and one reader, without locks. When it is full the writer drops and counts, and the reader learns how many frames are missing
// at the very place where they are missing.
//
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// T: float or double.
template <class T>
class frame_ring {
public:
  frame_ring(std::size_t channels, std::size_t frames)
      : channels_{channels}, frames_{frames}, samples_{std::make_unique<T[]>(channels * frames)}, gaps_{std::make_unique<gap[]>(
                                                                                                      gap_room)} {}

  [[nodiscard]] std::size_t channels() const noexcept { return channels_; }
  [[nodiscard]] std::size_t capacity() const noexcept { return frames_; }
  [[nodiscard]] std::size_t size() const noexcept {
    return static_cast<std::size_t>(written_.load(std::memory_order_acquire) - read_.load(std::memory_order_acquire));
  }

  /// Writer: room for so many frames.
  [[nodiscard]] std::size_t room() const noexcept { return frames_ - size(); }

  /// Writer: `count` frames, whose sample (frame, channel) is at(frame, channel). All of them or, where there is no room, none:
  /// then they are lost.
  template <class At>
  bool write(std::size_t count, const At& at) noexcept {
    if (count > room() || !flush_gap()) {
      lost(count);
      return false;
    }
    const std::uint64_t begin = written_.load(std::memory_order_relaxed);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t row = static_cast<std::size_t>((begin + i) % frames_) * channels_;
      for (std::size_t c = 0; c < channels_; ++c) samples_[row + c] = at(i, c);
    }
    written_.store(begin + count, std::memory_order_release);
    return true;
  }
  /// Writer: frames that never came are missing here.
  void lost(std::uint64_t count) noexcept { pending_lost_ += count; }

  /// Once the writer is done: frames missing after the last one.
  [[nodiscard]] std::uint64_t trailing() const noexcept { return pending_lost_; }

  struct portion {
    std::size_t frames = 0;
    std::uint64_t lost = 0;  ///< missing before them
  };
  /// Reader: as many frames as are there and fit, but none beyond a gap.
  portion read(std::span<T> interleaved) noexcept {
    portion out;
    const std::uint64_t begin = read_.load(std::memory_order_relaxed), end = written_.load(std::memory_order_acquire);
    if (begin == end) return out;  // a gap is told with the frames after it
    std::uint64_t until = end;
    const std::uint64_t first_gap = gaps_read_.load(std::memory_order_relaxed);
    if (first_gap != gaps_written_.load(std::memory_order_acquire)) {
      const gap& g = gaps_[first_gap % gap_room];
      if (g.before == begin) {
        out.lost = g.frames;
        gaps_read_.store(first_gap + 1, std::memory_order_release);
        if (first_gap + 1 != gaps_written_.load(std::memory_order_acquire))
          until = std::min(until, gaps_[(first_gap + 1) % gap_room].before);
      } else {
        until = std::min(until, g.before);
      }
    }
    out.frames = std::min(static_cast<std::size_t>(until - begin), interleaved.size() / channels_);
    for (std::size_t i = 0; i < out.frames; ++i) {
      const std::size_t row = static_cast<std::size_t>((begin + i) % frames_) * channels_;
      std::copy_n(&samples_[row], channels_, interleaved.begin() + static_cast<std::ptrdiff_t>(i * channels_));
    }
    read_.store(begin + out.frames, std::memory_order_release);
    return out;
  }

private:
  struct gap {
    std::uint64_t before = 0, frames = 0;
  };
  static constexpr std::size_t gap_room = 256;

  /// Writes the gap down where the next frame will stand; false: too many gaps wait to be read, so that this one goes on.
  bool flush_gap() noexcept {
    if (pending_lost_ == 0) return true;
    const std::uint64_t at = gaps_written_.load(std::memory_order_relaxed);
    if (at - gaps_read_.load(std::memory_order_acquire) >= gap_room) return false;
    gaps_[at % gap_room] = {written_.load(std::memory_order_relaxed), pending_lost_};
    gaps_written_.store(at + 1, std::memory_order_release);
    pending_lost_ = 0;
    return true;
  }

  std::size_t channels_, frames_;
  std::unique_ptr<T[]> samples_;
  std::unique_ptr<gap[]> gaps_;
  std::atomic<std::uint64_t> written_{0}, read_{0}, gaps_written_{0}, gaps_read_{0};
  std::uint64_t pending_lost_ = 0;  ///< the writer's own
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
