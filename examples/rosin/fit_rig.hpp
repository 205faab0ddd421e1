// SPDX-License-Identifier: MIT
//
// All plucks of a rig fitted together; those that are held out, predicted.
//
#pragma once

#include "fit_prediction.hpp"
#include "rig_ends.hpp"
#include "rig_input.hpp"

#include <rosin/calibrate/calibration.hpp>

namespace tool {

/// One value with what makes it doubtful: random, and what is common to all (the wires' strength, the declared tension).
struct doubtful {
  double value = 0, sd = 0, systematic_sd = 0;
};

struct rig_calibration {
  std::string title;
  rosin::pluck_fit_result fit;
  std::vector<rosin::pluck_take> takes, held_out;  ///< as fitted, and as predicted
  std::vector<pluck_prediction> drawn, predicted;  ///< the same, with the model beside the recording
  rosin::rig_values values;
  std::array<double, 2> ac_coupled_Hz{};
  std::vector<rosin::calibration> at;  ///< for each declared position
  std::vector<double> declared;
  std::array<doubtful, 2> offset_N{};  ///< of the sensors, over all plucks
  std::optional<doubtful> bending_stiffness_Nm2, impedance_Ns_m;
  fitted_ends ends;  ///< what the plucks say of terminations that are to be fitted
  std::vector<std::string> assumed, warnings;
  bool incomplete = false;  ///< plucks had to be left out, or the fit did not settle

  [[nodiscard]] double rate_Hz() const { return takes.front().rate_Hz; }
};

/// Precondition: the rig has_both_forces(). `draw`: recordings and models side by side are wanted too.
[[nodiscard]] rosin::outcome<rig_calibration> calibrate(const rosin::rig& rig, provenance& from, bool draw);

}  // namespace tool
