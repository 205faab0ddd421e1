// SPDX-License-Identifier: MIT
//
// The takes of a plan: what happens at the contact and at the string's ends, and what the sensors, amplifiers and converters
// make of it.
//
#pragma once

#include "simulate_plan.hpp"

#include <rosin/acquire/recording.hpp>

namespace tool {

class progress;

struct simulated_take {
  rosin::modal_take truth;
  rosin::recording recording;
  std::vector<std::size_t> clipped;  ///< samples beyond full scale, by channel of the plan
  std::vector<double> peak_share;    ///< loudest sample / full scale, the same
};

/// All takes. Channels without a declared scale get one that the loudest sample fills to 70 %; it is written into the plan
/// (as gain: full scales per unit).
[[nodiscard]] rosin::outcome<std::vector<simulated_take>> simulate_takes(simulation_plan& plan, progress& bar);

}  // namespace tool
