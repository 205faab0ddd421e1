// tier: hosted
// SPDX-License-Identifier: MIT
//
// Coefficients for streaming_reconstructor.hpp, designed once on a desk: the kernels of the whole-record reconstruction, the
// gains of the sensors taken in, laid out in order of arrival. The look-ahead is what physics asks for, the passage to the
// farther end, plus the reach of the band's window; a smaller `error` or a narrower transition band makes it longer.
//
#pragma once

#include <rosin/core/outcome.hpp>
#include <rosin/reconstruct/reconstructor.hpp>
#include <rosin/reconstruct/streaming_reconstructor.hpp>

#include <algorithm>
#include <array>
#include <string>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Fails where a filter is longer than Taps or reaches back further than Line. gain: recorded / true, of near and far.
template <class T, std::size_t Taps, std::size_t Line, class Physics = full_physics>
[[nodiscard]] outcome<streaming_coefficients<T, Taps>> design_streaming(const bow_point& at, const std::array<double, 2>& gain,
                                                                        const band& limits, double rate_Hz, double error = 1e-4) {
  const std::vector<fir> kernels = bow_point_kernels<Physics>(at, limits, rate_Hz, error);
  int ahead = 0, back = 0;
  for (const fir& k : kernels) {
    ahead = std::max(ahead, -k.first);
    back = std::max(back, k.last());
    if (k.taps.size() > Taps)
      return failure{"a filter needs " + std::to_string(k.taps.size()) + " taps, there is room for " + std::to_string(Taps)};
  }
  if (static_cast<std::size_t>(ahead + back + 1) > Line)
    return failure{"the filters span " + std::to_string(ahead + back + 1) + " frames, the delay lines hold " +
                   std::to_string(Line)};

  streaming_coefficients<T, Taps> out;
  out.latency = static_cast<std::size_t>(ahead);
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const fir& k = kernels[i];
    out.kernel[i].count = k.taps.size();
    out.kernel[i].newest_age = static_cast<std::size_t>(ahead + k.first);
    std::transform(k.taps.rbegin(), k.taps.rend(), out.kernel[i].taps.begin(),
                   [&](double tap) { return static_cast<T>(tap / gain[i % 2]); });
  }
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
