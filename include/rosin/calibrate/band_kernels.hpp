// tier: hosted
// SPDX-License-Identifier: MIT
//
// What limits a recording to a band before it is compared with a model: kernels, kept, since the design of one takes as long as a
// step of a fit.
//
#pragma once

#include <rosin/propagate/fir.hpp>

#include <deque>

namespace rosin {

/// Not for several threads.
class band_kernels {
public:
  [[nodiscard]] const fir& of(const band& limits, double rate_Hz) const {
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
  mutable std::deque<entry> kept_;
};

}  // namespace rosin
