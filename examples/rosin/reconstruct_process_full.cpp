// SPDX-License-Identifier: MIT
#include "reconstruct_process.hpp"

namespace tool {

processed process_full(const process_input& in) { return detail::process<rosin::full_physics>(in); }

}  // namespace tool
