// SPDX-License-Identifier: MIT
//
// A calibration as a header for firmware: the coefficients of a streaming reconstruction as constants, bit for bit as designed.
//
#pragma once

#include "calibration_file.hpp"

#include <rosin/reconstruct/passage_reconstructor.hpp>

namespace tool {

struct header_options {
  std::string path;  ///< empty: none is wanted
  bool in_double = false;
  rosin::bow_version version = rosin::bow_version::both;
  double position = -1;                          ///< declared; < 0: the only one
  double rate_Hz = 0, pass_Hz = 0, stop_Hz = 0;  ///< 0: rate of the plucks, 0.30 and 0.45 of the rate
  double error = 1e-3;
  std::string space = "rig";  ///< namespace of the constants
};

/// Adds --emit-header and what belongs to it.
void add_header_options(CLI::App& command, header_options& given);

/// Designs and writes it. Remarks (what had to be set right in the calibration, what the header holds) are added to `said`.
[[nodiscard]] std::optional<rosin::failure> write_header(const header_options& given, bool force,
                                                         const calibration_set& calibration, const provenance& from,
                                                         std::vector<std::string>& said);

}  // namespace tool
