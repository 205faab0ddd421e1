// SPDX-License-Identifier: MIT
//
// Diagnoses set against the truth, from the files alone: what was named, where, how strong, and whether the intervals cover.
//
#pragma once

#include "provenance.hpp"

#include <map>
#include <string>
#include <vector>

namespace tool {

struct parameter_score {
  std::string effect, name;
  double error = 0;  ///< relative; of a position: absolute
  bool covered = false, has_interval = false;
};

struct rig_score {
  std::string name, verdict;
  std::vector<std::string> hidden, named;
  bool right = false;       ///< all that is hidden is named and nothing else
  bool all_found = false;   ///< all that is hidden is named
  bool place_right = true;  ///< end, channel, position within 0.01
  bool has_place = false;
  std::vector<parameter_score> parameters;
  double held_out_over_floor = 0;  ///< 0: not a pluck-residual
  double seconds = 0;
  /// each stroke's error, Delta of Eq. (12) after a common scale: as declared, as diagnosed
  std::vector<std::pair<double, double>> forces;
};

[[nodiscard]] rig_score score(const json& truth, const json& diagnosis);
/// What force_errors() found of the same rig.
void add_forces(const json& errors, rig_score& s);
[[nodiscard]] json to_json(const std::vector<rig_score>& scores);
/// A page in Markdown: per effect named, placed, errors, coverage; what was said instead; every failure by name.
[[nodiscard]] std::string to_markdown(const std::vector<rig_score>& scores, const std::string& how);
/// What the diagnoses do for the force: its error before and after; empty where no true force is there.
[[nodiscard]] std::string forces_to_markdown(const std::vector<rig_score>& scores);
/// The same where the catalogue did not know what was hidden: how often it said that something is unexplained, and what it said
/// instead.
[[nodiscard]] std::string left_out_to_markdown(const std::vector<rig_score>& scores, const std::string& how);

}  // namespace tool
