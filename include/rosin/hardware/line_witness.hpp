// tier: hosted
// SPDX-License-Identifier: MIT
//
// Who talks on this line? USB names change places, and a digitiser that is asked for G-code, or a sled that is asked for frames,
// does not say so. From the bytes that came, in words: nothing, packets of frames, a G-code controller, text, or neither.
//
#pragma once

#include <rosin/hardware/grbl_lines.hpp>
#include <rosin/hardware/packet_decoder.hpp>

namespace rosin {

class line_witness {
public:
  void push(std::span<const std::uint8_t> bytes) {
    bytes_ += bytes.size();
    for (const std::uint8_t b : bytes) text_ += (b >= ' ' && b <= '~') || b == '\r' || b == '\n' || b == '\t' ? 1U : 0U;
    packets_.push(bytes);
    while (packets_.next()) {
    }
    lines_.push(bytes);
    while (auto line = lines_.next()) {
      const bool speaks = is_grbl_greeting(*line) || parse_grbl_status(*line);
      if (speaks && !controller_) latest_.clear();
      controller_ = controller_ || speaks;
      if (latest_.empty()) latest_ = line->substr(0, 60);
    }
  }

  [[nodiscard]] bool silent() const noexcept { return bytes_ == 0; }
  /// Packets of frames, whose checksums are right.
  [[nodiscard]] bool digitiser() const noexcept { return packets_.counts().packets > 1; }
  [[nodiscard]] bool controller() const noexcept { return controller_; }

  /// A piece of a sentence.
  [[nodiscard]] std::string in_words() const {
    if (silent()) return "nothing comes";
    if (digitiser()) return "packets of frames come, as from a digitiser: have the lines of digitiser and sled been swapped?";
    if (controller()) return "a G-code controller talks (" + latest_ + "): have the lines of digitiser and sled been swapped?";
    if (text_ * 10 >= bytes_ * 9 && !latest_.empty()) return "something else talks (" + latest_ + ")";
    return "bytes come that are neither text nor packets of frames (is this the speed of the line?)";
  }

private:
  packet_decoder packets_;
  grbl_lines lines_;
  std::uint64_t bytes_ = 0, text_ = 0;
  std::string latest_;
  bool controller_ = false;
};

}  // namespace rosin
