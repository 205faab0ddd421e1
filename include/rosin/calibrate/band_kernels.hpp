// tier: hosted
// SPDX-License-Identifier: MIT
//
// What limits a recording to a band before it is compared with a model: kernels, kept, since the design of one takes as long as a
// step of a fit.
//
#pragma once

#include <rosin/propagate/fir.hpp>

#include <deque>
#include <mutex>
#include <utility>

namespace rosin {

/// For several threads; a kernel stays where it is as long as they do.
class band_kernels {
public:
  band_kernels() = default;
  band_kernels(const band_kernels& other) : kept_{other.all()} {}
  band_kernels& operator=(const band_kernels& other) {
    auto kept = other.all();
    const std::lock_guard lock{busy_};
    kept_ = std::move(kept);
    return *this;
  }
  ~band_kernels() = default;

  [[nodiscard]] const fir& of(const band& limits, double rate_Hz) const {
    const std::lock_guard lock{busy_};
    for (const entry& e : kept_)
      if (e.limits.pass_Hz == limits.pass_Hz && e.limits.stop_Hz == limits.stop_Hz && e.rate_Hz == rate_Hz) return e.kernel;
    return kept_.emplace_back(entry{limits, rate_Hz, shortest_fir([](double) { return 1.0; }, limits, rate_Hz, -400, 400, 1e-5)})
        .kernel;
  }

private:
  struct entry {
    band limits;
    double rate_Hz;
    fir kernel;
  };
  [[nodiscard]] std::deque<entry> all() const {
    const std::lock_guard lock{busy_};
    return kept_;
  }

  mutable std::mutex busy_;
  mutable std::deque<entry> kept_;
};

}  // namespace rosin
