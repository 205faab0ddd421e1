// tier: hosted
// SPDX-License-Identifier: MIT
//
// The sled, where its driver understands G-code in GRBL's dialect (version 1.1): one axis, X, in millimetres. A line is answered
// by "ok", "error:N" or "ALARM:N"; single bytes act at once, also while the sled moves:
//
//     ?  status report     !  feed hold     ~  go on     0x18  reset: the end of all motion
//
// What GRBL would do without a word (go slower than asked, cut a ramp short) is refused here, from its own settings: $110
// largest speed in mm/min, $120 acceleration in mm/s^2, $130 travel, $20 soft limits. For a stroke the acceleration is written
// to $120, only where it differs: it lives in memory that wears out.
//
#pragma once

#include <rosin/hardware/byte_link.hpp>
#include <rosin/hardware/frames.hpp>
#include <rosin/hardware/grbl_protocol.hpp>

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <thread>

namespace rosin {

/// A MotionStage.
class grbl_stage {
public:
  /// Wakes the controller up and reads its settings.
  [[nodiscard]] static outcome<grbl_stage> open(byte_link link, std::chrono::milliseconds patience = std::chrono::seconds{3}) {
    grbl_stage out{std::move(link), patience};
    if (auto bad = out.reset()) return *bad;
    auto told = out.command("$$");
    if (!told && told.error().find("ALARM") == std::string::npos) return failure{told.error()};
    return out;
  }

  /// Why the stroke cannot be made as asked, if so; nothing moves.
  [[nodiscard]] std::optional<failure> refused(const stroke& way) {
    const double mm_min = way.speed_m_s * 60e3;
    if (!(way.speed_m_s > 0) || !(way.acceleration_m_s2 > 0) || !std::isfinite(way.distance_m) || way.distance_m == 0)
      return failure{link_.name() + ": a stroke needs a distance, and a speed and an acceleration above zero"};
    if (way.steady_m() < 0)
      return failure{link_.name() + ": a stroke of " + figure(way.distance_m * 1e3) + " mm never reaches " +
                     figure(way.speed_m_s) + " m/s at " + figure(way.acceleration_m_s2) + " m/s2"};
    if (mm_min > setting(110)) return refusal("a speed", mm_min, setting(110), "mm/min");
    const auto now = status();
    if (!now) return failure{now.error()};
    if (now->state != motion_state::idle)
      return failure{link_.name() + ": the sled is not ready" + (now->reason.empty() ? "" : ": " + now->reason)};
    const double to_mm = (now->position_m + way.distance_m) * 1e3;
    if (setting(20) == 1 && (to_mm > 0.0005 || to_mm < -setting(130) - 0.0005))
      return failure{link_.name() + ": the stroke would end at " + figure(to_mm) + " mm, outside of " + figure(-setting(130)) +
                     " to 0 mm"};
    return std::nullopt;
  }
  [[nodiscard]] std::optional<failure> start(const stroke& way) {
    if (auto bad = refused(way)) return bad;
    const double acceleration = way.acceleration_m_s2 * 1e3;
    if (std::abs(acceleration - setting(120)) > 0.0005) {
      if (auto bad = ran("$120=" + figure(acceleration))) return bad;
      settings_[120] = acceleration;
    }
    return ran("G21G91G1X" + figure(way.distance_m * 1e3) + "F" + figure(way.speed_m_s * 60e3));
  }
  [[nodiscard]] outcome<motion_status> status() {
    if (auto bad = link_.write("?")) return *bad;
    const auto deadline = std::chrono::steady_clock::now() + patience_;
    while (std::chrono::steady_clock::now() < deadline) {
      const auto line = next_line();
      if (!line) return failure{line.error()};
      note(*line);
      if (const auto report = parse_grbl_status(*line)) return with_reason(*report);
    }
    return failure{link_.name() + ": the sled does not answer"};
  }
  [[nodiscard]] std::optional<failure> hold() { return link_.write("!"); }
  [[nodiscard]] std::optional<failure> resume() { return link_.write("~"); }
  /// Slows down first, so that the position stays known; what is left of the stroke is dropped.
  [[nodiscard]] std::optional<failure> stop() {
    if (auto bad = link_.write("!")) return bad;
    const auto deadline = std::chrono::steady_clock::now() + patience_;
    for (;;) {
      const auto now = status();
      if (!now) return failure{now.error()};
      if (now->state == motion_state::idle) return std::nullopt;
      if (now->state == motion_state::alarm || (now->state == motion_state::holding && now->speed_m_s == 0)) return reset();
      if (std::chrono::steady_clock::now() > deadline) return reset();
    }
  }
  /// Ends an alarm. Where the sled stands is not certain any more.
  [[nodiscard]] std::optional<failure> unlock() {
    alarm_.clear();
    return ran("$X");
  }
  [[nodiscard]] std::optional<failure> home() { return ran("$H"); }

  /// Waits until the stroke is over; the reason where it did not come to its end.
  [[nodiscard]] std::optional<failure> wait(double at_most_s) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>{at_most_s};
    for (;;) {
      const auto now = status();
      if (!now) return failure{now.error()};
      if (now->state == motion_state::alarm) return failure{link_.name() + ": " + now->reason};
      if (now->state == motion_state::idle) return std::nullopt;
      if (std::chrono::steady_clock::now() > deadline) return failure{link_.name() + ": the stroke is not over in time"};
      std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
  }
  /// A setting of the controller; NaN where it told none.
  [[nodiscard]] double setting(int which) const {
    const auto at = settings_.find(which);
    return at == settings_.end() ? std::numeric_limits<double>::quiet_NaN() : at->second;
  }

private:
  grbl_stage(byte_link link, std::chrono::milliseconds patience) : link_{std::move(link)}, patience_{patience} {}

  [[nodiscard]] static std::string figure(double x) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3f", x);
    return text.data();
  }
  [[nodiscard]] failure refusal(const std::string& what, double asked, double limit, const char* unit) const {
    return failure{link_.name() + ": " + what + " of " + figure(asked) + " " + unit + " is beyond the sled's " + figure(limit) +
                   " " + unit};
  }

  [[nodiscard]] outcome<std::string> next_line() {
    const auto deadline = std::chrono::steady_clock::now() + patience_;
    for (;;) {
      if (const auto end = text_.find('\n'); end != std::string::npos) {
        std::string line = text_.substr(0, end);
        text_.erase(0, end + 1);
        while (!line.empty() && line.back() == '\r') line.pop_back();
        if (!line.empty()) return line;
        continue;
      }
      std::array<std::uint8_t, 256> bytes{};
      const auto got = link_.read(bytes, std::chrono::milliseconds{50});
      text_.append(reinterpret_cast<const char*>(bytes.data()), got.bytes);
      if (got.gone) return failure{got.problem};
      if (text_.size() > 4096) return failure{link_.name() + ": this is no GRBL"};
      if (got.bytes == 0 && std::chrono::steady_clock::now() > deadline)
        return failure{link_.name() + ": the sled does not answer"};
    }
  }
  /// Alarms and settings are told between the lines.
  void note(const std::string& line) {
    if (const auto alarm = grbl_alarm(line)) alarm_ = *alarm;
    if (const auto value = parse_grbl_setting(line)) settings_[value->first] = value->second;
  }
  /// Sends a line, waits for its answer.
  [[nodiscard]] outcome<bool> command(const std::string& line) {
    if (auto bad = link_.write(line + "\n")) return *bad;
    for (;;) {
      const auto answer = next_line();
      if (!answer) return failure{answer.error()};
      note(*answer);
      if (*answer == "ok") return true;
      if (const auto error = grbl_error(*answer)) return failure{link_.name() + ": " + line + ": " + *error};
      if (const auto alarm = grbl_alarm(*answer)) return failure{link_.name() + ": " + line + ": " + *alarm};
    }
  }
  [[nodiscard]] std::optional<failure> ran(const std::string& line) {
    const auto done = command(line);
    return done ? std::nullopt : std::optional{failure{done.error()}};
  }
  [[nodiscard]] std::optional<failure> reset() {
    text_.clear();
    if (auto bad = link_.write("\x18")) return bad;
    for (;;) {
      const auto line = next_line();
      if (!line) return failure{line.error()};
      note(*line);
      if (line->starts_with("Grbl ")) return std::nullopt;
    }
  }
  [[nodiscard]] motion_status with_reason(motion_status s) const {
    if (s.state == motion_state::alarm) s.reason = alarm_.empty() ? "locked: home the sled, or unlock it" : alarm_;
    return s;
  }

  byte_link link_;
  std::chrono::milliseconds patience_;
  std::string text_, alarm_;
  std::map<int, double> settings_;
};

static_assert(MotionStage<grbl_stage>);

}  // namespace rosin
