// tier: hosted
// SPDX-License-Identifier: MIT
//
//     source ──▶ thread ──▶ ring ──▶ whoever asks
//
// A thread that does nothing but fetch frames, so that neither a disk nor a terminal that halts can make a source overrun before
// the ring is full (ten seconds). From a source that can wait (a file) nothing is ever dropped: then the thread waits instead.
// A source that does not come back from a read (a pipe into which nobody writes) is left behind with its thread, half a second
// after the end: it keeps what it uses.
//
#pragma once

#include <rosin/hardware/frame_ring.hpp>
#include <rosin/hardware/frames.hpp>

#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Itself a source, with the same frames. The source that it was given lives in its thread.
template <FrameSource Source>
class capture {
public:
  explicit capture(Source source, double buffer_s = 10)
      : shared_{std::make_shared<shared>(std::move(source), buffer_s)}, thread_{[s = shared_](const std::stop_token& stop) {
          s->run(stop);
        }} {}
  capture(const capture&) = delete;
  capture& operator=(const capture&) = delete;
  ~capture() {
    thread_.request_stop();
    for (int waited_ms = 0; waited_ms < 500 && !shared_->ended.load(std::memory_order_acquire); waited_ms += 2)
      std::this_thread::sleep_for(std::chrono::milliseconds{2});
    if (!shared_->ended.load(std::memory_order_acquire)) thread_.detach();
  }

  [[nodiscard]] frame_format format() const noexcept { return shared_->format; }

  /// As FrameSource asks for.
  [[nodiscard]] frame_read read(std::span<double> interleaved, std::chrono::milliseconds patience) {
    const auto until = std::chrono::steady_clock::now() + patience;
    for (;;) {
      const bool over = shared_->ended.load(std::memory_order_acquire);  // asked before the ring: what came last is still in it
      const auto got = shared_->ring.read(interleaved);
      if (got.frames > 0) return {got.frames, got.lost, false, shared_->take_problem()};
      if (over) return {0, shared_->ring.trailing(), true, shared_->take_problem()};
      if (std::chrono::steady_clock::now() >= until) return {0, 0, false, shared_->take_problem()};
      std::this_thread::sleep_for(std::chrono::milliseconds{2});
    }
  }
  /// What a live source has given so far is forgotten: reading goes on with what comes now. A file's frames stay.
  void skip() {
    if (!format().live) return;
    std::vector<double> block(static_cast<std::size_t>(format().channels) * 4096);
    for (std::size_t left = shared_->ring.size(); left > 0;) {
      const auto got = shared_->ring.read(block);
      if (got.frames == 0) break;
      left -= std::min(left, got.frames);
    }
    (void)shared_->take_problem();
  }
  /// The fullest that the ring ever was, as a fraction.
  [[nodiscard]] double fullest() const noexcept {
    return static_cast<double>(shared_->most.load(std::memory_order_relaxed)) / static_cast<double>(shared_->ring.capacity());
  }

private:
  struct shared {
    shared(Source source, double buffer_s)
        : format{source.format()}, ring{static_cast<std::size_t>(format.channels),
                                        static_cast<std::size_t>(buffer_s * format.sample_rate_Hz) + 1},
          from{std::move(source)} {}

    void run(const std::stop_token& stop) {
      const auto width = static_cast<std::size_t>(format.channels);
      std::vector<double> block(width * std::max<std::size_t>(64, static_cast<std::size_t>(format.sample_rate_Hz / 200)));
      while (!stop.stop_requested()) {
        const frame_read got = from.read(block, std::chrono::milliseconds{50});
        if (!got.problem.empty()) put_problem(got.problem);
        ring.lost(got.lost);
        while (!format.live && ring.room() < got.frames && !stop.stop_requested())
          std::this_thread::sleep_for(std::chrono::milliseconds{2});
        if (got.frames > 0 && !ring.write(got.frames, [&](std::size_t i, std::size_t c) { return block[i * width + c]; }))
          put_problem("overrun: nobody took the frames in time");
        most.store(std::max(most.load(std::memory_order_relaxed), ring.size()), std::memory_order_relaxed);
        if (got.ended) break;
      }
      ended.store(true, std::memory_order_release);
    }
    void put_problem(const std::string& what) {
      const std::scoped_lock lock{mutex};
      if (problem.empty()) problem = what;
      has_problem.store(true, std::memory_order_release);
    }
    [[nodiscard]] std::string take_problem() {
      if (!has_problem.load(std::memory_order_acquire)) return {};
      const std::scoped_lock lock{mutex};
      has_problem.store(false, std::memory_order_release);
      return std::exchange(problem, {});
    }

    frame_format format;
    frame_ring<double> ring;
    std::atomic<bool> ended{false}, has_problem{false};
    std::atomic<std::size_t> most{0};
    std::mutex mutex;
    std::string problem;
    Source from;  ///< the thread's alone
  };

  std::shared_ptr<shared> shared_;
  std::jthread thread_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
