// SPDX-License-Identifier: MIT
//
// The corrected model of a rig, as `rosin diagnose --json` wrote it: read back, and bowed takes reconstructed with it.
//
#pragma once

#include "reconstruct_process.hpp"
#include "rig_input.hpp"

#include <memory>

namespace rosin {
struct pluck_diagnosis;
}

namespace tool {

struct corrected_model {
  std::string file;
  std::shared_ptr<const rosin::pluck_diagnosis> plucks;
  double tension_drift = 0, contact_width_m = 0;
  /// of string, ends, wire, sensors and tension: those that a reconstruction can take into account
  std::vector<std::string> effects;
  std::vector<std::string> passed_over;  ///< of the contact: a reconstruction does not need them
  provenance from;
  std::string doubt;  ///< whether it is of this rig file; empty if it is
};

[[nodiscard]] rosin::outcome<corrected_model> read_model(const std::string& path, const rosin::rig& rig, provenance& from);

/// Force and velocity of one bowed take; its reason if that cannot be done.
[[nodiscard]] rosin::outcome<processed> process_with_model(const corrected_model& model, const rosin::rig& rig,
                                                           const std::string& take, const rosin::band& limits,
                                                           std::vector<std::string>& warnings);

}  // namespace tool
