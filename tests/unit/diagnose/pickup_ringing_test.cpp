// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_ringing.hpp>

#include <doctest/doctest.h>

#include "pickup_plucks.hpp"
#include "support/approx.hpp"

using namespace rosin;

TEST_CASE("listen: partials of a pluck, each with its power") {
  const rosin_test::heard_string s;
  const auto r = listen(s.pluck("a", 0.13, 1, 1), 221);
  REQUIRE(r);
  CHECK(r->fundamental_Hz == test::approx(220).epsilon(1e-4));
  REQUIRE(r->tracks.size() > 15);
  CHECK(r->tracks.size() == r->power.size());
  // A force of 1 N at b: partial n pushes the end with 2 / (n pi) sin(n pi b).
  const double pi = 3.14159265358979323846, t = r->start_s - 0.01;
  for (const std::size_t i : {std::size_t{0}, std::size_t{2}}) {
    const int n = r->tracks[i].number;
    const double a = 2 / (n * pi) * std::sin(n * pi * 0.13) * std::exp(-pi * 220 * n / 900 * t);
    CHECK(r->power[i] == test::approx(a * a).epsilon(0.1));
  }
  CHECK(clearest(*r, 5).size() == 5);
}

TEST_CASE("listen: what cannot be heard is refused") {
  pickup_signal s{"a", "b", 48000, std::vector<double>(48000, 0.0)};
  CHECK_FALSE(listen(s, 220));
  s.values.assign(2000, 0.1);
  CHECK_FALSE(listen(s, 220));
}
