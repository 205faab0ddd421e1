// SPDX-License-Identifier: MIT
#include <rosin/acquire/finding.hpp>

#include <doctest/doctest.h>

namespace acquire_finding {

TEST_CASE("only an error counts as an error") {
  std::vector<rosin::finding> findings(2);
  findings[1].level = rosin::severity::warning;
  CHECK_FALSE(rosin::has_error(findings));
  findings.push_back({rosin::severity::error, "clipping", "a", "near", 0, 0, "", ""});
  CHECK(rosin::has_error(findings));
  CHECK(name_of(rosin::severity::warning) == "warning");
}

}  // namespace acquire_finding
