// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pluck_effect.hpp>

#include <doctest/doctest.h>

TEST_CASE("an effect is known by its name and its place") {
  rosin::pluck_effect e;
  e.name = "point-mass";
  CHECK(e.id() == "point-mass");
  e.name = "sensor-resonance", e.place = 1;
  CHECK(e.id() == "sensor-resonance@far");
  e.place = 0;
  CHECK(e.id() == "sensor-resonance@near");
}
