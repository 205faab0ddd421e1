// SPDX-License-Identifier: MIT
//
// What a page shows of a stroke: the stretch in which most is left, before and after.
//
#pragma once

#include "diagnose_parts.hpp"

namespace tool {

/// The take and the stretch of it that the page shows, of the data with that name: four periods of the string, or of a ripple.
[[nodiscard]] contact_picture contact_picture_of(const std::vector<rosin::contact_trace>& before, const std::string& statistic,
                                                 double length_s);
/// What the model that was found leaves of the take that the page shows.
void add_after(const std::vector<rosin::contact_trace>& after, contact_picture& picture);
/// Finishes the picture; `alone`: nothing else is wrong with the rig, so that this is where it shows.
void show_contact(rig_diagnosis& d, double noise, bool alone);

}  // namespace tool
