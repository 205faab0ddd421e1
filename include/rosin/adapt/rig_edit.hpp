// tier: hosted
// SPDX-License-Identifier: MIT
//
// One take more in a rig file that somebody has written: every line that was there stays as it is and where it is, comments too.
// The text is changed, not written anew from what it means; and the new text is parsed again before anybody gets it, and has to
// mean what the old one did and the take. Needs toml++ 3.
//
//     [[take]] ...          goes to the end of the file, where a table of any file may stand
//     take = [{...}, ...]   goes behind the last of the list
//
#pragma once

#include <rosin/adapt/rig_toml.hpp>

#include <algorithm>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A take as the rig file names it, whatever else it says.
struct named_take {
  std::string name, file;
};

namespace detail {

[[nodiscard]] inline std::vector<named_take> takes_of(const toml::table& root) {
  std::vector<named_take> out;
  const auto* list = root.get_as<toml::array>("take");
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i)
    if (const auto* one = list->get(i)->as_table())
      out.push_back({(*one)["name"].value_or(std::string{}), (*one)["file"].value_or(std::string{})});
  return out;
}

/// The byte at a line and column of toml++, which count characters from 1.
[[nodiscard]] inline std::size_t byte_at(std::string_view text, const toml::source_position& place) {
  std::size_t at = text.starts_with("\xef\xbb\xbf") ? 3 : 0;
  for (auto line = place.line; line > 1 && at < text.size(); ++at)
    if (text[at] == '\n') --line;
  for (auto column = place.column; column > 1 && at < text.size(); --column) {
    ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xc0U) == 0x80U) ++at;
  }
  return at;
}

/// "\n[[take]]\nkey = value\n..." as "{ key = value, ... }"; comments go.
[[nodiscard]] inline std::string as_inline_table(const std::string& block) {
  std::istringstream lines{block};
  std::string out;
  for (std::string line; std::getline(lines, line);)
    if (!line.empty() && line.front() != '[' && line.front() != '#') out += (out.empty() ? "{ " : ", ") + line;
  return out + " }";
}

/// With the line breaks of the file.
[[nodiscard]] inline std::string breaks_as_in(const std::string& text, const std::string& added) {
  if (text.find("\r\n") == std::string::npos) return added;
  std::string out;
  for (const char c : added) out += c == '\n' ? std::string{"\r\n"} : std::string{c};
  return out;
}

/// The text that ends with its last line.
[[nodiscard]] inline std::string with_last_break(const std::string& text) {
  return text.empty() || text.ends_with('\n') ? text : text + breaks_as_in(text, "\n");
}

[[nodiscard]] inline bool means(const std::string& text, const toml::table& wanted) {
  const auto root = parse_toml(text, "");
  return root && *root == wanted;
}

/// Behind the last element of a list in brackets.
[[nodiscard]] inline std::string behind_last(const std::string& text, const toml::array& list, const std::string& element) {
  const bool none = list.empty();
  const std::size_t at = none ? byte_at(text, list.source().begin) + 1 : byte_at(text, list.get(list.size() - 1)->source().end);
  return std::string{text}.insert(std::min(at, text.size()), breaks_as_in(text, (none ? "\n  " : ",\n  ") + element));
}

/// Last line of a table's values.
[[nodiscard]] inline std::size_t last_line_of(const toml::node& node) {
  std::size_t last = node.source().begin.line;
  const auto* table = node.as_table();
  if (table == nullptr || table->is_inline()) return std::max<std::size_t>(last, node.source().end.line);
  for (const auto& [key, value] : *table) last = std::max(last, last_line_of(value));
  return last;
}

}  // namespace detail

/// The takes that a text names, whether or not the rest of it is in order.
[[nodiscard]] inline outcome<std::vector<named_take>> find_named_takes(const std::string& text, const std::string& file) {
  const auto root = detail::parse_toml(text, file);
  if (!root) return failure{root.error()};
  return detail::takes_of(*root);
}

/// The text with a take more; `block` is "\n[[take]]\nname = ...\n" with a line for each key, and comments.
[[nodiscard]] inline outcome<std::string> with_take(const std::string& text, const std::string& block, const std::string& file) {
  const auto root = detail::parse_toml(text, file), added = detail::parse_toml(block, file);
  if (!root) return failure{root.error()};
  if (!added) return failure{added.error()};
  toml::table wanted = *root;
  if (!wanted.contains("take")) wanted.insert("take", toml::array{});
  auto* list = wanted.get_as<toml::array>("take");
  const auto* take = (*added)["take"][0].as_table();
  if (list == nullptr || take == nullptr) return failure{file + ": take: must be a list of tables, each headed [[take]]"};
  list->push_back(*take);
  std::string out = detail::with_last_break(text) + detail::breaks_as_in(text, block);
  if (detail::means(out, wanted)) return out;
  if (const auto* there = root->get_as<toml::array>("take")) {
    out = detail::behind_last(text, *there, detail::as_inline_table(block));
    if (detail::means(out, wanted)) return out;
  }
  return failure{file + ": take: stands there in a way that nothing can be added to; head each take with [[take]]"};
}

/// The text with comments below the take of this recording.
[[nodiscard]] inline outcome<std::string> with_remarks(const std::string& text, const std::string& recording,
                                                       const std::vector<std::string>& remarks, const std::string& file) {
  const auto root = detail::parse_toml(text, file);
  if (!root) return failure{root.error()};
  std::string comments;
  for (const auto& line : remarks) comments += "# " + line + '\n';
  comments = detail::breaks_as_in(text, comments);
  const std::string whole = detail::with_last_break(text);
  const auto* list = root->get_as<toml::array>("take");
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    const auto* take = list->get(i)->as_table();
    if (take == nullptr || (*take)["file"].value_or(std::string{}) != recording) continue;
    const toml::source_position below{static_cast<toml::source_index>(detail::last_line_of(*take) + 1), 1};
    std::string out = whole;
    out.insert(detail::byte_at(whole, below), comments);
    if (detail::means(out, *root)) return out;
  }
  return whole + comments;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
