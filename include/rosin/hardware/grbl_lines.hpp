// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a controller says, cut into lines, however the bytes come: a line may arrive in pieces, and a status report may stand in
// the middle of another line, as controllers put it on the wire the moment that it is asked for:
//
//     $110=60<Idle|MPos:0.000,0.000,0.000|FS:0,0>\r\n000.000\r\n     ──▶     <Idle|…>     $110=60000.000
//
// Bytes that are no text are left out; nothing that comes makes it grow.
//
#pragma once

#include <rosin/hardware/grbl_protocol.hpp>

#include <cstdint>
#include <deque>
#include <span>

namespace rosin {

class grbl_lines {
public:
  static constexpr std::size_t longest = 512;  ///< characters of one line; what is longer is dropped

  void push(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) push(static_cast<char>(byte));
  }
  /// The next line that is whole and not empty.
  [[nodiscard]] std::optional<std::string> next() {
    if (ready_.empty()) return std::nullopt;
    std::string out = std::move(ready_.front());
    ready_.pop_front();
    return out;
  }
  /// Forgets what has come, whole or not.
  void clear() noexcept {
    ready_.clear();
    line_.clear();
    opened_ = std::string::npos;
    behind_report_ = overlong_ = false;
  }

private:
  void push(char c) {
    if (c == '\r') return;
    if (c == '\n') return end_of_line();
    if (c < ' ' || c > '~') return;
    behind_report_ = false;
    if (line_.size() >= longest) overlong_ = true;
    if (overlong_) return;
    if (c == '<') opened_ = line_.size();
    line_ += c;
    if (c == '>' && opened_ != std::string::npos) end_of_report();
  }
  void end_of_report() {
    if (parse_grbl_status(std::string_view{line_}.substr(opened_))) {
      put(line_.substr(opened_));
      line_.erase(opened_);
      behind_report_ = true;  // the end of line that follows is the report's
    }
    opened_ = std::string::npos;
  }
  void end_of_line() {
    if (std::exchange(behind_report_, false)) return;
    const auto first = line_.find_first_not_of(' ');
    if (first != std::string::npos && !overlong_) put(line_.substr(first, line_.find_last_not_of(' ') + 1 - first));
    line_.clear();
    opened_ = std::string::npos;
    overlong_ = false;
  }
  void put(std::string line) {
    if (ready_.size() >= 1024) ready_.pop_front();
    ready_.push_back(std::move(line));
  }

  std::deque<std::string> ready_;
  std::string line_;
  std::size_t opened_ = std::string::npos;  ///< where a '<' stands in the line
  bool behind_report_ = false, overlong_ = false;
};

}  // namespace rosin
