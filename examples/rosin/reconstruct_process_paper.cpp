// SPDX-License-Identifier: MIT
#include "reconstruct_process.hpp"

namespace tool {

processed process_as_paper(const process_input& in) { return detail::process<rosin::paper_physics>(in); }

}  // namespace tool
