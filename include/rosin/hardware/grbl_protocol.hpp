// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a controller of GRBL's dialect says, line by line: <Run|MPos:-12.500,0.000,0.000|FS:12000,0>, $110=500.000, error:9,
// ALARM:1; and numbers as it reads them. The dialects differ: place of the machine (MPos) or of the work (WPos, and now and then
// WCO, the offset between them: MPos = WPos + WCO), commas instead of bars (GRBL 0.9), settings with a comment, greetings. None
// of it depends on the locale of the program.
//
#pragma once

#include <rosin/hardware/frames.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
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
  if (word == "Hold" || word == "Door" || word == "Tool") return motion_state::holding;
  if (word == "Alarm") return motion_state::alarm;
  return std::nullopt;
}

template <std::size_t N>
[[nodiscard]] std::string meaning(std::string_view line, std::string_view mark, const std::array<std::string_view, N>& words) {
  const auto told = leading_number(line.substr(mark.size()));
  if (!told) return std::string{line};  // some dialects say it in words themselves
  const double number = *told;
  const auto index = static_cast<std::size_t>(number > 0 && number < static_cast<double>(N) ? number : 0);
  return std::string{line} + " (" + std::string{words[index]} + ")";
}

}  // namespace detail

/// A number for a controller, with three decimals.
[[nodiscard]] inline std::string grbl_number(double x) {
  std::array<char, 340> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::fixed, 3);
  return {text.data(), end.ptr};
}

/// A status report, lengths in its own unit: millimetres, or inches with $13=1.
struct grbl_report {
  std::string word;                             ///< of the state, as it stands there
  std::optional<motion_state> state;            ///< nothing: a word that is not known
  bool at_rest = false, homing = false;         ///< Hold:0; Home
  std::optional<double> machine, work, offset;  ///< MPos, WPos, WCO of the axis X; one of the first two is there
  std::optional<double> feed;                   ///< a minute
};

/// Nothing where the line is no report.
[[nodiscard]] inline std::optional<grbl_report> parse_grbl_status(std::string_view line) {
  if (line.size() < 3 || line.front() != '<' || line.back() != '>') return std::nullopt;
  line = line.substr(1, line.size() - 2);
  const std::string_view state = line.substr(0, line.find_first_of("|,")), word = state.substr(0, state.find(':'));
  grbl_report out;
  out.word = word;
  out.state = detail::state_of(word);
  out.at_rest = state == "Hold:0" || state == "Door:0" || state == "Door:1";
  out.homing = word == "Home";
  out.machine = detail::number_behind(line, "MPos:");
  out.work = detail::number_behind(line, "WPos:");
  out.offset = detail::number_behind(line, "WCO:");
  out.feed = detail::number_behind(line, line.find("|FS:") != std::string_view::npos ? "|FS:" : "|F:");
  return out.machine || out.work ? std::optional{out} : std::nullopt;
}

/// "Grbl 1.1h ['$' for help]", "GrblHAL 1.1f [...", "Grbl 3.6 [FluidNC v3.6.8 ...": it has started anew.
[[nodiscard]] inline bool is_grbl_greeting(std::string_view line) noexcept {
  constexpr std::string_view name = "grbl";
  return line.size() > name.size() && std::equal(name.begin(), name.end(), line.begin(), [](char a, char b) {
           return a == (b >= 'A' && b <= 'Z' ? static_cast<char>(b - 'A' + 'a') : b);
         });
}

/// $number=value, and perhaps a comment behind it.
[[nodiscard]] inline std::optional<std::pair<int, double>> parse_grbl_setting(std::string_view line) noexcept {
  const auto equals = line.find('=');
  if (line.empty() || line.front() != '$' || equals == std::string_view::npos) return std::nullopt;
  const auto which = detail::leading_number(line.substr(1)), value = detail::leading_number(line.substr(equals + 1));
  if (!which || !value || *which < 0 || *which > 999) return std::nullopt;
  return std::pair{static_cast<int>(*which), *value};
}

/// In words, for people; nothing where the line is no error or alarm.
[[nodiscard]] inline std::optional<std::string> grbl_error(std::string_view line) {
  static constexpr std::array<std::string_view, 25> words{"unknown",
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
                                                          "laser mode needs PWM",
                                                          "unknown",
                                                          "unknown",
                                                          "a command that it does not know",
                                                          "commands that exclude each other",
                                                          "no feed rate",
                                                          "needs a whole number",
                                                          "two commands that need the axis"};
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
