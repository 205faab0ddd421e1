// SPDX-License-Identifier: MIT
#include "../frame_input.hpp"

#include <rosin/adapt/frames_alsa.hpp>

namespace tool {

rosin::outcome<frame_input> open_alsa(const std::string& device, const rosin::frame_format& wanted) {
  auto from = rosin::alsa_source::open(device, wanted);
  if (!from) return rosin::failure{from.error()};
  return frame_input{*std::move(from)};
}

}  // namespace tool
