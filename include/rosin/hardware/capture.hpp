// tier: hosted
// SPDX-License-Identifier: MIT
//
//     source ──▶ thread ──▶ ring ──▶ whoever asks
//
// A thread that does nothing but fetch frames, so that neither a disk nor a terminal that halts can make a source overrun before
// the ring is full (ten seconds). From a source that can wait (a file) nothing is ever dropped: then the thread waits instead.
//
#pragma once

#include <rosin/hardware/frame_ring.hpp>
#include <rosin/hardware/frames.hpp>

#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace rosin {

/// Itself a source, with the same frames. The source that it was given lives in its thread.
template <FrameSource Source>
class capture {
public:
  explicit capture(Source source, double buffer_s = 10)
      : format_{source.format()}, ring_{static_cast<std::size_t>(format_.channels),
                                        static_cast<std::size_t>(buffer_s * format_.sample_rate_Hz) + 1},
        thread_{[this, from = std::move(source)](const std::stop_token& stop) mutable { run(from, stop); }} {}
  capture(const capture&) = delete;
  capture& operator=(const capture&) = delete;
  ~capture() {
    thread_.request_stop();
    thread_.join();
  }

  [[nodiscard]] frame_format format() const noexcept { return format_; }

  /// As FrameSource asks for.
  [[nodiscard]] frame_read read(std::span<double> interleaved, std::chrono::milliseconds patience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    for (;;) {
      const bool over = ended_.load(std::memory_order_acquire);  // asked before the ring: what came last is still in it
      const auto got = ring_.read(interleaved);
      if (got.frames > 0) return {got.frames, got.lost, false, take_problem()};
      if (over) return {0, ring_.trailing(), true, take_problem()};
      if (std::chrono::steady_clock::now() >= deadline) return {0, 0, false, take_problem()};
      std::this_thread::sleep_for(std::chrono::milliseconds{2});
    }
  }
  /// The fullest that the ring ever was, as a fraction.
  [[nodiscard]] double fullest() const noexcept {
    return static_cast<double>(most_.load(std::memory_order_relaxed)) / static_cast<double>(ring_.capacity());
  }

private:
  void run(Source& from, const std::stop_token& stop) {
    const auto width = static_cast<std::size_t>(format_.channels);
    std::vector<double> block(width * std::max<std::size_t>(64, static_cast<std::size_t>(format_.sample_rate_Hz / 200)));
    while (!stop.stop_requested()) {
      const frame_read got = from.read(block, std::chrono::milliseconds{50});
      if (!got.problem.empty()) put_problem(got.problem);
      ring_.lost(got.lost);
      while (!format_.live && ring_.room() < got.frames && !stop.stop_requested())
        std::this_thread::sleep_for(std::chrono::milliseconds{2});
      if (got.frames > 0 && !ring_.write(got.frames, [&](std::size_t i, std::size_t c) { return block[i * width + c]; }))
        put_problem("overrun: nobody took the frames in time");
      most_.store(std::max(most_.load(std::memory_order_relaxed), ring_.size()), std::memory_order_relaxed);
      if (got.ended) break;
    }
    ended_.store(true, std::memory_order_release);
  }
  void put_problem(const std::string& what) {
    const std::scoped_lock lock{mutex_};
    if (problem_.empty()) problem_ = what;
    has_problem_.store(true, std::memory_order_release);
  }
  [[nodiscard]] std::string take_problem() {
    if (!has_problem_.load(std::memory_order_acquire)) return {};
    const std::scoped_lock lock{mutex_};
    has_problem_.store(false, std::memory_order_release);
    return std::exchange(problem_, {});
  }

  frame_format format_;
  frame_ring<double> ring_;
  std::atomic<bool> ended_{false}, has_problem_{false};
  std::atomic<std::size_t> most_{0};
  std::mutex mutex_;
  std::string problem_;
  std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace rosin
