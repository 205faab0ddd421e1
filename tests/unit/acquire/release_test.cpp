// SPDX-License-Identifier: MIT
#include <rosin/acquire/release.hpp>

#include <doctest/doctest.h>

#include <support/synthetic_take.hpp>

#include "support/approx.hpp"

namespace acquire_release {

TEST_CASE("the release arrives as a step of the breaking force, at each end in its time") {
  for (const double position : {0.12, 0.3, 0.45}) {
    CAPTURE(position);
    test::pluck p;
    p.position = position;
    const auto x = test::pluck_forces(p);
    const auto near = rosin::find_release_step(x[0], p.rate_Hz, p.fundamental_Hz);
    const auto far = rosin::find_release_step(x[1], p.rate_Hz, p.fundamental_Hz);
    REQUIRE(near);
    REQUIRE(far);
    CHECK(near->height == test::approx(-1).epsilon(0.12));
    CHECK(far->height == test::approx(-1).epsilon(0.15));
    const double near_s = p.release_s + position / (2 * p.fundamental_Hz),
                 far_s = p.release_s + (1 - position) / (2 * p.fundamental_Hz);
    CHECK(std::abs(static_cast<double>(near->frame) / p.rate_Hz - near_s) < 0.02 / p.fundamental_Hz);
    CHECK(std::abs(static_cast<double>(far->frame) / p.rate_Hz - far_s) < 0.02 / p.fundamental_Hz);
  }
}

TEST_CASE("no step in what is too short or does not move") {
  CHECK_FALSE(rosin::find_release_step({}, 48000, 330));
  CHECK_FALSE(rosin::find_release_step(std::vector<double>(20, 1.0), 48000, 330));
  CHECK_FALSE(rosin::find_release_step(std::vector<double>(4000, 0.0), 48000, 330));
}

TEST_CASE("the onset is found within half a period") {
  test::pluck p;
  auto x = test::pluck_forces(p)[0];
  const auto start = static_cast<std::size_t>(p.release_s * p.rate_Hz);
  for (std::size_t i = 0; i < start; ++i) x[i] = 0;
  const auto onset = rosin::first_onset(x, p.rate_Hz, p.fundamental_Hz);
  REQUIRE(onset);
  CHECK(std::abs(static_cast<double>(*onset) - static_cast<double>(start)) <= 0.5 * p.rate_Hz / p.fundamental_Hz + 1);
  CHECK_FALSE(rosin::first_onset({}, 48000, 330));
  CHECK_FALSE(rosin::first_onset(std::vector<double>(4000, 0.3), 48000, 330));
}

}  // namespace acquire_release
