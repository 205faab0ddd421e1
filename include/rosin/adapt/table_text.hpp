// tier: hosted
// SPDX-License-Identifier: MIT
//
// A table of numbers as laboratories export it: columns between commas, semicolons or tabs, with a header line or without, lines
// that end in any way. Unlike a result (report/csv.hpp) a recording has a number in every place, so whatever is not one is
// reported by line, column and reason. A decimal comma is never guessed at, also where it hides behind commas between columns.
// std::from_chars reads 15 MB in a tenth of a second; libstdc++'s is the fast_float library itself.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/report/table.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A table and where its rows stand in the file.
struct number_table {
  table data;                                      ///< names are empty where the file has none
  std::vector<std::pair<std::size_t, int>> lines;  ///< (row, its line) wherever lines were skipped; empty: not a text

  /// "a.csv:17" or "a.npy: row 17", for messages.
  [[nodiscard]] std::string place_of(const std::string& file, std::size_t row) const {
    if (lines.empty()) return file + ": row " + std::to_string(row + 1);
    auto at = std::upper_bound(lines.begin(), lines.end(), row, [](std::size_t r, const auto& p) { return r < p.first; });
    if (at != lines.begin()) --at;
    return file + ":" + std::to_string(at->second + static_cast<int>(row - at->first));
  }
};

/// "column 3 (index 2)", "column 3 (force_N)": people count from one, rig files from zero.
[[nodiscard]] inline std::string column_text(const table& data, std::size_t column) {
  const bool named = column < data.columns.size() && !data.columns[column].name.empty();
  return "column " + std::to_string(column + 1) + " (" + (named ? data.columns[column].name : "index " + std::to_string(column)) +
         ")";
}

inline constexpr std::size_t all_rows = std::numeric_limits<std::size_t>::max();

/// Of a container of variables, those that are as long as the longest; fails where there are none, or one holds no number.
[[nodiscard]] inline outcome<number_table> keep_longest(std::vector<table_column> all, const std::string& name,
                                                        std::size_t max_rows) {
  std::size_t longest = 0;
  for (const auto& c : all) longest = std::max(longest, c.values.size());
  number_table out;
  for (auto& c : all)
    if (c.values.size() == longest) out.data.columns.push_back(std::move(c));
  if (longest == 0) return failure{name + ": holds no column of real numbers"};
  for (std::size_t c = 0; c < out.data.columns.size(); ++c) {
    auto& values = out.data.columns[c].values;
    const auto bad = std::find_if_not(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
    if (bad != values.end())
      return failure{out.place_of(name, static_cast<std::size_t>(bad - values.begin())) + ": " + column_text(out.data, c) +
                     ": is no finite number"};
    values.resize(std::min(longest, max_rows));
  }
  return out;
}

namespace detail {

class table_text_parser {
public:
  table_text_parser(std::string_view text, const std::string& name, std::size_t max_rows)
      : at_{text.data()}, end_{text.data() + text.size()}, name_{name}, max_rows_{max_rows} {}

  [[nodiscard]] outcome<number_table> operator()() {
    const std::string_view all = rest();
    if (all.starts_with("\xef\xbb\xbf")) at_ += 3;
    if (all.starts_with("\xff\xfe") || all.starts_with("\xfe\xff"))
      return failure{name_ + ": is a text in UTF-16: export it as plain text (UTF-8)"};
    if (const auto zero = all.substr(0, 4096).find('\0'); zero != std::string_view::npos)
      return failure{name_ + ": is no text: byte " + std::to_string(zero + 1) + " is zero"};
    while (wrong_.empty() && at_ != end_ && rows_ < max_rows_) line();
    if (wrong_.empty() && rows_ == 0) return failure{name_ + ": holds no numbers"};
    if (!wrong_.empty()) return failure{name_ + ":" + std::to_string(line_) + ": " + wrong_};
    return std::move(out_);
  }

private:
  static bool is_end(char c) noexcept { return c == '\n' || c == '\r'; }
  static bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
  static bool is_like_number(std::string_view field) noexcept {
    for (const char* odd : {"nan", "NaN", "NAN", "inf", "-inf", "-nan"})
      if (field == odd) return true;
    return field.find_first_of("0123456789") != std::string_view::npos &&
           field.find_first_not_of("0123456789+-.,eE") == std::string_view::npos;
  }
  [[nodiscard]] bool is_blank(char c) const noexcept { return (c == ' ' || c == '\t' || c == '"') && c != separator_; }
  [[nodiscard]] std::string_view rest() const noexcept { return {at_, static_cast<std::size_t>(end_ - at_)}; }
  /// From here to the end of the line.
  [[nodiscard]] std::string_view text_of_line() const noexcept { return {at_, static_cast<std::size_t>(line_end() - at_)}; }
  [[nodiscard]] const char* line_end() const noexcept { return std::find_if(at_, end_, is_end); }
  void skip_blanks() noexcept {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  void finish_line() noexcept {
    at_ = line_end();
    if (at_ != end_ && *at_ == '\r') ++at_, at_ += at_ != end_ && *at_ == '\n' ? 1 : 0;
    else if (at_ != end_) ++at_;
  }

  void line() {
    ++line_;
    const char* begin = at_;
    skip_blanks();
    const bool empty = at_ == end_ || is_end(*at_);
    if (empty && out_.data.columns.size() == 1 && rest().find_first_not_of(" \t\r\n") != std::string_view::npos)
      wrong_ = column_text(out_.data, 0) + ": is empty";
    else if (!empty && (*at_ == '#' || *at_ == '%')) out_.data.comments.emplace_back(text_of_line().substr(1));
    else if (!empty) at_ = begin, content();
    if (wrong_.empty()) finish_line();
  }

  void content() {
    if (out_.data.columns.empty()) {
      begin_table();
      if (header_ || !wrong_.empty()) return;
    }
    if (out_.lines.empty() || out_.lines.back().second + static_cast<int>(rows_ - out_.lines.back().first) != line_)
      out_.lines.emplace_back(rows_, line_);
    row();
  }

  /// The first line that is not empty: how many columns, between what, and whether it names them.
  void begin_table() {
    const std::string_view text = text_of_line();
    for (const char c : {',', ';', '\t'})
      if (text.find(c) != std::string_view::npos) separator_ = c;
    std::vector<std::string> names;
    bool numbers = false;
    for (std::string_view left = text;; left.remove_prefix(left.find(separator_) + 1)) {
      std::string_view field = left.substr(0, left.find(separator_));
      while (!field.empty() && is_blank(field.front())) field.remove_prefix(1);
      while (!field.empty() && is_blank(field.back())) field.remove_suffix(1);
      names.emplace_back(field.substr(0, 200));
      numbers = numbers || is_like_number(field);
      if (left.find(separator_) == std::string_view::npos) break;
    }
    whole_ = separator_ == ',' && text.find('.') == std::string_view::npos;
    if (names.size() > 1 && names.back().empty()) names.pop_back(), closed_ = true;
    header_ = !numbers;
    if (names.size() > 1024) wrong_ = "has " + std::to_string(names.size()) + " columns";
    const std::size_t rows = std::min<std::size_t>(max_rows_, rest().size() / (text.size() + 1) + 1);
    for (auto& name : names) {
      out_.data.add(header_ ? name : std::string{}, {});
      if (!header_) out_.data.columns.back().values.reserve(rows + rows / 16);
    }
    row_.resize(names.size());
  }

  void row() {
    header_ = false;
    const char* begin = at_;
    std::size_t column = 0;
    for (;; ++column) {
      skip_blanks();
      const bool last = at_ == end_ || is_end(*at_);
      if (closed_ && last && column == row_.size()) break;
      if (column >= row_.size() || !number(row_[column])) return explain(begin, column);
      skip_blanks();
      if (at_ == end_ || is_end(*at_)) {
        ++column;
        break;
      }
      if (*at_ != separator_) return explain(begin, column);
      ++at_;
    }
    if (column != row_.size()) return explain(begin, column);
    if (padded_ && hides_decimal_commas(begin)) return refuse_decimal_commas();
    for (std::size_t c = 0; c < row_.size(); ++c) out_.data.columns[c].values.push_back(row_[c]);
    ++rows_;
  }

  [[nodiscard]] bool number(double& to) noexcept {
    if (at_ != end_ && *at_ == '+') ++at_;
    padded_ = padded_ || (end_ - at_ > 1 && *at_ == '0' && is_digit(at_[1]));
    const auto got = std::from_chars(at_, end_, to);
    if (got.ec == std::errc::result_out_of_range) {  // too small to matter, or too large for any sensor
      const std::string_view text{at_, static_cast<std::size_t>(got.ptr - at_)};
      if (text.find("e-") == std::string_view::npos && text.find("E-") == std::string_view::npos) return false;
      to = 0;
    } else if (got.ec != std::errc{} || !std::isfinite(to)) {
      return false;
    }
    at_ = got.ptr;
    return true;
  }

  /// 0,045,1,25: a field with a superfluous zero in front, an even number of fields, no point anywhere.
  [[nodiscard]] bool hides_decimal_commas(const char* begin) noexcept {
    padded_ = false;
    const std::string_view text{begin, static_cast<std::size_t>(std::find_if(begin, end_, is_end) - begin)};
    return separator_ == ',' && text.find('.') == std::string_view::npos && std::count(text.begin(), text.end(), ',') % 2 == 1;
  }

  void refuse_decimal_commas() {
    wrong_ = "seems to have decimal commas between columns that commas separate: export it with points";
  }

  /// What is wrong with the row that begins here, and in which column.
  void explain(const char* begin, std::size_t column) {
    const std::string_view text{begin, static_cast<std::size_t>(std::find_if(begin, end_, is_end) - begin)};
    const auto fields = static_cast<std::size_t>(std::count(text.begin(), text.end(), separator_)) + 1;
    if (fields == 2 * row_.size() && hides_decimal_commas(begin)) return refuse_decimal_commas();
    std::string_view field = text;
    for (std::size_t c = 0; c < column && field.find(separator_) != std::string_view::npos; ++c)
      field.remove_prefix(field.find(separator_) + 1);
    field = field.substr(0, field.find(separator_));
    while (!field.empty() && is_blank(field.front())) field.remove_prefix(1);
    while (!field.empty() && is_blank(field.back())) field.remove_suffix(1);
    const std::size_t wanted = row_.size() + (closed_ ? 1 : 0);
    if (fields != wanted && (column >= row_.size() || column >= fields || field.empty()))
      wrong_ = "has " + std::to_string(fields) + " column(s), the first line has " + std::to_string(wanted) +
               (whole_ && text.find('.') == std::string_view::npos ? "; if its numbers have decimal commas, export it with points"
                                                                   : "");
    else wrong_ = column_text(out_.data, column) + ": " + reason(field);
  }

  [[nodiscard]] static std::string reason(std::string_view field) {
    if (field.empty()) return "is empty";
    std::string shown{field.substr(0, 40)};
    for (char& c : shown)
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    const std::string quoted = "\"" + shown + "\" ";
    std::string lower = shown;
    for (char& c : lower)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const std::string_view bare = std::string_view{lower}.substr(lower.find_first_not_of("+-") == 1 ? 1 : 0);
    if (bare.starts_with("nan") || bare.starts_with("inf")) return quoted + "is no finite number";
    if (shown.find_first_not_of("0123456789+-,eE") == std::string::npos && shown.find(',') != std::string::npos)
      return quoted + "has a decimal comma: export the table with points";
    if (shown.find_first_not_of("0123456789+-.eE \"") == std::string::npos)
      return quoted + (shown.find(' ') == std::string::npos
                           ? "is too large for a number"
                           : "is not a number: columns are separated by commas, semicolons or tabs");
    return quoted + "is not a number";
  }

  const char *at_, *end_;
  const std::string& name_;
  std::size_t max_rows_, rows_ = 0;
  char separator_ = ',';
  bool header_ = false, closed_ = false, padded_ = false,
       whole_ = false;  ///< closed: a separator ends each line; whole: no point in the first
  int line_ = 0;
  std::vector<double> row_;
  std::string wrong_;
  number_table out_;
};

/// The file, or its first bytes up to the end of a line.
[[nodiscard]] inline outcome<std::string> read_bytes(const std::string& path, std::uintmax_t limit) {
  std::error_code error;
  const std::filesystem::path file{path};
  if (!std::filesystem::exists(file, error)) return failure{path + ": no such file"};
  if (std::filesystem::is_directory(file, error)) return failure{path + ": is a folder"};
  const auto size = std::filesystem::file_size(file, error);
  if (error) return failure{path + ": " + error.message()};
  if (size == 0) return failure{path + ": is empty"};
  if (size > (std::uintmax_t{1} << 32)) return failure{path + ": is larger than 4 GB: no single take is"};
  std::string text(static_cast<std::size_t>(std::min(size, limit)), '\0');
  std::ifstream in{path, std::ios::binary};
  if (!in || !in.read(text.data(), static_cast<std::streamsize>(text.size()))) return failure{path + ": cannot be read"};
  if (text.size() < size)
    if (const auto end = text.find_last_of("\r\n"); end != std::string::npos) text.resize(end);
  return text;
}

}  // namespace detail

/// The table in a text; `name` stands in the messages. max_rows: how much of it is wanted.
[[nodiscard]] inline outcome<number_table> parse_table_text(std::string_view text, const std::string& name,
                                                            std::size_t max_rows = all_rows) {
  return detail::table_text_parser{text, name, max_rows}();
}

/// The table in a file; only the beginning of the file is read where few rows are wanted.
[[nodiscard]] inline outcome<number_table> read_table_text(const std::string& path, std::size_t max_rows = all_rows) {
  const auto text = detail::read_bytes(path, max_rows == all_rows ? ~std::uintmax_t{0} : 16384 + std::uintmax_t{256} * max_rows);
  if (!text) return failure{text.error()};
  return parse_table_text(*text, path, max_rows);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
