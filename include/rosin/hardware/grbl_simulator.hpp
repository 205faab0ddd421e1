// tier: hosted
// SPDX-License-Identifier: MIT
//
// A sled that is not there: what a GRBL 1.1 controller with one axis answers, or one of another dialect, and where the sled would
// be, as a function of a clock that the caller keeps. For tests, and for trying a session without the laboratory. Motion is a trapezoid of speed
//
//     v(t) = min(a t, v, a (T - t))
//
// A feed hold slows down with the same acceleration. The machine's coordinate runs from -travel (the far end) to 0, as GRBL's
// does. As GRBL, it says nothing while it homes, and after a limit's alarm nothing until it is reset.
//
#pragma once

#include <rosin/hardware/frames.hpp>
#include <rosin/hardware/grbl_protocol.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

class grbl_simulator {
public:
  std::map<int, double> settings{{13, 0}, {20, 1}, {21, 1}, {22, 0}, {110, 60000}, {120, 2000}, {130, 400}};
  double switch_mm = 1e9;  ///< a hard limit's switch that sits at a wrong place
  double home_s = 0;       ///< what homing takes
  std::string greeting = "Grbl 1.1h ['$' for help]";
  bool reports_work = false;        ///< WPos instead of MPos
  std::optional<double> offset_mm;  ///< of the work's coordinate, told in each report
  double report_every_s = 0;        ///< reports that nobody asked for; 0: none

  /// Bytes from the computer at the time now_s; the answer.
  [[nodiscard]] std::string receive(std::string_view bytes, double now_s) {
    std::string out = advance(now_s);
    for (const char c : bytes) {
      if (c == '\x18') out += reset();
      else if (deaf_ || homed_at_s_) continue;
      else if (c == '?') out += report();
      else if (c == '!') hold_ = true;
      else if (c == '~') hold_ = false;
      else if (c != '\n') line_ += c;
      else if (c == '\n') out += execute(std::exchange(line_, {}));
    }
    return out;
  }
  /// Time goes on; what the controller says by itself.
  [[nodiscard]] std::string advance(double now_s) {
    constexpr double step_s = 1e-4;
    std::string out;
    for (; clock_s_ + step_s <= now_s; clock_s_ += step_s) {
      if (homed_at_s_ && clock_s_ >= *homed_at_s_) {
        homed_at_s_.reset();
        position_mm_ = 0;
        out += "ok\r\n";
      }
      if (report_every_s > 0 && clock_s_ >= next_report_s_ && !homed_at_s_) {
        next_report_s_ = clock_s_ + report_every_s;
        out += report();
      }
      if (move(step_s)) out += limit("ALARM:1");
    }
    return out;
  }
  /// Supply or reset button: what it says by itself.
  [[nodiscard]] std::string restart() {
    position_mm_ = speed_ = 0;
    return reset();
  }
  [[nodiscard]] double position_m() const noexcept { return position_mm_ / 1e3; }
  [[nodiscard]] double speed_m_s() const noexcept { return speed_ / 1e3; }
  [[nodiscard]] bool moving() const noexcept { return left_mm_ != 0 && !alarm_; }
  /// How many strokes have begun.
  [[nodiscard]] int strokes() const noexcept { return strokes_; }

private:
  /// True: the switch was hit.
  [[nodiscard]] bool move(double step_s) noexcept {
    if (left_mm_ == 0) return false;
    const double a = settings[120], way = std::abs(left_mm_);
    const double target = hold_ ? 0 : std::min(feed_, std::sqrt(2 * a * way));
    speed_ = std::clamp(target, speed_ - a * step_s, speed_ + a * step_s);
    const double step = std::min(way, speed_ * step_s);
    position_mm_ += std::copysign(step, left_mm_);
    left_mm_ -= std::copysign(step, left_mm_);
    if (std::abs(left_mm_) < 1e-4 && !hold_) {
      position_mm_ += left_mm_;
      left_mm_ = speed_ = 0;
    }
    return settings[21] == 1 && position_mm_ > switch_mm;
  }
  [[nodiscard]] std::string report() const {
    const char* state = alarm_                   ? "Alarm"
                        : hold_ && left_mm_ != 0 ? (speed_ > 0 ? "Hold:1" : "Hold:0")
                        : left_mm_ != 0          ? "Run"
                                                 : "Idle";
    const double unit = settings.at(13) == 1 ? 25.4 : 1;
    const std::string place = grbl_number((position_mm_ - (reports_work ? offset_mm.value_or(0) : 0)) / unit) + ",0.000,0.000";
    const std::string offset = offset_mm ? "|WCO:" + grbl_number(*offset_mm / unit) + ",0.000,0.000" : "";
    return "<" + std::string{state} + (reports_work ? "|WPos:" : "|MPos:") + place +
           "|FS:" + (settings.at(13) == 1 ? grbl_number(speed_ * 60 / unit) : std::to_string(std::lround(speed_ * 60))) + ",0" +
           offset + ">\r\n";
  }
  [[nodiscard]] std::string reset() {
    const bool fast = speed_ > 0, homing = homed_at_s_.has_value();
    left_mm_ = speed_ = 0;
    hold_ = deaf_ = false;
    homed_at_s_.reset();
    line_.clear();
    alarm_ = alarm_ || fast || homing;
    return std::string{homing ? "ALARM:6\r\n"
                       : fast ? "ALARM:3\r\n"
                              : ""} +
           "\r\n" + greeting + "\r\n" + (alarm_ ? "[MSG:'$H'|'$X' to unlock]\r\n" : "");
  }
  [[nodiscard]] std::string execute(const std::string& line) {
    if (line.empty()) return "ok\r\n";
    if (line == "$X") return alarm_ = false, "[MSG:Caution: Unlocked]\r\nok\r\n";
    if (line == "$$") return list() + "ok\r\n";
    if (line == "$H") return settings[22] == 1 ? home() : "error:5\r\n";
    if (line.front() == '$') return set(line);
    if (alarm_) return "error:9\r\n";
    return motion(line);
  }
  [[nodiscard]] std::string home() {
    alarm_ = false;
    left_mm_ = 0;
    homed_at_s_ = clock_s_ + home_s;
    return {};
  }
  [[nodiscard]] std::string limit(const char* which) {
    alarm_ = deaf_ = true;
    left_mm_ = speed_ = 0;
    return std::string{which} + "\r\n[MSG:Reset to continue]\r\n";
  }
  [[nodiscard]] std::string list() const {
    std::string out;
    for (const auto& [which, value] : settings) out += "$" + std::to_string(which) + "=" + grbl_number(value) + "\r\n";
    return out;
  }
  [[nodiscard]] std::string set(const std::string& line) {
    const auto told = parse_grbl_setting(line);
    if (!told || !settings.contains(told->first)) return "error:3\r\n";
    const auto [which, value] = *told;
    if (left_mm_ != 0) return "error:8\r\n";
    if (value < 0) return "error:4\r\n";
    settings[which] = value;
    return "ok\r\n";
  }
  /// Blocks with relative X and F, as G21G91G1X-120.000F12000.000.
  [[nodiscard]] std::string motion(const std::string& line) {
    double x = 0, feed = 0;
    for (std::size_t i = 0; i < line.size();) {
      const char letter = line[i++];
      double value = 0;
      const auto [end, bad] = std::from_chars(line.data() + i, line.data() + line.size(), value);
      if (bad != std::errc{}) return "error:2\r\n";
      if (letter == 'X') x = value;
      else if (letter == 'F') feed = value;
      else if (letter != 'G' || (value != 1 && value != 21 && value != 91)) return "error:20\r\n";
      i = static_cast<std::size_t>(end - line.data());
    }
    if (feed <= 0) return "error:22\r\n";
    const double to = position_mm_ + left_mm_ + x;
    if (settings[20] == 1 && (to > 1e-6 || to < -settings[130] - 1e-6)) return limit("ALARM:2");
    left_mm_ += x;
    feed_ = std::min(feed, settings[110]) / 60;
    ++strokes_;
    return "ok\r\n";
  }

  std::string line_;
  double clock_s_ = 0, position_mm_ = 0, left_mm_ = 0, speed_ = 0, feed_ = 0;  ///< mm, mm/s
  double next_report_s_ = 0;
  std::optional<double> homed_at_s_;                  ///< it homes until then
  bool hold_ = false, alarm_ = false, deaf_ = false;  ///< deaf: until a reset
  int strokes_ = 0;
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
