// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pluck_options.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace calibrate_pluck_options {

TEST_CASE("a band ends at a share of the rate, or between the last partial that is fitted and the next") {
  const rosin::pluck_options options{.most_partials = 10};
  CHECK(options.limits_for(100e3).stop_Hz == test::approx(42e3));
  CHECK(options.limits_for(100e3).pass_Hz == test::approx(34e3));
  CHECK(options.limits_for(100e3, 21e3).pass_Hz == test::approx(17e3));
  CHECK(options.limits_for(100e3, rosin::ringing_string{.fundamental_Hz = 1000}).stop_Hz == test::approx(10.5e3));
}

TEST_CASE("ends are known to move where either has a mode") {
  rosin::pluck_guess guess{.fundamental_Hz = 500};
  CHECK_FALSE(guess.has_ends());
  guess.ends[1].modes.push_back({1000, 20, 3});
  CHECK(guess.has_ends());
}

}  // namespace calibrate_pluck_options
