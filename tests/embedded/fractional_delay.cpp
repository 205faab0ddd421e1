// SPDX-License-Identifier: MIT
#include <rosin/condition/fractional_delay.hpp>

extern "C" void rosin_delay(float* samples, int count, float delay_samples) noexcept {
  rosin::fractional_delay<float, rosin::lagrange<4>, 256> line{delay_samples};
  for (int n = 0; n < count; ++n) samples[n] = line(samples[n]);
}
