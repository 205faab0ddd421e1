// SPDX-License-Identifier: MIT
//
// Any bytes as a table: what is read is rectangular, and reads the same after it was written again.
//
#include <rosin/report/csv.hpp>

#include <cstdlib>

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

/// Names that would be read as something else: quotes and blanks are taken off, a hash begins a comment.
bool has_odd_names(const rosin::table& t) {
  for (const auto& c : t.columns)
    if (c.name.empty() || c.name.front() == '#') return true;
  return t.columns.front().name.starts_with("\xef\xbb\xbf");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  std::istringstream in{std::string{reinterpret_cast<const char*>(data), size}};
  auto first = rosin::read_csv(in, "a.csv");
  if (!first) {
    require(first.error().starts_with("a.csv:"));
    return 0;
  }
  require(first->is_rectangular());
  if (has_odd_names(*first)) return 0;
  first->comments.clear();
  for (auto& c : first->columns) c.digits = 17;
  std::ostringstream out;
  rosin::write_csv(out, *first);
  std::istringstream again{out.str()};
  const auto second = rosin::read_csv(again, "b.csv");
  require(second.has_value() && second->columns.size() == first->columns.size());
  for (std::size_t i = 0; i < first->columns.size(); ++i) require(same(first->columns[i].values, second->columns[i].values));
  return 0;
}
