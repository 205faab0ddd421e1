// SPDX-License-Identifier: MIT
//
// What a simulation knows and its recordings do not say: truth.json, and a table for each bowed take.
//
#pragma once

#include "provenance.hpp"
#include "simulate_takes.hpp"

namespace tool {

/// time_s, force_N, velocity_m_s (string's centre), torsion_velocity_m_s, rod_velocity_m_s, and temperature_K if the law of
/// friction has one; sample by sample as in the recording.
[[nodiscard]] rosin::table truth_table(const simulation_plan& plan, const rosin::modal_take& take,
                                       std::vector<std::string> comments);

/// `tables`: the name of each take's table, empty where it has none.
[[nodiscard]] json truth_document(const simulation_plan& plan, const std::vector<simulated_take>& takes,
                                  const std::vector<std::string>& tables, const provenance& from);

/// What the string did in a bowed take.
[[nodiscard]] std::string name_of(rosin::bowed_motion motion);

}  // namespace tool
