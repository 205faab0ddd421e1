// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a GRBL 1.1 controller says, line by line: <Run|MPos:-12.500,0.000,0.000|FS:12000,0>, $110=500.000, error:9, ALARM:1.
// Speeds are in mm/min, places in mm.
//
#pragma once

#include <rosin/hardware/frames.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <utility>

namespace rosin {

namespace detail {

/// A number at the beginning of the text.
[[nodiscard]] inline std::optional<double> leading_number(std::string_view text) noexcept {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end != text.data() ? std::optional{value} : std::nullopt;
}

/// The number behind `mark` in a status report.
[[nodiscard]] inline std::optional<double> number_behind(std::string_view report, std::string_view mark) noexcept {
  const auto at = report.find(mark);
  return at == std::string_view::npos ? std::nullopt : leading_number(report.substr(at + mark.size()));
}

[[nodiscard]] inline std::optional<motion_state> state_of(std::string_view word) noexcept {
  if (word == "Idle" || word == "Check" || word == "Sleep") return motion_state::idle;
  if (word == "Run" || word == "Jog" || word == "Home") return motion_state::running;
  if (word == "Hold" || word == "Door") return motion_state::holding;
  if (word == "Alarm") return motion_state::alarm;
  return std::nullopt;
}

template <std::size_t N>
[[nodiscard]] std::string meaning(std::string_view line, std::string_view mark, const std::array<std::string_view, N>& words) {
  const auto number = leading_number(line.substr(mark.size())).value_or(0);
  const auto index = static_cast<std::size_t>(number > 0 && number < static_cast<double>(N) ? number : 0);
  return std::string{line} + " (" + std::string{words[index]} + ")";
}

}  // namespace detail

/// A status report; nothing where the line is none.
[[nodiscard]] inline std::optional<motion_status> parse_grbl_status(std::string_view line) {
  if (line.size() < 3 || line.front() != '<' || line.back() != '>') return std::nullopt;
  line = line.substr(1, line.size() - 2);
  const auto state = detail::state_of(line.substr(0, std::min(line.find('|'), line.find(':'))));
  const auto place = detail::number_behind(line, "|MPos:");
  if (!state || !place) return std::nullopt;
  const auto speed = detail::number_behind(line, line.find("|FS:") != std::string_view::npos ? "|FS:" : "|F:");
  return motion_status{*state, *place / 1e3, speed.value_or(0) / 60e3, {}};
}

/// $number=value
[[nodiscard]] inline std::optional<std::pair<int, double>> parse_grbl_setting(std::string_view line) noexcept {
  const auto equals = line.find('=');
  if (line.empty() || line.front() != '$' || equals == std::string_view::npos) return std::nullopt;
  const auto which = detail::leading_number(line.substr(1)), value = detail::leading_number(line.substr(equals + 1));
  if (!which || !value || *which < 0 || *which > 999) return std::nullopt;
  return std::pair{static_cast<int>(*which), *value};
}

/// In words, for people; nothing where the line is no error or alarm.
[[nodiscard]] inline std::optional<std::string> grbl_error(std::string_view line) {
  static constexpr std::array<std::string_view, 18> words{"unknown",
                                                          "no letter",
                                                          "no number",
                                                          "unknown setting",
                                                          "negative value",
                                                          "homing is not enabled",
                                                          "step pulse too short",
                                                          "settings could not be read",
                                                          "only while idle",
                                                          "locked by an alarm or a motion",
                                                          "soft limits need homing",
                                                          "line too long",
                                                          "step rate too high",
                                                          "door open",
                                                          "line too long to store",
                                                          "jog beyond the travel",
                                                          "not a jog command",
                                                          "laser mode needs PWM"};
  return line.starts_with("error:") ? std::optional{detail::meaning(line, "error:", words)} : std::nullopt;
}
[[nodiscard]] inline std::optional<std::string> grbl_alarm(std::string_view line) {
  static constexpr std::array<std::string_view, 10> words{"unknown",
                                                          "hard limit: the sled ran into its switch, its position is lost",
                                                          "soft limit: the motion would leave the travel",
                                                          "reset while moving: the position is lost",
                                                          "probe fail",
                                                          "probe fail",
                                                          "homing fail: reset",
                                                          "homing fail: door",
                                                          "homing fail: switch still pressed",
                                                          "homing fail: no switch found"};
  return line.starts_with("ALARM:") ? std::optional{detail::meaning(line, "ALARM:", words)} : std::nullopt;
}

}  // namespace rosin
