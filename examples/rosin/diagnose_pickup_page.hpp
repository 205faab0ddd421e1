// SPDX-License-Identifier: MIT
//
// What a single pickup told, as sentences and as figures.
//
#pragma once

#include "diagnose_rig.hpp"
#include "report_figure.hpp"

namespace tool {

[[nodiscard]] std::string pickup_statement(const missing_effect& m);
/// Precondition: d.pickup.
[[nodiscard]] std::vector<figure> pickup_figures(const rig_diagnosis& d);

}  // namespace tool
