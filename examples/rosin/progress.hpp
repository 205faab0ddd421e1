// SPDX-License-Identifier: MIT
//
// A bar on the terminal for work that takes long; nothing at all where standard error is a file or a pipe.
//
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>
#include <utility>

namespace tool {

class progress {
public:
  /// steps: how often step() will be called.
  progress(std::string what, std::size_t steps)
      : what_{std::move(what)}, steps_{steps}, shown_{steps > 1 && ::isatty(STDERR_FILENO) == 1} {
    draw();
  }
  progress(const progress&) = delete;
  progress& operator=(const progress&) = delete;
  ~progress() {
    if (shown_) std::fputs("\r\x1b[K", stderr);
  }

  void step() {
    ++done_;
    const auto now = std::chrono::steady_clock::now();
    if (now - drawn_ < std::chrono::milliseconds{80} && done_ < steps_) return;
    drawn_ = now;
    draw();
  }

private:
  void draw() const {
    if (!shown_) return;
    constexpr std::size_t width = 30;
    const std::size_t filled = steps_ > 0 ? width * (done_ < steps_ ? done_ : steps_) / steps_ : width;
    const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
    std::cerr << "\r\x1b[K" + what_ + " [" + bar + "] " + std::to_string(done_) + "/" + std::to_string(steps_) << std::flush;
  }

  std::string what_;
  std::size_t steps_, done_ = 0;
  bool shown_;
  std::chrono::steady_clock::time_point drawn_{};
};

}  // namespace tool
