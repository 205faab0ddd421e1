// SPDX-License-Identifier: MIT
//
//     source ──▶ capture (a thread) ──▶ meters ──▶ trigger ──▶ take on the disk, and whoever else looks at the frames
//
// The engine of `rosin record` and `rosin live`: takes one after the other from one source that stays open.
//
#pragma once

#include "frame_input.hpp"
#include "take_plan.hpp"

#include <rosin/hardware/level_meter.hpp>
#include <rosin/hardware/level_trigger.hpp>
#include <rosin/hardware/take_file.hpp>

#include <atomic>
#include <functional>

namespace tool {

struct recorder_options {
  double seconds = 0;  ///< 0: until it is stopped
  rosin::trigger_settings trigger;
};
void add_recorder_options(CLI::App& command, recorder_options& given);

struct gap_in_take {
  std::uint64_t frame = 0, length = 0;
};

struct take_report {
  take_plan take;
  rosin::frame_format format;
  std::uint64_t frames = 0;  ///< in the file, with those that stand for missing ones
  std::vector<gap_in_take> gaps;
  std::vector<std::uint64_t> clipped;    ///< samples at full scale, by channel
  std::vector<std::string> problems;     ///< in the order in which they came
  bool triggered = false, over = false;  ///< over: the source has ended, or the disk; no take can follow
  /// longest time that a block of frames took besides its writing, and how long the block itself lasts
  double worst_block_s = 0, worst_block_of_s = 0;
  double worst_block_processor_s = 0;  ///< most that the processor was at work for any block, besides its writing
  /// longest time that the file system took for one write, the first with the making of the file; the frames wait in a ring
  /// meanwhile
  double worst_write_s = 0;
  double busy = 0;  ///< share of the time that the frames' treatment took

  [[nodiscard]] std::uint64_t lost() const noexcept;
  [[nodiscard]] double duration_s() const noexcept {
    return format.sample_rate_Hz > 0 ? static_cast<double>(frames) / format.sample_rate_Hz : 0;
  }
};
[[nodiscard]] json to_json(const take_report& report);
[[nodiscard]] std::string summary_of(const take_report& report);

/// What others do while a take is recorded. Any of them may be empty.
struct recorder_hooks {
  std::function<std::optional<rosin::failure>(std::span<const double>)> frames;  ///< of the take; missing ones are NaN
  std::function<void()> begun;                                                   ///< the take's first frames are in the file
  /// asked at each block, with the take's time: a reason to end ("": all is well)
  std::function<std::optional<std::string>(double)> over;
  std::function<std::string()> shows;  ///< appended to the meters' line
};

class recorder {
public:
  recorder(frame_input from, recorder_options how) : how_{how}, from_{std::move(from)} {}

  [[nodiscard]] rosin::frame_format format() const noexcept { return from_.format(); }
  /// One take, which `files` has reserved. `files` null: nothing is written.
  [[nodiscard]] take_report record(const take_plan& take, rig_file_writer* files, const recorder_hooks& hooks = {});
  /// What came before now belongs to no take, unless the source is a file or a pipe.
  void skip() { from_.skip(); }
  [[nodiscard]] double fullest_buffer() const noexcept { return from_.fullest(); }

private:
  recorder_options how_;
  rosin::capture<frame_input> from_;
};

/// Ctrl-C and SIGTERM end the take as --seconds would.
void stop_on_signals();
[[nodiscard]] bool stopped() noexcept;
/// The same, for waits of the library.
[[nodiscard]] const std::atomic<bool>* stop_flag() noexcept;

/// Memory of this program that is in use, bytes.
[[nodiscard]] std::uint64_t resident_bytes();

}  // namespace tool
