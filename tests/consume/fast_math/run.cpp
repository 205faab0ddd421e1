// SPDX-License-Identifier: MIT
// What runs on an instrument, compiled once as it stands and once with -ffast-math (RUN is the name it has then).
#include <rosin/reconstruct/streaming_reconstructor.hpp>

#include "run.hpp"

void RUN(const coefficients& design, const float* near_N, const float* far_N, float* force_N, std::size_t count) {
  rosin::streaming_reconstructor<float, taps, line> stream{design};
  for (std::size_t n = 0; n < count; ++n) force_N[n] = stream({near_N[n], far_N[n]}).force_N();
}
