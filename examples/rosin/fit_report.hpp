// SPDX-License-Identifier: MIT
//
// The report of a calibration: plucks with the fit, residuals, the table with its errors.
//
#pragma once

#include "fit_pickup_rig.hpp"
#include "report_page.hpp"

namespace tool {

/// A pluck at either end with the model, and what is left (the paper's Fig. 2).
[[nodiscard]] figure pluck_figure(const pluck_prediction& pluck, double fundamental_Hz, bool held_out);

[[nodiscard]] exit_code write_fit_report(const std::string& path, bool force, const rig_calibration& c, const provenance& from);
[[nodiscard]] exit_code write_fit_report(const std::string& path, bool force, const pickup_calibration& c,
                                         const provenance& from);

}  // namespace tool
