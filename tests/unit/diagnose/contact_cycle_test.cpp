// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_cycle.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("contact cycle: what grows towards the end of each stick, whatever their lengths") {
  rosin::contact_trace trace{"bow-1", {}, {}};
  double at = 0.1;
  for (const int samples : {60, 100, 80, 4, 120}) {  // the fourth is too short to have parts
    for (int i = 0; i < samples; ++i, at += 1e-5) {
      trace.time_s.push_back(at);
      trace.left.push_back(samples < 10 ? 50.0 : 10.0 * (i + 0.5) / samples);
    }
    at += 3e-4;
  }
  const auto parts = rosin::left_by_part(trace);
  REQUIRE(parts.size() == 10);
  for (std::size_t k = 0; k < 10; ++k) CHECK(parts[k] == test::approx(static_cast<double>(k) + 0.5).epsilon(0.2));
  CHECK(rosin::left_by_part({"none", {}, {}}) == std::vector<double>(10, 0.0));
}
