// SPDX-License-Identifier: MIT
#include <rosin/hardware/frames.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

struct minimal_source {
  rosin::frame_format format() const { return {48000, 2}; }
  rosin::frame_read read(std::span<double>, std::chrono::milliseconds) { return {}; }
};
struct without_patience {
  rosin::frame_format format() const { return {48000, 2}; }
  rosin::frame_read read(std::span<double>) { return {}; }
};
static_assert(rosin::FrameSource<minimal_source>);
static_assert(!rosin::FrameSource<without_patience>);
static_assert(!rosin::FrameSink<minimal_source>);
static_assert(!rosin::MotionStage<minimal_source>);

}  // namespace

TEST_CASE("a stroke's duration and steady part are those of its trapezoid") {
  const rosin::stroke way{-0.3, 0.2, 1.0};
  // by hand: 0.2 s up over 0.02 m, 0.26 m at 0.2 m/s = 1.3 s, 0.2 s down
  CHECK(way.steady_m() == test::approx(0.26));
  CHECK(way.duration_s() == test::approx(1.7));
  CHECK(rosin::stroke{0.03, 0.2, 1.0}.steady_m() < 0);
}
