// SPDX-License-Identifier: MIT
//
// A rig that is not there: the recordings of a rig folder (simulated ones, say) come out of a serial line as a digitiser would
// send them, and a sled answers on another. Between takes the string is at rest. A take of a pluck plays when its name is read
// from standard input (the hand that pulls the wire); one of a bow, when the sled begins to move.
//
#pragma once

#include "command_line.hpp"

#include <rosin/acquire/recording.hpp>
#include <rosin/hardware/frame_packet.hpp>
#include <rosin/hardware/grbl_simulator.hpp>
#include <rosin/hardware/pseudo_terminal.hpp>

#include <deque>
#include <random>

namespace tool {

struct fake_rig_options {
  std::string rig, line, sled, loop;
  double harm = 0, seconds = 0, homing_s = 0;
  int packet_frames = 64;
};

/// What plays: frames as integers of the recordings' width.
class fake_player {
public:
  [[nodiscard]] static rosin::outcome<fake_player> load(const fake_rig_options& given);

  /// Lets a take begin; false: there is none of this name.
  bool play(const std::string& name);
  /// The next bowed take in order; false: all have been played.
  bool bow();
  void next(std::span<std::int32_t> interleaved);

  [[nodiscard]] double rate_Hz() const noexcept { return rate_Hz_; }
  [[nodiscard]] int channels() const noexcept { return channels_; }
  [[nodiscard]] int bits() const noexcept { return bits_; }

private:
  using frames = std::vector<std::int32_t>;
  struct loaded_take {
    std::string name;
    bool bowed = false;
    frames samples;
  };
  std::vector<loaded_take> takes_;
  frames idle_, playing_;
  std::size_t at_ = 0, idle_at_ = 0, bows_ = 0;
  bool loop_ = false;
  double rate_Hz_ = 0;
  int channels_ = 0, bits_ = 16;
};

}  // namespace tool
