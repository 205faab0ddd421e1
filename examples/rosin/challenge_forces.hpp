// SPDX-License-Identifier: MIT
//
// What a diagnosis is worth for the reconstruction: the force under the bow with the declared model and with the corrected
// one, both against the truth.
//
#pragma once

#include "provenance.hpp"

#include <filesystem>
#include <string>

namespace tool {

/// For each stroke of which `truth` holds the true force: {"bow-1": {"before": Delta, "after": Delta}}, Eq. (12) up to 20 kHz
/// after one common scale, or {"error": why}. As declared is what `rosin reconstruct` does by itself, with its fine tuning. Empty
/// where no truth is there.
[[nodiscard]] json force_errors(const std::filesystem::path& rig, const std::filesystem::path& truth,
                                const std::string& diagnosis, provenance from);

}  // namespace tool
