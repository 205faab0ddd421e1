// SPDX-License-Identifier: MIT
//
// A calibration as a file (docs/formats/calibration.schema.json): written by `rosin fit --json`, read by
// `rosin reconstruct --calibration`; and as rows of a table for people.
//
#pragma once

#include "fit_rig.hpp"

namespace tool {

/// What a reconstruction needs of a calibration, whether just fitted or read from a file.
struct calibration_set {
  std::string from;    ///< "3 plucks of rig.toml", or the file's name
  double rate_Hz = 0;  ///< of the plucks; noise_N of the calibrations counts up to half of it
  double fundamental_Hz = 0;
  std::array<doubtful, 2> offset_N{};
  std::vector<double> declared;  ///< positions, one for each of `at`
  std::vector<rosin::calibration> at;
  fitted_ends ends;
};

[[nodiscard]] calibration_set set_of(const rig_calibration& fitted);
[[nodiscard]] json to_json(const rig_calibration& fitted, const provenance& from);
[[nodiscard]] rosin::outcome<calibration_set> read_calibration(const std::string& path);

/// The table of `rosin fit` and of the reports.
struct calibration_row {
  std::string group, name, unit, value, random, systematic;
};
[[nodiscard]] std::vector<calibration_row> rows_of(const rig_calibration& fitted);

/// A value with as many digits as its standard deviation can use.
[[nodiscard]] std::string rounded(double value, double sd);

/// An object into a file, or to standard output where the path is "-".
[[nodiscard]] std::optional<rosin::failure> save_json(const std::string& path, const json& document, bool force);

}  // namespace tool
