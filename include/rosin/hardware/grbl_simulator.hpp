// tier: hosted
// SPDX-License-Identifier: MIT
//
// A sled that is not there: what a GRBL 1.1 controller with one axis answers, and where the sled would be, as a function of a
// clock that the caller keeps. For tests, and for trying a session without the laboratory. Motion is a trapezoid of speed
//
//     v(t) = min(a t, v, a (T - t))
//
// A feed hold slows down with the same acceleration. The machine's coordinate runs from -travel (the far end) to 0, as GRBL's
// does.
//
#pragma once

#include <rosin/hardware/frames.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string_view>
#include <utility>

namespace rosin {

class grbl_simulator {
public:
  std::map<int, double> settings{{20, 1}, {21, 1}, {22, 0}, {110, 60000}, {120, 2000}, {130, 400}};
  double switch_mm = 1e9;  ///< a hard limit's switch that sits at a wrong place

  /// Bytes from the computer at the time now_s; the answer.
  [[nodiscard]] std::string receive(std::string_view bytes, double now_s) {
    std::string out = advance(now_s);
    for (const char c : bytes) {
      if (c == '?') out += report();
      else if (c == '!') hold_ = true;
      else if (c == '~') hold_ = false;
      else if (c == '\x18') out += reset();
      else if (c != '\n') line_ += c;
      else if (c == '\n') out += execute(std::exchange(line_, {}));
    }
    return out;
  }
  /// Time goes on; what the controller says by itself.
  [[nodiscard]] std::string advance(double now_s) {
    constexpr double step_s = 1e-4;
    for (; clock_s_ + step_s <= now_s; clock_s_ += step_s) {
      if (!move(step_s)) continue;
      alarm_ = true;
      left_mm_ = speed_ = 0;
      return "ALARM:1\r\n[MSG:Reset to continue]\r\n";
    }
    return {};
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
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "<%s|MPos:%.3f,0.000,0.000|FS:%.0f,0>\r\n", state, position_mm_, speed_ * 60);
    return text.data();
  }
  [[nodiscard]] std::string reset() {
    const bool fast = speed_ > 0;
    left_mm_ = speed_ = 0;
    hold_ = false;
    line_.clear();
    alarm_ = alarm_ || fast;
    return std::string{fast ? "ALARM:3\r\n" : ""} + "\r\nGrbl 1.1h ['$' for help]\r\n" +
           (alarm_ ? "[MSG:'$H'|'$X' to unlock]\r\n" : "");
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
    position_mm_ = left_mm_ = 0;
    return "ok\r\n";
  }
  [[nodiscard]] std::string list() const {
    std::string out;
    for (const auto& [which, value] : settings) {
      std::array<char, 48> text{};
      std::snprintf(text.data(), text.size(), "$%d=%.3f\r\n", which, value);
      out += text.data();
    }
    return out;
  }
  [[nodiscard]] std::string set(const std::string& line) {
    int which = 0;
    double value = 0;
    if (std::sscanf(line.c_str(), "$%d=%lf", &which, &value) != 2 || !settings.contains(which)) return "error:3\r\n";
    if (left_mm_ != 0) return "error:8\r\n";
    if (value < 0) return "error:4\r\n";
    settings[which] = value;
    return "ok\r\n";
  }
  /// Blocks with relative X and F, as G21G91G1X-120.000F12000.000.
  [[nodiscard]] std::string motion(const std::string& line) {
    double x = 0, feed = 0;
    for (std::size_t i = 0; i < line.size();) {
      char letter = 0;
      double value = 0;
      int used = 0;
      if (std::sscanf(line.c_str() + i, "%c%lf%n", &letter, &value, &used) != 2) return "error:2\r\n";
      if (letter == 'X') x = value;
      else if (letter == 'F') feed = value;
      else if (letter != 'G' || (value != 1 && value != 21 && value != 91)) return "error:20\r\n";
      i += static_cast<std::size_t>(used);
    }
    if (feed <= 0) return "error:22\r\n";
    const double to = position_mm_ + left_mm_ + x;
    if (settings[20] == 1 && (to > 1e-6 || to < -settings[130] - 1e-6))
      return alarm_ = true, "ALARM:2\r\n[MSG:Reset to continue]\r\n";
    left_mm_ += x;
    feed_ = std::min(feed, settings[110]) / 60;
    ++strokes_;
    return "ok\r\n";
  }

  std::string line_;
  double clock_s_ = 0, position_mm_ = 0, left_mm_ = 0, speed_ = 0, feed_ = 0;  ///< mm, mm/s
  bool hold_ = false, alarm_ = false;
  int strokes_ = 0;
};

}  // namespace rosin
