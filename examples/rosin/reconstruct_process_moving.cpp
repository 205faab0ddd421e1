// SPDX-License-Identifier: MIT
#include "reconstruct_process.hpp"

namespace tool {

processed process_moving_ends(const process_input& in) {
  return detail::process<rosin::with_moving_ends<rosin::full_physics>>(in);
}

}  // namespace tool
