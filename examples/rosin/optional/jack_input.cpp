// SPDX-License-Identifier: MIT
#include "../frame_input.hpp"

#include <rosin/adapt/frames_jack.hpp>

namespace tool {

rosin::outcome<frame_input> open_jack(const std::vector<std::string>& ports) {
  auto from = rosin::jack_source::open("rosin", ports);
  if (!from) return rosin::failure{from.error()};
  return frame_input{*std::move(from)};
}

}  // namespace tool
