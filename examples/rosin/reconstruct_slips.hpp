// SPDX-License-Identifier: MIT
//
// The slips of a reconstructed take, one by one: loops in the plane of force and velocity, and the track along the rod.
//
#pragma once

#include "reconstruct_take.hpp"
#include "report_figure.hpp"

#include <rosin/friction/slip_loops.hpp>

namespace tool {

struct take_slips {
  /// surface (centre, where torsion is not modelled) less rod; NaN: unknown, or the rod has not caught the string yet
  std::vector<double> relative_m_s;
  std::vector<double> place_m;  ///< of the contact on the rod
  rosin::contact_phases phases;
  std::vector<rosin::slip_loop> loops;
  rosin::loop_verdict verdict;
};

/// Nothing in it where the rod's speed is unknown.
[[nodiscard]] take_slips slips_of(const take_reconstruction& r);

/// One row a slip.
[[nodiscard]] rosin::table table_of(const take_slips& s, const take_reconstruction& r, const provenance& from);
[[nodiscard]] json to_json(const take_slips& s);
[[nodiscard]] std::vector<std::pair<std::string, std::string>> facts_of(const take_slips& s, const take_reconstruction& r);
/// Loops and track of a stretch of the take, where there are any.
[[nodiscard]] std::vector<figure> figures_of(const take_slips& s, const take_reconstruction& r, std::size_t begin,
                                             std::size_t end);

}  // namespace tool
