// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pluck_start.hpp>

#include <rosin/condition/ac_coupling.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/approx.hpp"

namespace {

constexpr double start_rate_Hz = 128e3;

/// An ideal string without loss, from its partials.
rosin::pluck_take ideal(double f0, double position, double release_s) {
  rosin::pluck_take take;
  take.name = "ideal";
  take.rate_Hz = start_rate_Hz;
  take.position = position;
  for (auto& channel : take.force_N) channel.assign(12000, 0.0);
  for (std::size_t i = 0; i < 12000; ++i) {
    const double t = std::max(0.0, static_cast<double>(i) / start_rate_Hz - release_s);
    for (int n = 1; n < 40; ++n) {
      const double part = 2 / (n * std::numbers::pi) * std::sin(n * std::numbers::pi * position) *
                          std::cos(2 * std::numbers::pi * n * f0 * t) * std::exp(-std::pow(n / 25.0, 2));
      take.force_N[0][i] += part;
      take.force_N[1][i] += n % 2 ? part : -part;
    }
  }
  return take;
}

}  // namespace

TEST_CASE("pitch, release and position are found to a fraction of a sample") {
  for (const double off : {0.98, 1.0, 1.02}) {
    const auto start = rosin::find_start({ideal(640, 0.27, 0.00371)}, {.fundamental_Hz = 640 * off});
    REQUIRE_MESSAGE(start, start.error());
    CHECK(start->fundamental_Hz == test::approx(640).epsilon(2e-4));
    CHECK(start->release_s[0] == test::approx(0.00371).epsilon(2e-3));
    CHECK(start->position[0] == test::approx(0.27).epsilon(0.01));
  }
}

TEST_CASE("lags between samples") {
  CHECK(rosin::detail::vertex(1, 2, 1) == 0);
  CHECK(rosin::detail::vertex(1, 2, 2) == test::approx(0.5));
  CHECK(rosin::detail::vertex(0, 1, 5) == 0);          // no maximum
  CHECK(rosin::detail::vertex(0, 1, 1.9999999) == 1);  // never further than a sample
  std::vector<double> x(4000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::cos(2 * std::numbers::pi * static_cast<double>(i) / 97.31);
  CHECK(rosin::detail::likest_lag(x, 0, 90, 105) == test::approx(97.31).epsilon(1e-4));
}

TEST_CASE("a position far from the declared one is held near it, for the fit to refuse") {
  const auto start = rosin::find_start({[] {
                                         rosin::pluck_take t = ideal(640, 0.27, 0.004);
                                         t.position = 0.45;
                                         return t;
                                       }()},
                                       {.fundamental_Hz = 640});
  REQUIRE(start);
  CHECK(start->position[0] == test::approx(0.41));
}

TEST_CASE("a force that a high-pass lets decay while the wire still holds is not taken for its release") {
  for (const double corner_Hz : {4.0, 15.0}) {
    rosin::pluck_take take = ideal(320, 0.2, 0.045);
    for (auto& x : take.force_N) rosin::pass_ac_coupled(std::span(x), corner_Hz, start_rate_Hz);
    const auto start = rosin::find_start({take}, {.fundamental_Hz = 321});
    REQUIRE_MESSAGE(start, start.error());
    CHECK(start->release_s[0] == test::approx(0.045).epsilon(2e-3));
    CHECK(start->position[0] == test::approx(0.2).epsilon(0.02));
  }
}
