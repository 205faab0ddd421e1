// tier: hosted
// SPDX-License-Identifier: MIT
//
// A time that nothing puts off. Whoever waits for an answer on a line where something else talks may not begin to count anew
// with each byte that comes; and whoever is asked to end (Ctrl-C) may not sit out what is left. So each wait has one deadline,
// is made of short slices, and looks at the deadline between them.
//
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>

namespace rosin {

class deadline {
public:
  /// `stop`: waits end early once it is true; a signal's handler may set it. It has to outlive the deadline.
  explicit deadline(std::chrono::milliseconds patience, const std::atomic<bool>* stop = nullptr) noexcept
      : until_{std::chrono::steady_clock::now() + patience}, stop_{stop} {}

  [[nodiscard]] bool stopped() const noexcept { return stop_ != nullptr && stop_->load(std::memory_order_acquire); }
  [[nodiscard]] bool over() const noexcept { return stopped() || std::chrono::steady_clock::now() >= until_; }
  /// As long as may be waited at once; zero when it is over.
  [[nodiscard]] std::chrono::milliseconds slice() const noexcept {
    using std::chrono::milliseconds;
    if (over()) return milliseconds{0};
    const auto left = std::chrono::ceil<milliseconds>(until_ - std::chrono::steady_clock::now());
    return std::clamp(left, milliseconds{0}, milliseconds{50});
  }

private:
  std::chrono::steady_clock::time_point until_;
  const std::atomic<bool>* stop_;
};

}  // namespace rosin
