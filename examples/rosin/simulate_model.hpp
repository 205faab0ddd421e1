// SPDX-License-Identifier: MIT
//
// The corrected model of a rig, as `rosin diagnose --json` wrote it, put into a simulation: calibration of string, sensors and
// wires, and every effect that was found, by the names and parameters of the format. What cannot be simulated is refused by name.
//
#pragma once

#include "simulate_plan.hpp"

#include <map>

namespace tool {

struct found_effect {
  std::string name, end, channel;
  std::map<std::string, double> parameters;
};

struct diagnosed_model {
  std::string file, verdict;
  std::map<std::string, double> calibration;
  std::vector<found_effect> effects;
};

/// The file itself joins the inputs elsewhere.
[[nodiscard]] rosin::outcome<diagnosed_model> read_diagnosed_model(const std::string& path);

/// The rig with the law of friction that was found, and with rate and duration of the recordings where they are there and
/// [simulate] is silent.
[[nodiscard]] rosin::rig with_model(rosin::rig rig, const diagnosed_model& model);

/// Puts the rest into a plan made from that.
[[nodiscard]] std::optional<rosin::failure> apply_model(const diagnosed_model& model, const rosin::rig& rig,
                                                        simulation_plan& plan);

}  // namespace tool
