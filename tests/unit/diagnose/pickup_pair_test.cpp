// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_pair.hpp>

#include <doctest/doctest.h>

#include "pickup_plucks.hpp"
#include "support/approx.hpp"

using namespace rosin;

TEST_CASE("find_pair: detuning and coupling of a string in two planes") {
  rosin_test::heard_string s;
  s.detuning = -0.0015, s.coupling = 0.3;
  const auto r = listen(s.pluck("a", 0.13, 1, 1), 220);
  REQUIRE(r);
  std::vector<const partial_track*> tracks;
  for (const auto& t : r->tracks) tracks.push_back(&t);
  const pair_found p = find_pair(tracks);
  CHECK(p.gain > 1000);
  CHECK(std::abs(p.detuning + 0.0015) < 4 * p.sd + 1e-6);
  CHECK(p.coupling == test::approx(0.3).epsilon(0.1));
  CHECK(p.agreeing > 0.8);
}

TEST_CASE("find_pair: a weak second line as strong as it is, however far from the middle of the track") {
  rosin_test::heard_string s;
  s.detuning = 0.006, s.coupling = 0.1;  // up to 36 Hz, where the window passes a tenth
  const auto r = listen(s.pluck("a", 0.13, 1, 1), 220);
  REQUIRE(r);
  std::vector<const partial_track*> tracks;
  for (const auto& t : r->tracks) tracks.push_back(&t);
  const pair_found p = find_pair(tracks);
  CHECK(p.detuning == test::approx(0.006).epsilon(1e-3));
  CHECK(p.coupling == test::approx(0.1).epsilon(0.02));
}

TEST_CASE("find_pair: little to find in single lines") {
  const rosin_test::heard_string s;
  const auto r = listen(s.pluck("a", 0.13, 1, 1), 220);
  REQUIRE(r);
  std::vector<const partial_track*> tracks;
  for (const auto& t : r->tracks) tracks.push_back(&t);
  CHECK(find_pair(tracks).agreeing < 0.4);
}
