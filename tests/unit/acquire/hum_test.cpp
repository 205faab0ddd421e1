// SPDX-License-Identifier: MIT
#include <rosin/acquire/hum.hpp>

#include <doctest/doctest.h>

#include <support/synthetic_take.hpp>

#include "support/approx.hpp"

namespace acquire_hum {

namespace {

/// A ringing string with hum on it; the stretch begins a period after the release.
std::vector<double> ringing_with_hum(double mains_Hz, double amplitude_N, double third) {
  test::pluck p;
  p.fundamental_Hz = 597.4;
  p.release_s = 0;
  p.duration_s = 0.14;
  auto x = test::pluck_forces(p)[0];
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double angle = 6.283185307179586 * mains_Hz * static_cast<double>(i) / p.rate_Hz;
    x[i] += amplitude_N * (std::cos(angle + 0.7) + third * std::cos(3 * angle));
  }
  x.erase(x.begin(), x.begin() + 100);
  return x;
}

}  // namespace

TEST_CASE("hum of 50 and 60 Hz is told apart and measured, in 0.14 s of a ringing string") {
  for (const double mains : {50.0, 60.0}) {
    const auto found = rosin::find_hum(ringing_with_hum(mains, 0.01, 0.3), 48000, 597.4);
    REQUIRE(found);
    CHECK(found->frequency_Hz == mains);
    CHECK(found->amplitude == test::approx(0.01).epsilon(0.05));
    REQUIRE(found->lines.size() >= 2);
    CHECK(found->lines[1].frequency_Hz == test::approx(3 * mains).epsilon(0.02));
    CHECK(found->lines[1].amplitude == test::approx(0.003).epsilon(0.1));
  }
}

TEST_CASE("no hum where there is none, and no claim from less than five periods") {
  CHECK_FALSE(rosin::find_hum(ringing_with_hum(50, 0, 0), 48000, 597.4));
  CHECK_FALSE(rosin::find_hum(ringing_with_hum(43, 0.01, 0), 48000, 597.4));
  const auto x = ringing_with_hum(50, 0.01, 0);
  CHECK_FALSE(rosin::find_hum({x.data(), 4000}, 48000, 597.4));
}

TEST_CASE("partials of a string that sounds at the mains' frequency are not hum") {
  test::pluck p;
  p.fundamental_Hz = 50;
  p.duration_s = 1;
  p.release_s = 0;
  CHECK_FALSE(rosin::find_hum(test::pluck_forces(p)[0], p.rate_Hz, 50));
}

}  // namespace acquire_hum
