// SPDX-License-Identifier: MIT
//
// The truth through the band that a reconstruction has, by the direct sum. NaN where the low-pass reaches beyond the record.
//
#pragma once

#include <rosin/propagate/fir.hpp>

#include <cmath>
#include <vector>

namespace test {

inline std::vector<double> through_band(const std::vector<double>& x, const rosin::band& limits, double rate_Hz) {
  const rosin::fir k = rosin::sample_response([](double) { return 1.0; }, limits, rate_Hz, -200, 200);
  std::vector<double> y(x.size(), std::nan(""));
  for (std::size_t n = 200; n + 200 < x.size(); ++n) {
    y[n] = 0;
    for (std::size_t j = 0; j <= 400; ++j) y[n] += k.taps[j] * x[n + 200 - j];
  }
  return y;
}

}  // namespace test
