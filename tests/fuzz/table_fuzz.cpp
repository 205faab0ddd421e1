// SPDX-License-Identifier: MIT
//
// Any bytes as a table of numbers, as text and as a NumPy file: what is read is rectangular and finite, and reads the same after it
// was written again; what is not is refused by the file's name. A column of times is held against even steps without a fault.
//
#include <rosin/adapt/table_recording.hpp>
#include <rosin/report/csv.hpp>
#include <rosin/report/npy.hpp>

#include <cstdlib>
#include <sstream>

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_table(const rosin::number_table& read) {
  require(read.data.is_rectangular() && !read.data.columns.empty() && read.data.rows() > 0);
  for (const auto& c : read.data.columns)
    for (const double x : c.values) require(std::isfinite(x));
  require(read.place_of("a", read.data.rows() - 1).starts_with("a:") || read.lines.empty());
  for (int column = 0; column < 3; ++column) {
    const auto rate = rosin::rate_of(read, "a", {std::nullopt, column});
    require(rate ? *rate > 0 : rate.error().starts_with("a:"));
  }
}

/// Without what would make another thing of it: names, and the digits of the text.
rosin::table bare(rosin::table from) {
  from.comments.clear();
  for (std::size_t c = 0; c < from.columns.size(); ++c)
    from.columns[c].name = "x" + std::to_string(c), from.columns[c].digits = 17;
  return from;
}

void check_again(const rosin::number_table& read, const rosin::outcome<rosin::number_table>& again) {
  require(again.has_value() && again->data.columns.size() == read.data.columns.size());
  for (std::size_t c = 0; c < read.data.columns.size(); ++c)
    require(again->data.columns[c].values == read.data.columns[c].values);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  const auto text = rosin::parse_table_text(bytes, "a.csv");
  if (text) {
    check_table(*text);
    std::ostringstream out;
    rosin::write_csv(out, bare(text->data));
    check_again(*text, rosin::parse_table_text(out.str(), "b.csv"));
    require(rosin::parse_table_text(bytes, "a.csv", 1)->data.rows() == 1);
  } else {
    require(text.error().starts_with("a.csv:") && text.error().size() < 3000);
  }
  const auto npy = rosin::parse_npy(bytes, "a.npy");
  if (npy) {
    check_table(*npy);
    std::ostringstream out;
    rosin::write_npy(out, bare(npy->data));
    check_again(*npy, rosin::parse_npy(out.str(), "b.npy"));
  } else {
    require(npy.error().starts_with("a.npy:"));
  }
  return 0;
}
