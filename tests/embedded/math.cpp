// SPDX-License-Identifier: MIT
#include <rosin/math/lanes.hpp>
#include <rosin/math/robust_loss.hpp>

extern "C" void rosin_lanes(float* data, const float* twiddle) noexcept {
  using lanes = rosin::lane_complex<float, rosin::register_lanes<float>>;
  const lanes a = lanes::load(data), b = lanes::load(data + 2 * rosin::register_lanes<float>);
  plus_i(a + b, (a - b).times(twiddle)).conj().store(data);
  minus_i(a, b.times_conj(twiddle)).store(data + 2 * rosin::register_lanes<float>);
}
