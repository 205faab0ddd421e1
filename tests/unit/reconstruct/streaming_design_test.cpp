// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/streaming_design.hpp>

#include <doctest/doctest.h>

namespace reconstruct_streaming_design {

TEST_CASE("a design that does not fit says what would") {
  const rosin::bow_point at = rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {}}, 0.3);
  const rosin::band limits{30e3, 52e3};
  const auto few_taps = rosin::design_streaming<float, 16, 1024>(at, {1, 1}, limits, 128e3);
  REQUIRE_FALSE(few_taps);
  CHECK(few_taps.error().find("there is room for 16") != std::string::npos);
  const auto short_line = rosin::design_streaming<float, 512, 64>(at, {1, 1}, limits, 128e3);
  REQUIRE_FALSE(short_line);
  CHECK(short_line.error().find("the delay lines hold 64") != std::string::npos);
}

TEST_CASE("latency is the longer passage and a little of the band's window") {
  const rosin::bow_point at = rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {}}, 0.3);
  const auto design = rosin::design_streaming<double, 512, 1024>(at, {1, 1}, {30e3, 52e3}, 128e3, 1e-3);
  REQUIRE(design);
  const double passage = at.delay_s[1] * 128e3;
  CHECK(design->latency >= passage);
  CHECK(design->latency <= passage + 40);
}

}  // namespace reconstruct_streaming_design
