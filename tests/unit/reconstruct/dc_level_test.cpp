// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/dc_level.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "support/approx.hpp"

namespace reconstruct_dc_level {

TEST_CASE("the loop's middle is put at 0.65 times the normal force, either way the bow moves") {
  for (const double way : {1.0, -1.0}) {
    std::vector<double> force, velocity;
    for (int i = 0; i < 1000; ++i) {
      const bool slip = i % 10 < 3;
      velocity.push_back(way * (slip ? -0.8 : 0.2));
      force.push_back(way * (slip ? -0.05 + 0.1 * (i % 10) / 2 : 0.3));  // -0.05 ... 0.05 while slipping
    }
    force[3] = std::numeric_limits<double>::quiet_NaN();
    const rosin::dc_estimate dc = rosin::estimate_dc_level(force, velocity, way * 0.2, 0.3);
    REQUIRE(dc.available);
    CHECK(dc.level_N == test::approx(way * 0.65 * 0.3));
    CHECK(dc.sd_N == test::approx(0.045));
  }
}

TEST_CASE("without slip, or without a normal force, there is no estimate") {
  const std::vector<double> force(1000, 0.1), sticking(1000, 0.2), sliding(1000, -0.5);
  CHECK_FALSE(rosin::estimate_dc_level(force, sticking, 0.2, 0.3).available);
  CHECK_FALSE(rosin::estimate_dc_level(force, sliding, 0.2, 0).available);
}

}  // namespace reconstruct_dc_level
