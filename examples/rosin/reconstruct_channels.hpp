// SPDX-License-Identifier: MIT
//
// Further channels of a bowed take: the sled's speed and the normal force are used, a sensor of the string's velocity at the
// contact (the paper's magnet) is compared with the result.
//
#pragma once

#include "reconstruct_take.hpp"

namespace tool {

void add_rod_and_normal_force(const rosin::rig& rig, const rosin::take& take, const checked_take& read, take_reconstruction& r);
void add_comparisons(const rosin::rig& rig, const rosin::take& take, const checked_take& read, take_reconstruction& r);

}  // namespace tool
