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

TEST_CASE("of several models of one effect one may be there, and one that needs another effect only beside it") {
  rosin::pluck_effect rings, plain, other;
  rings.name = "sensor-resonance", rings.place = 1;
  plain.name = other.name = "sensor-nonlinearity", plain.place = other.place = 1;
  other.variant = "before it rings", other.beside = rings.id();
  CHECK(other.id() == "sensor-nonlinearity@far before it rings");
  const std::vector<rosin::pluck_effect> all{rings, plain, other};
  const auto ids = [&](const std::vector<rosin::pluck_effect>& already) {
    std::vector<std::string> out;
    for (const auto& e : rosin::still_to_add(all, already)) out.push_back(e.id());
    return out;
  };
  CHECK(ids({}) == std::vector<std::string>{rings.id(), plain.id()});
  CHECK(ids({rings}) == std::vector<std::string>{plain.id(), other.id()});
  CHECK(ids({plain}) == std::vector<std::string>{rings.id()});
  CHECK(ids({rings, other}).empty());
}
