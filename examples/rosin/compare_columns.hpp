// SPDX-License-Identifier: MIT
//
// A reconstructed signal against the true one, both through one and the same low-pass.
//
#pragma once

#include <rosin/propagate/band.hpp>

#include <optional>
#include <string>
#include <vector>

namespace tool {

/// Two signals without their means, which AC-coupled sensors do not know.
struct compared {
  std::string name;
  double scale = 1;                                ///< result = scale * truth, by least squares
  double delta = 0;                                ///< Eq. (12) as they are
  double delta_scaled = 0;                         ///< Eq. (12) after division by the scale
  double rms_truth = 0, rms_error = 0, worst = 0;  ///< of the truth, and of the difference after division by the scale
};

/// 20 kHz, or what the sampling rate has room for, and from half as much again on nothing.
[[nodiscard]] rosin::band compared_band(double rate_Hz, std::optional<double> pass_Hz = {}, std::optional<double> stop_Hz = {});

/// The first row between known ones in which either is not.
[[nodiscard]] std::optional<std::size_t> gap_between(const std::vector<double>& a, const std::vector<double>& b);

/// Over the stretch in which both are known (not NaN), less the low-pass's response at either end; rms_truth 0 where that is too
/// short or has a gap.
[[nodiscard]] compared compare_columns(const std::string& name, const std::vector<double>& result,
                                       const std::vector<double>& truth, double rate_Hz, const rosin::band& window);

}  // namespace tool
