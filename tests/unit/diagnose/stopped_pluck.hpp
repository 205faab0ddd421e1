// SPDX-License-Identifier: MIT
//
// Plucks of a stepped modal string with a stiff spring in its way: nothing of the closed forms that tell an obstacle.
//
#pragma once

#include <rosin/simulate/burdened_signals.hpp>

#include "plucked.hpp"

namespace test {

/// Recorded by 16-bit converters with 0.3 mN of noise, as they are declared.
inline rosin::pluck_take stopped_pluck(double force_N, std::uint64_t seed, const rosin::obstacle& stop, double position = 0.3) {
  rosin::rig_burden burden;
  burden.string.stop = stop;
  const auto made = rosin::simulate_pluck(plucked_rig, burden,
                                          {.position = position, .force_N = force_N, .release_s = 0.004, .duration_s = 0.05});
  rosin::pluck_take take;
  take.name = "pluck-" + std::to_string(seed);
  take.rate_Hz = made->sample_rate_Hz, take.strength_N = force_N, take.position = position;
  const rosin::converter sensor{.gain = 1, .newtons_per_full_scale = 3, .noise_N = 0.3e-3, .bits = 16};
  take.force_N = {rosin::convert(made->force_near_N, take.rate_Hz, sensor, 2 * seed).newtons(),
                  rosin::convert(made->force_far_N, take.rate_Hz, sensor, 2 * seed + 1).newtons()};
  return take;
}

}  // namespace test
