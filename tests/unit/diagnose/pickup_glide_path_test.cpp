// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_glide_path.hpp>

#include <doctest/doctest.h>

#include "pickup_plucks.hpp"
#include "support/approx.hpp"

using namespace rosin;

TEST_CASE("glide_shape: path by hand") {
  const glide_shape s{{0.75, 0.25}, {2, 6}, {1, 3}};
  const auto part = [](double p, double k, double t) { return p * (1 - std::exp(-k * t)) / k; };
  CHECK(s.path_s(2, 0.5) == test::approx(part(0.75, 2, 0.5) + part(0.25, 6, 0.5)));
  CHECK(s.path_s(3, 0.5) == test::approx(part(0.75, 2, 0.5) + 1.5 * part(0.25, 6, 0.5)));
}

TEST_CASE("find_glide: E A of a simulated string within some per cent; none where there is none" * doctest::test_suite("long")) {
  rosin_test::heard_string s;
  s.burden.axial_stiffness_N = 5000;
  const auto r = listen(s.pluck("a", 0.13, 2, 1), 220);
  REQUIRE(r);
  const glide_found g = find_glide(*r, true);
  double slopes = 0;
  for (const double p : r->power) slopes += p / (s.tension_N * s.tension_N);
  CHECK(16 * s.tension_N * g.relative / slopes == test::approx(5000).epsilon(0.07));
  CHECK(g.gain > 300);
  CHECK(g.agreeing > 0.9);

  s.burden.axial_stiffness_N = 0;
  const auto steady = listen(s.pluck("a", 0.13, 2, 1), 220);
  REQUIRE(steady);
  CHECK(find_glide(*steady, true).gain < 6);
}

TEST_CASE("find_glide: powers fall as the lines do without the glide") {
  rosin_test::heard_string s;
  s.burden.axial_stiffness_N = 9000, s.duration_s = 0.8;
  const auto r = listen(s.pluck("a", 0.19, 2.4, 1), 220);
  REQUIRE(r);
  const glide_found g = find_glide(*r, true);
  const double pi = 3.14159265358979323846;
  REQUIRE(g.shape.number[0] == 1);
  CHECK(g.relative > 1e-3);
  CHECK(g.shape.rate_per_s[0] == test::approx(2 * pi * 220 / s.quality).epsilon(0.03));
}
