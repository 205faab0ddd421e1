// tier: hosted
// SPDX-License-Identifier: MIT
//
// A NumPy file (.npy, formats 1.0 to 3.0) as a table: one axis is one column, of two axes the second one is the columns, fields of
// a structured array are columns with names. Real numbers of 1 to 8 bytes, whole or floating point, in either byte order and
// either order of axes; numpy.save writes them so, and rosin does (report/npy.hpp). Debian has no package that reads them.
//
#pragma once

#include <rosin/adapt/table_text.hpp>
#include <rosin/core/finite_math.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// One number of a NumPy file: kind 'f', 'i' or 'u', its bytes, and which of them comes first.
struct npy_number {
  char kind = 'f';
  std::size_t bytes = 8;
  bool big_endian = false;

  [[nodiscard]] static std::optional<npy_number> from(std::string_view code) noexcept {
    if (code.size() != 3) return std::nullopt;
    npy_number out{code[1], static_cast<std::size_t>(code[2] - '0'), code[0] == '>'};
    const bool known = out.bytes == 1 || out.bytes == 2 || out.bytes == 4 || out.bytes == 8;
    const bool real = out.kind == 'f' ? known && out.bytes >= 4 : (out.kind == 'i' || out.kind == 'u') && known;
    const bool order = code[0] == '<' || code[0] == '>' || (code[0] == '|' && out.bytes == 1);
    return real && order ? std::optional{out} : std::nullopt;
  }
  [[nodiscard]] double operator()(const char* from) const noexcept {
    std::uint64_t raw = 0;
    for (std::size_t i = 0; i < bytes; ++i)
      raw |= std::uint64_t{static_cast<unsigned char>(from[i])} << (8 * (big_endian ? bytes - 1 - i : i));
    if (kind == 'f')
      return bytes == 8 ? std::bit_cast<double>(raw) : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(raw)));
    if (kind == 'u') return static_cast<double>(raw);
    const auto shift = static_cast<unsigned>(64 - 8 * bytes);
    return static_cast<double>(static_cast<std::int64_t>(raw << shift) >> shift);
  }
};

/// What the head of the file says.
struct npy_layout {
  std::vector<npy_number> numbers;  ///< of a row's fields; one, where it has no fields
  std::vector<std::string> names;
  bool fortran = false;
  std::vector<std::size_t> shape;
  std::size_t data_offset = 0;

  [[nodiscard]] std::size_t rows() const noexcept { return shape.front(); }
  [[nodiscard]] std::size_t columns() const noexcept { return shape.size() == 2 ? shape[1] : numbers.size(); }
  [[nodiscard]] std::size_t row_bytes() const noexcept {
    std::size_t sum = 0;
    for (const auto& n : numbers) sum += n.bytes;
    return shape.size() == 2 ? sum * shape[1] : sum;
  }
};

/// Reads {'descr': ..., 'fortran_order': ..., 'shape': ...} as Python writes it.
class npy_dictionary {
public:
  explicit npy_dictionary(std::string_view text) : left_{text} {}

  /// False: it is none, or not of real numbers on one or two axes.
  [[nodiscard]] bool read(npy_layout& to) {
    if (!take('{')) return false;
    while (!take('}')) {
      const auto key = quoted();
      if (!key || !take(':')) return false;
      const bool known = *key == "descr" ? descr(to) : *key == "fortran_order" ? flag(to.fortran) : *key == "shape" && shape(to);
      if (!known) return false;
      (void)take(',');
    }
    return !to.numbers.empty() && (to.shape.size() == 1 || (to.shape.size() == 2 && to.names.empty()));
  }

private:
  void blanks() noexcept { left_.remove_prefix(std::min(left_.find_first_not_of(" \n\t"), left_.size())); }
  bool take(char c) noexcept {
    blanks();
    if (left_.empty() || left_.front() != c) return false;
    left_.remove_prefix(1);
    return true;
  }
  std::optional<std::string> quoted() {
    blanks();
    if (left_.empty() || (left_.front() != '\'' && left_.front() != '"')) return std::nullopt;
    const char mark = left_.front();
    std::string out;
    for (left_.remove_prefix(1); !left_.empty() && left_.front() != mark; left_.remove_prefix(1)) {
      if (left_.front() == '\\' && left_.size() > 1) left_.remove_prefix(1);
      out += left_.front();
    }
    return take(mark) ? std::optional{out} : std::nullopt;
  }
  bool flag(bool& to) {
    blanks();
    to = left_.starts_with("True");
    if (!to && !left_.starts_with("False")) return false;
    left_.remove_prefix(to ? 4 : 5);
    return true;
  }
  bool number(npy_layout& to) {
    const auto code = quoted();
    const auto one = code ? npy_number::from(*code) : std::nullopt;
    if (one) to.numbers.push_back(*one);
    return one.has_value() && to.numbers.size() <= 1024;
  }
  bool descr(npy_layout& to) {
    if (!take('[')) return number(to);
    while (!take(']')) {
      if (!take('(')) return false;
      auto name = quoted();
      if (!name || !take(',') || !number(to) || !take(')')) return false;
      to.names.push_back(*std::move(name));
      (void)take(',');
    }
    return true;
  }
  bool shape(npy_layout& to) {
    if (!take('(')) return false;
    while (!take(')')) {
      blanks();
      std::size_t size = 0;
      const auto got = std::from_chars(left_.data(), left_.data() + left_.size(), size);
      if (got.ec != std::errc{}) return false;
      left_.remove_prefix(static_cast<std::size_t>(got.ptr - left_.data()));
      to.shape.push_back(size);
      (void)take(',');
    }
    return true;
  }

  std::string_view left_;
};

[[nodiscard]] inline outcome<npy_layout> read_npy_layout(std::string_view bytes, const std::string& name) {
  if (!bytes.starts_with("\x93NUMPY") || bytes.size() < 12) return failure{name + ": is no NumPy file"};
  const auto byte = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(bytes[i])}; };
  const bool large = byte(6) >= 2;
  const std::size_t begin = large ? 12 : 10;
  const std::size_t size = byte(8) + (byte(9) << 8) + (large ? (byte(10) << 16) + (byte(11) << 24) : 0);
  if (bytes.size() - begin < size) return failure{name + ": truncated: it ends within its head"};
  npy_layout out;
  out.data_offset = begin + size;
  if (!npy_dictionary{bytes.substr(begin, size)}.read(out))
    return failure{name + ": its head describes no table of real numbers on one or two axes"};
  if (out.rows() == 0 || out.columns() == 0) return failure{name + ": holds no numbers"};
  if (out.columns() > 1024) return failure{name + ": has " + std::to_string(out.columns()) + " columns"};
  return out;
}

}  // namespace detail

/// The table in the bytes of a file; `name` stands in the messages. max_rows: how much of it is wanted.
[[nodiscard]] inline outcome<number_table> parse_npy(std::string_view bytes, const std::string& name,
                                                     std::size_t max_rows = all_rows) {
  const auto layout = detail::read_npy_layout(bytes, name);
  if (!layout) return failure{layout.error()};
  const std::size_t row_bytes = layout->row_bytes(), present = bytes.size() - layout->data_offset;
  if (present / row_bytes < layout->rows())
    return failure{name + ": truncated: " + std::to_string(layout->rows()) + " rows promised, " +
                   std::to_string(present / row_bytes) + " are there"};
  const std::size_t rows = std::min(max_rows, layout->rows());
  number_table out;
  for (std::size_t c = 0, field = 0; c < layout->columns(); ++c) {
    const auto& number = layout->shape.size() == 2 ? layout->numbers.front() : layout->numbers[c];
    const bool by_column = layout->shape.size() == 2 && layout->fortran;
    const std::size_t begin = layout->data_offset + (by_column ? c * layout->rows() * number.bytes : field),
                      stride = by_column ? number.bytes : row_bytes;
    std::vector<double> values(rows);
    for (std::size_t r = 0; r < rows; ++r) values[r] = number(bytes.data() + begin + r * stride);
    const auto bad = std::find_if_not(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
    out.data.add(layout->names.empty() ? std::string{} : layout->names[c], {});
    if (bad != values.end())
      return failure{out.place_of(name, static_cast<std::size_t>(bad - values.begin())) + ": " + column_text(out.data, c) +
                     ": is no finite number"};
    out.data.columns.back().values = std::move(values);
    field += number.bytes;
  }
  return out;
}

[[nodiscard]] inline outcome<number_table> read_npy(const std::string& path, std::size_t max_rows = all_rows) {
  auto bytes = detail::read_bytes(path, ~std::uintmax_t{0});
  if (!bytes) return failure{bytes.error()};
  return parse_npy(*bytes, path, max_rows);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
