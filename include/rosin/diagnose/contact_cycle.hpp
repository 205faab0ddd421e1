// tier: hosted
// SPDX-License-Identifier: MIT
//
// Which part of the stick-slip cycle does a mismatch of the contact stand in? All stretches of sticking (or of slipping) are laid over
// each other, each from 0 where it begins to 1 where it ends, and what is left is summed by equal parts of them: what the rod or
// bristles give follows the force through the whole stick, creep grows towards its end, torsion rings after it has begun.
//
#pragma once

#include <rosin/diagnose/contact_take.hpp>

#include <algorithm>
#include <cmath>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The rms of what is left in each of `parts` equal parts of a stretch of neighbouring samples; stretches of fewer samples than
/// parts do not count.
[[nodiscard]] inline std::vector<double> left_by_part(const contact_trace& trace, std::size_t parts = 10) {
  double step = 1e9;
  for (std::size_t i = 1; i < trace.time_s.size(); ++i) step = std::min(step, trace.time_s[i] - trace.time_s[i - 1]);
  std::vector<double> power(parts, 0.0), count(parts, 0.0);
  for (std::size_t begin = 0, end = 0; begin < trace.time_s.size(); begin = end) {
    for (end = begin + 1; end < trace.time_s.size() && trace.time_s[end] - trace.time_s[end - 1] < 2.5 * step;) ++end;
    if (end - begin < parts) continue;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t part = (i - begin) * parts / (end - begin);
      power[part] += trace.left[i] * trace.left[i], ++count[part];
    }
  }
  for (std::size_t k = 0; k < parts; ++k) power[k] = count[k] > 0 ? std::sqrt(power[k] / count[k]) : 0;
  return power;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
