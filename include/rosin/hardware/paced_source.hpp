// tier: hosted
// SPDX-License-Identifier: MIT
//
// A recording that plays as if it were played on the rig: its frames come when their time has come, or `faster` times as
// early. For rehearsals, and for tests of what has to keep up.
//
#pragma once

#include <rosin/hardware/frames.hpp>

#include <algorithm>
#include <thread>
#include <utility>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

template <FrameSource Source>
class paced_source {
public:
  explicit paced_source(Source from, double faster = 1) : from_{std::move(from)}, faster_{faster} {}

  [[nodiscard]] frame_format format() const { return from_.format(); }
  [[nodiscard]] frame_read read(std::span<double> interleaved, std::chrono::milliseconds patience) {
    using seconds = std::chrono::duration<double>;
    const auto now = std::chrono::steady_clock::now();
    if (given_ == 0) start_ = now;
    const frame_format is = from_.format();
    const auto due = static_cast<std::uint64_t>(seconds{now - start_}.count() * is.sample_rate_Hz * faster_);
    const std::size_t width = static_cast<std::size_t>(is.channels),
                      wanted = std::max<std::size_t>(
                          1, std::min(interleaved.size() / width, static_cast<std::size_t>(is.sample_rate_Hz / 1000)));
    if (due < given_ + wanted) {
      const seconds wait{static_cast<double>(given_ + wanted - due) / (is.sample_rate_Hz * faster_)};
      std::this_thread::sleep_for(std::min<seconds>(wait, patience));
      if (wait > patience) return {};
    }
    const std::size_t most =
        std::min<std::size_t>(interleaved.size() / width, std::max<std::uint64_t>(wanted, due > given_ ? due - given_ : 0));
    frame_read out = from_.read(interleaved.first(most * width), patience);
    given_ += out.frames;
    return out;
  }

private:
  Source from_;
  double faster_;
  std::uint64_t given_ = 0;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
