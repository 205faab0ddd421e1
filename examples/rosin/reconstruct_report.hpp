// SPDX-License-Identifier: MIT
//
// The report of a reconstruction, in the manner of the paper's Figs. 2 to 5.
//
#pragma once

#include "fit_report.hpp"
#include "reconstruct_take.hpp"

namespace tool {

/// `fitted`: the calibration with its plucks, where it was made in the same run.
[[nodiscard]] exit_code write_reconstruction_report(const std::string& path, bool force, const take_reconstruction& r,
                                                    const std::optional<rig_calibration>& fitted, const provenance& from);

}  // namespace tool
