// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the eye wants to know of each channel while it is recorded: the largest sample of late (falling back by 20 dB a second),
// the rms over about a third of a second, and whether it ever reached full scale.
//
#pragma once

#include <rosin/hardware/frames.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct channel_level {
  double peak = 0, rms = 0;   ///< fractions of full scale
  std::uint64_t clipped = 0;  ///< samples at full scale, from the beginning
};

class level_meter {
public:
  explicit level_meter(const frame_format& f)
      : levels_(static_cast<std::size_t>(f.channels)), squares_(levels_.size()), fall_{std::pow(10.0, -1 / f.sample_rate_Hz)},
        forget_{std::exp(-1 / (0.3 * f.sample_rate_Hz))}, top_{f.float_format ? 1.0 : 1 - std::ldexp(1.0, 1 - f.bits)} {}

  void push(std::span<const double> interleaved) noexcept {
    const std::size_t width = levels_.size();
    for (std::size_t i = 0; i + width <= interleaved.size(); i += width)
      for (std::size_t c = 0; c < width; ++c) {
        const double x = interleaved[i + c], size = std::abs(x);
        channel_level& level = levels_[c];
        level.peak = std::max(size, level.peak * fall_);
        squares_[c] = forget_ * squares_[c] + (1 - forget_) * x * x;
        level.clipped += x >= top_ || x <= -1 ? 1U : 0U;
      }
    for (std::size_t c = 0; c < width; ++c) levels_[c].rms = std::sqrt(squares_[c]);
  }
  [[nodiscard]] const std::vector<channel_level>& levels() const noexcept { return levels_; }

private:
  std::vector<channel_level> levels_;
  std::vector<double> squares_;
  double fall_, forget_, top_;
};

/// In decibels below full scale, at most `floor` of them.
[[nodiscard]] inline double decibels(double level, double floor = -120) noexcept {
  return level > 0 ? std::max(floor, 20 * std::log10(level)) : floor;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
