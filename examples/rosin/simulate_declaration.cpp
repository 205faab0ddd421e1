// SPDX-License-Identifier: MIT
#include "simulate_declaration.hpp"

#include <rosin/adapt/rig_toml.hpp>
#include <rosin/version.hpp>

#include <algorithm>
#include <locale>
#include <set>
#include <sstream>

namespace tool {

namespace {

using line_number = std::size_t;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in{text};
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

char first_character(const std::string& line) {
  const auto at = line.find_first_not_of(" \t\r");
  return at == std::string::npos ? '\0' : line[at];
}

/// The lines of a value, of all values in a table, and of the table's header.
void add_lines(const toml::node& node, std::set<line_number>& lines) {
  const auto& source = node.source();
  const auto* table = node.as_table();
  const line_number last = table != nullptr && !table->is_inline() ? source.begin.line : source.end.line;
  for (line_number i = source.begin.line; i > 0 && i <= last; ++i) lines.insert(i);
  if (table != nullptr)
    for (const auto& [key, value] : *table) add_lines(value, lines);
}

/// A section begins with the comment above its header, and ends where the next one begins.
void add_rest_of_section(const std::vector<std::string>& text, std::set<line_number>& lines) {
  while (*lines.begin() > 1 && first_character(text[*lines.begin() - 2]) == '#') lines.insert(*lines.begin() - 1);
  line_number next = *lines.rbegin() + 1;  // lines count from 1
  while (next <= text.size() && first_character(text[next - 1]) != '[') ++next;
  while (next <= text.size() && next > *lines.rbegin() + 1 && first_character(text[next - 2]) == '#') --next;
  for (line_number i = *lines.rbegin() + 1; i < next; ++i) lines.insert(i);
}

void erase_starts(toml::table& root, std::set<line_number>& lines) {
  auto* takes = root["take"].as_array();
  for (std::size_t i = 0; takes != nullptr && i < takes->size(); ++i) {
    auto* take = takes->get(i)->as_table();
    if (take == nullptr || !take->contains("start_s")) continue;
    add_lines(*take->get("start_s"), lines);
    take->erase("start_s");
  }
}

/// Erases what nobody may know; the lines where it stood.
std::set<line_number> erase_secrets(toml::table& root, const std::vector<std::string>& text) {
  std::set<line_number> all;
  erase_starts(root, all);
  for (const char* key : {"simulate", "friction"}) {
    std::set<line_number> lines;
    const auto* table = root.get_as<toml::table>(key);
    if (table == nullptr) continue;
    add_lines(*table, lines);
    const bool headed = !table->is_inline() && !lines.empty() && first_character(text.at(*lines.begin() - 1)) == '[';
    if (headed) add_rest_of_section(text, lines);
    all.merge(lines);
    root.erase(key);
  }
  return all;
}

}  // namespace

rosin::outcome<std::string> declaration(const std::string& text, const std::string& file) {
  auto parsed = rosin::detail::parse_toml(text, file);
  if (!parsed) return rosin::failure{parsed.error()};
  toml::table root = *std::move(parsed);
  const auto lines = lines_of(text);
  const auto secret = erase_secrets(root, lines);
  const std::string head = "# The recordings beside this file were simulated by rosin " ROSIN_VERSION_STRING ".\n";
  std::string out = head;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!secret.contains(i + 1)) out += lines[i] + "\n";
  // Where tables share lines (inline ones), leaving out lines leaves out too much: then it is written anew.
  const auto again = rosin::detail::parse_toml(out, file);
  if (again && *again == root) return out;
  std::ostringstream anew;
  anew.imbue(std::locale::classic());
  anew << head << root << '\n';
  return anew.str();
}

}  // namespace tool
