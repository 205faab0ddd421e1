// tier: hosted
// SPDX-License-Identifier: MIT
//
//     digitiser ──▶ FrameSource ──▶ rosin ──▶ FrameSink        sled ◀── MotionStage
//
// What the laboratory's hardware has to offer, as three concepts: whoever has another digitiser writes a type with two
// functions and hands it over. A frame holds one sample of every channel, as fractions of full scale (recording.hpp).
//
// Nothing is lost in silence: a source that knows of missing frames says how many are missing before those that it gives, so
// that time goes on counting right; and a source that ends says whether it came to its end or broke.
//
#pragma once

#include <rosin/core/outcome.hpp>

#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace rosin {

/// What comes out of a source, from its first frame to its last.
struct frame_format {
  double sample_rate_Hz = 0;
  int channels = 0;
  int bits = 16;  ///< of the converter, for files; 32 with float_format: floating point
  bool float_format = false;
  bool live = true;  ///< frames that are not fetched in time are lost (a file waits)

  friend bool operator==(const frame_format&, const frame_format&) = default;
};

/// What one call of read() gave.
struct frame_read {
  std::size_t frames = 0;  ///< now in the block
  std::uint64_t lost = 0;  ///< frames known to be missing directly before these
  bool ended = false;      ///< nothing will follow
  std::string problem;     ///< why it ended early, or what was odd (a checksum, a restart); empty: all is well
};

/// read() fills `interleaved` with whole frames, waiting for at most `patience` for the first of them: no frame and not ended
/// means that none came in time. One thread reads.
template <class S>
concept FrameSource = std::movable<S> &&
    requires(S source, const S& same, std::span<double> interleaved, std::chrono::milliseconds patience) {
  { same.format() } -> std::convertible_to<frame_format>;
  { source.read(interleaved, patience) } -> std::same_as<frame_read>;
};

/// write() takes whole frames, finish() says that none will follow. Both give the reason where it did not work.
template <class S>
concept FrameSink = std::movable<S> && requires(S sink, std::span<const double> interleaved) {
  { sink.write(interleaved) } -> std::same_as<std::optional<failure>>;
  { sink.finish() } -> std::same_as<std::optional<failure>>;
};

/// One stroke of the sled: from rest to rest, along its one axis. A negative distance goes back.
struct stroke {
  double distance_m = 0, speed_m_s = 0, acceleration_m_s2 = 0;

  /// Way that is covered at full speed; negative: the speed is never reached.
  [[nodiscard]] constexpr double steady_m() const noexcept {
    return (distance_m < 0 ? -distance_m : distance_m) - speed_m_s * speed_m_s / acceleration_m_s2;
  }
  [[nodiscard]] constexpr double duration_s() const noexcept {
    return (distance_m < 0 ? -distance_m : distance_m) / speed_m_s + speed_m_s / acceleration_m_s2;
  }
};

enum class motion_state { idle, running, holding, alarm };

struct motion_status {
  motion_state state = motion_state::idle;
  double position_m = 0, speed_m_s = 0;
  std::string reason;  ///< of an alarm
};

/// start() returns when the stroke has been accepted, not when it is over; what the stage cannot do as asked it refuses.
/// hold() slows down to rest, resume() goes on, stop() ends the motion for good.
template <class S>
concept MotionStage = std::movable<S> && requires(S stage, const stroke& way) {
  { stage.start(way) } -> std::same_as<std::optional<failure>>;
  { stage.status() } -> std::same_as<outcome<motion_status>>;
  { stage.hold() } -> std::same_as<std::optional<failure>>;
  { stage.resume() } -> std::same_as<std::optional<failure>>;
  { stage.stop() } -> std::same_as<std::optional<failure>>;
};

}  // namespace rosin
