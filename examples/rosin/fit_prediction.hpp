// SPDX-License-Identifier: MIT
//
// A pluck predicted by a calibration that did not see it, or drawn by the one that did: string, position and gains as they
// are; free are the instant of release, the strength, and the sensors' offsets.
//
#pragma once

#include <rosin/calibrate/pluck_fit.hpp>

namespace tool {

struct pluck_prediction {
  std::string name;
  double rate_Hz = 0, release_s = 0, strength_N = 0;
  std::array<double, 2> offset_N{};
  double residual_ratio = 1;  ///< rms(recorded - predicted) / rms(recorded), both channels, inside the band
  rosin::band limits{0, 0};
  /// Nominal newtons, band-limited, as long as the take; recorded: NaN at the edges, model: as a closed form has it.
  std::array<std::vector<double>, 2> recorded_N, model_N;
};

/// `position`: fitted, of the take. Fails where no release is found.
[[nodiscard]] rosin::outcome<pluck_prediction> predict_pluck(const rosin::pluck_fit_result& fit, const rosin::pluck_take& take,
                                                             double position, const std::array<double, 2>& ac_coupled_Hz);

}  // namespace tool
