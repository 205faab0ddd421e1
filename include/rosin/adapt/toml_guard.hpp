// tier: hosted
// SPDX-License-Identifier: MIT
//
// Malformed text that toml++ 3.3 does not report but stumbles over: a table header that does not begin with a key (its
// issue 294, in 3.4 too), brackets that close nothing, control characters, letters beyond ASCII outside of strings and
// comments (an unreachable branch of its tables is reached). All found by fuzzing, and looked for before toml++ sees the text.
//
// To know a header from a list that spans lines, strings, comments and brackets are followed through the text:
//
//     a header is [ or [[ at the beginning of a line outside of brackets and strings;
//     a string begins where a key or a value may: at the beginning of a line, after = , [ { and .
//
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace rosin {

struct toml_fault {
  int line = 0;
  std::string reason;
};

namespace detail {

class toml_scanner {
public:
  explicit toml_scanner(std::string_view text) noexcept : text_{text}, at_{text.starts_with("\xef\xbb\xbf") ? 3U : 0U} {}

  /// The first fault, if there is one.
  [[nodiscard]] std::optional<toml_fault> fault() {
    for (; !at_end(); ++at_) {
      const char c = now();
      if (c == '\n') {
        ++line_;
        last_ = '\n';
      } else if (c == '#') {
        skip_comment();
      } else if (c != ' ' && c != '\t' && c != '\r') {
        if (auto reason = reason_against(c); !reason.empty()) return toml_fault{line_, std::move(reason)};
        last_ = c;
        if (c == '"' || c == '\'') skip_string(c);
      }
    }
    return std::nullopt;
  }

private:
  [[nodiscard]] bool at_end() const noexcept { return at_ >= text_.size(); }
  [[nodiscard]] char now() const noexcept { return text_[at_]; }
  [[nodiscard]] bool follows(std::string_view what) const noexcept { return text_.substr(at_).starts_with(what); }

  [[nodiscard]] std::size_t after_blanks(std::size_t i) const noexcept {
    while (i < text_.size() && (text_[i] == ' ' || text_[i] == '\t')) ++i;
    return i;
  }
  /// What speaks against this character here, if anything does.
  [[nodiscard]] std::string reason_against(char c) {
    if (static_cast<unsigned char>(c) > 0x7f) return "a character beyond ASCII, which TOML allows in strings and comments only";
    if ((c == '"' || c == '\'') && std::string_view{"\n=,[{."}.find(last_) == std::string_view::npos)
      return "a quote in the middle of something else";
    if (c == '[' && last_ == '\n' && open_.empty() && !header_is_sound())
      return "the header of a table has to begin with a key, as [string]";
    if (!follow_brackets(c)) return std::string{"a "} + c + " that closes nothing";
    return {};
  }
  /// False at a bracket that closes what was not opened.
  [[nodiscard]] bool follow_brackets(char c) {
    if (c == '[') open_ += ']';
    if (c == '{') open_ += '}';
    if (c != ']' && c != '}') return true;
    if (open_.empty() || open_.back() != c) return false;
    open_.pop_back();
    return true;
  }
  /// A key begins after [ or [[; a closing bracket and the end of the text are reported by toml++.
  [[nodiscard]] bool header_is_sound() const noexcept {
    std::size_t i = after_blanks(at_ + 1);
    if (i < text_.size() && text_[i] == '[') i = after_blanks(i + 1);
    if (i >= text_.size()) return true;
    const char c = text_[i];
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    return letter || c == '_' || c == '-' || c == '"' || c == '\'' || c == ']';
  }
  /// Up to the line break, which is left to the caller.
  void skip_comment() noexcept {
    while (at_ + 1 < text_.size() && text_[at_ + 1] != '\n') ++at_;
  }
  /// To the closing quote; a string of one line ends with its line at the latest.
  void skip_string(char quote) noexcept {
    const std::string_view triple = quote == '"' ? "\"\"\"" : "'''";
    const bool many = follows(triple);
    for (at_ += many ? 3 : 1; !at_end(); ++at_) {
      if (now() == '\\' && quote == '"' && at_ + 1 < text_.size()) ++at_;
      else if (many ? follows(triple) : now() == quote) break;
      if (!at_end() && now() == '\n') {
        if (!many) {
          --at_;
          return;
        }
        ++line_;
      }
    }
    if (!many) return;
    at_ += 2;
    for (int extra = 0; extra < 2 && at_ + 1 < text_.size() && text_[at_ + 1] == quote; ++extra) ++at_;  // quotes at its end
  }

  std::string_view text_;
  std::size_t at_;
  int line_ = 1;
  char last_ = '\n';  // the last character that was no blank
  std::string open_;  // the brackets that are open, as the ones that will close them
};

/// Line of the first control character that TOML does not allow, 0 if there is none.
[[nodiscard]] inline int line_of_control_character(std::string_view text) noexcept {
  int line = 1;
  for (const char c : text) {
    if (c == '\n') ++line;
    else if ((static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\r') || c == 0x7f) return line;
  }
  return 0;
}

}  // namespace detail

/// What is wrong with the text, if it is one of the things that must not reach toml++.
[[nodiscard]] inline std::optional<toml_fault> find_toml_fault(std::string_view text) {
  if (const int line = detail::line_of_control_character(text); line > 0)
    return toml_fault{line, "holds a control character, so it is no TOML"};
  return detail::toml_scanner{text}.fault();
}

}  // namespace rosin
