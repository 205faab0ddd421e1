// tier: hosted
// SPDX-License-Identifier: MIT
//
// Tables to and from text: comma-separated, comment lines (#) above one header line, a point as decimal mark whatever the
// locale says, an empty field where a value is unknown (NaN). A comment of several lines becomes one line; a name that holds a comma or
// a quote stands in quotes, which are doubled within (RFC 4180).
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/number_text.hpp>
#include <rosin/report/input_file.hpp>
#include <rosin/report/output_file.hpp>
#include <rosin/report/table.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <ostream>
#include <sstream>
#include <string_view>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A field of the header line, in quotes where it has to be.
[[nodiscard]] inline std::string csv_name(const std::string& name) {
  const std::string line = one_line(name);
  if (line.find_first_of(",\"") == std::string::npos && !line.starts_with('#') && !line.starts_with(' ') && !line.ends_with(' '))
    return line;
  std::string out = "\"";
  for (const char c : line) out += c == '"' ? std::string{"\"\""} : std::string{c};
  return out + "\"";
}

inline void write_csv(std::ostream& out, const table& data) {
  for (const auto& line : data.comments) out << "# " << one_line(line) << '\n';
  for (std::size_t c = 0; c < data.columns.size(); ++c) out << (c > 0 ? "," : "") << csv_name(data.columns[c].name);
  std::string text = "\n";
  for (std::size_t row = 0; row < data.rows(); ++row) {
    for (std::size_t c = 0; c < data.columns.size(); ++c) {
      std::array<char, 40> digits{};
      const double x = data.columns[c].values[row];
      if (c > 0) text += ',';
      if (std::isnan(x)) continue;
      const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), x, std::chars_format::general,
                                     std::clamp(data.columns[c].digits, 1, 17));
      text.append(digits.data(), end.ptr);
    }
    text += '\n';
    if (text.size() > 60000) out << std::exchange(text, std::string{});
  }
  out << text;
}

[[nodiscard]] inline std::optional<failure> save_csv(const std::string& path, const table& data, overwrite existing) {
  if (!data.is_rectangular()) return failure{path + ": the columns are not of one length"};
  return write_file(path, existing, [&](std::ostream& out) { write_csv(out, data); });
}

namespace detail {

/// Without white space around it.
[[nodiscard]] inline std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view blank = " \t\r";
  const auto first = text.find_first_not_of(blank);
  return first == std::string_view::npos ? std::string_view{} : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// What stands between quotes, the doubled ones within made single.
[[nodiscard]] inline std::string unquoted(std::string_view field) {
  if (field.size() < 2 || field.front() != '"' || field.back() != '"') return std::string{field};
  std::string out;
  for (std::size_t i = 1; i + 1 < field.size(); ++i)
    if (out += field[i]; field[i] == '"' && field[i + 1] == '"' && i + 2 < field.size()) ++i;
  return out;
}

/// Calls use(index, field) for each field of a line, which may stand in quotes; the number of fields.
template <class Use>
std::size_t each_field(std::string_view line, Use use) {
  std::size_t index = 0;
  for (;; ++index) {
    std::size_t comma = 0;
    for (bool quoted = false; comma < line.size() && (quoted || line[comma] != ','); ++comma) quoted ^= line[comma] == '"';
    use(index, trimmed(line.substr(0, comma)));
    if (comma == line.size()) return index + 1;
    line.remove_prefix(comma + 1);
  }
}

/// Empty or "nan": NaN. Nothing at all: no number.
[[nodiscard]] inline std::optional<double> field_value(std::string_view field) noexcept {
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = trimmed(field.substr(1, field.size() - 2));
  return field.empty() ? std::numeric_limits<double>::quiet_NaN() : number_from(field);
}

/// One row into the columns; what is wrong with it, if anything.
[[nodiscard]] inline std::string read_csv_row(std::string_view line, table& data) {
  std::string wrong;
  const std::size_t count = each_field(line, [&](std::size_t c, std::string_view field) {
    const auto value = field_value(field);
    if (!value && wrong.empty()) wrong = "\"" + std::string{field.substr(0, 40)} + "\" is not a number";
    if (c < data.columns.size()) data.columns[c].values.push_back(value.value_or(0));
  });
  if (count != data.columns.size())
    wrong = "has " + std::to_string(count) + " fields, the header has " + std::to_string(data.columns.size());
  return wrong;
}

}  // namespace detail

/// The table in a stream; `name` stands in the messages. max_rows: how much of it is wanted.
[[nodiscard]] inline outcome<table> read_csv(std::istream& in, const std::string& name,
                                             std::size_t max_rows = std::numeric_limits<std::size_t>::max()) {
  table data;
  std::string line;
  for (int number = 1; data.rows() < max_rows && std::getline(in, line); ++number) {
    std::string_view text = line;
    if (number == 1 && text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    if (detail::trimmed(text).empty() && data.columns.size() != 1) continue;  // of one column, an empty line is a row
    if (text.starts_with('#')) {
      data.comments.emplace_back(detail::trimmed(text.substr(1)));
    } else if (data.columns.empty()) {
      detail::each_field(text, [&](std::size_t, std::string_view field) { data.add(detail::unquoted(field), {}); });
    } else if (const auto wrong = detail::read_csv_row(text, data); !wrong.empty()) {
      return failure{name + ":" + std::to_string(number) + ": " + wrong};
    }
  }
  if (data.columns.empty()) return failure{name + ": holds no header line"};
  return data;
}

[[nodiscard]] inline outcome<table> read_csv(const std::string& path) {
  auto text = read_file(path);
  if (!text) return failure{text.error()};
  std::istringstream in{*std::move(text)};
  return read_csv(in, path);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
