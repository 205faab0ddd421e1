// tier: hosted
// SPDX-License-Identifier: MIT
//
// Numbers as text and back, with a point as decimal mark whatever the locale of the program says. printf, std::to_string, strtod and
// streams ask that locale: in a program with a German user interface they write 40,5, which no controller and no file of ours reads.
// So nothing here or in the tool writes or reads a number with them (tests/architecture says so).
//
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace rosin {

/// The number as printf's form would say it in the locale "C": '%', perhaps '+', perhaps '.' and digits (60 at most), and g, f, e
/// or a, as "%.4g" and "%+.2f".
[[nodiscard]] inline std::string number_text(double x, std::string_view form = "%.6g") {
  std::array<char, 400> digits{};
  char *const begin = digits.data(), *const end = begin + digits.size();
  const char kind = form.empty() ? 'g' : form.back();
  int precision = 6;
  if (const auto point = form.find('.'); point != std::string_view::npos)
    std::from_chars(form.data() + point + 1, form.data() + form.size(), precision);
  precision = std::clamp(precision, 0, 60);
  const auto as = [&](std::chars_format how) { return std::to_chars(begin, end, x, how, precision).ptr; };
  const char* const last = kind == 'f'   ? as(std::chars_format::fixed)
                           : kind == 'e' ? as(std::chars_format::scientific)
                           : kind == 'a' ? std::to_chars(begin, end, x, std::chars_format::hex).ptr
                                         : as(std::chars_format::general);
  std::string out(begin, static_cast<std::size_t>(last - begin));
  const std::size_t sign = out.starts_with('-') ? 1 : 0;
  if (kind == 'a' && out[sign] >= '0' && out[sign] <= '9') out.insert(sign, "0x");
  if (sign == 0 && form.find('+') != std::string_view::npos) out.insert(0, 1, '+');
  return out;
}

/// The number that the whole text is, "+2" and "1e-3" as well; nothing if it is none, or too large or small for a double.
[[nodiscard]] inline std::optional<double> number_from(std::string_view text) noexcept {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return end.ec == std::errc{} && end.ptr == text.data() + text.size() ? std::optional{value} : std::nullopt;
}

}  // namespace rosin
