// SPDX-License-Identifier: MIT
//
// Rigs without force transducers at both ends: partials, pitch, stiffness and loss of each pluck from each of its channels.
//
#pragma once

#include "calibration_file.hpp"

#include <rosin/calibrate/pickup_fit.hpp>
#include <rosin/calibrate/pickup_string.hpp>

namespace tool {

struct pickup_result {
  std::string take, channel;
  double rate_Hz = 0;
  rosin::pickup_fit fit;
  rosin::string_in_SI string;
};

struct pickup_calibration {
  std::string title;
  std::vector<pickup_result> results;
  std::vector<std::string> assumed, warnings;
  bool incomplete = false;
};

/// Plucks that are held out are left out; what cannot be fitted is named in the warnings. Fails where nothing is left.
[[nodiscard]] rosin::outcome<pickup_calibration> calibrate_pickups(const rosin::rig& rig, provenance& from);

[[nodiscard]] json to_json(const pickup_calibration& fitted, const provenance& from);
[[nodiscard]] std::vector<calibration_row> rows_of(const pickup_result& one);

}  // namespace tool
