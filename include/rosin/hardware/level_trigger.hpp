// tier: hosted
// SPDX-License-Identifier: MIT
//
// Waits for something to happen on the string and then gives everything, beginning some time before: a breaking wire cannot be
// announced. A channel triggers when it departs from its own slow mean by more than a threshold, so that neither the static force
// of a string that is being deflected nor a sensor's offset sets it off. It is armed at rest only: once all channels have stayed
// within half of the threshold for three time constants of the mean, twelve where they did not at first. A string that still rings
// from the take before is not at rest.
//
#pragma once

#include <rosin/hardware/frames.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct trigger_settings {
  double threshold = 0;     ///< fraction of full scale; 0: triggered from the beginning
  double before_s = 0.1;    ///< what is kept of the time before
  double follows_s = 0.02;  ///< time constant of the mean
};

class level_trigger {
public:
  level_trigger(const frame_format& f, const trigger_settings& s)
      : settings_{s}, width_{static_cast<std::size_t>(f.channels)},
        mean_(width_), room_{width_ * static_cast<std::size_t>(std::lround(s.before_s * f.sample_rate_Hz))},
        follow_{1 - std::exp(-1 / (s.follows_s * f.sample_rate_Hz))},
        settling_{static_cast<std::uint64_t>(3 * s.follows_s * f.sample_rate_Hz)}, fired_{!(s.threshold > 0)} {}

  [[nodiscard]] bool fired() const noexcept { return fired_; }
  /// It has been at rest, so that what happens now is what is waited for.
  [[nodiscard]] bool armed() const noexcept { return fired_ || calm_ > (unrest_ > 0 ? 4 : 1) * settling_; }
  /// The last departure that kept it from being armed; 0: there was none.
  [[nodiscard]] double unrest() const noexcept { return unrest_; }
  /// Frames from the first one given to the one that triggered.
  [[nodiscard]] std::size_t lead() const noexcept { return lead_; }

  /// Takes frames as they come and gives those that belong to the take: none while it waits, then the time before and all the
  /// rest. The result is valid until the next call.
  [[nodiscard]] std::span<const double> push(std::span<const double> interleaved) {
    if (fired_) return interleaved;
    std::size_t at = 0;
    while (at + width_ <= interleaved.size() && !departs(interleaved.subspan(at, width_))) at += width_;
    kept_.insert(kept_.end(), interleaved.begin(), interleaved.end());
    const bool now = at + width_ <= interleaved.size();
    const std::size_t after = interleaved.size() - at;  // from the triggering frame on
    const std::size_t keep = std::min(kept_.size(), now ? room_ + after : room_);
    kept_.erase(kept_.begin(), kept_.end() - static_cast<std::ptrdiff_t>(keep));
    if (!now) return {};
    fired_ = true;
    lead_ = (keep - after) / width_;
    return kept_;
  }

private:
  [[nodiscard]] bool departs(std::span<const double> frame) noexcept {
    double most = 0;
    for (std::size_t c = 0; c < width_; ++c) {
      if (!begun_) mean_[c] = frame[c];
      most = std::max(most, std::abs(frame[c] - mean_[c]));
      mean_[c] += follow_ * (frame[c] - mean_[c]);
    }
    begun_ = true;
    if (armed()) return most > settings_.threshold;
    if (most > settings_.threshold / 2) calm_ = 0, unrest_ = most;
    else ++calm_;
    return false;
  }

  trigger_settings settings_;
  std::size_t width_;
  std::vector<double> mean_, kept_;
  std::size_t room_, lead_ = 0;
  double follow_, unrest_ = 0;
  std::uint64_t settling_, calm_ = 0;  ///< frames
  bool begun_ = false, fired_;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
