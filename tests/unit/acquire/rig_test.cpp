// SPDX-License-Identifier: MIT
#include <rosin/acquire/rig.hpp>

#include <doctest/doctest.h>

namespace acquire_rig {

TEST_CASE("a take's own position goes before that of [contact], and an unknown one before both") {
  rosin::rig r;
  rosin::take t;
  CHECK_FALSE(r.position_of(t));
  r.contact_position = 0.3;
  CHECK(r.position_of(t) == 0.3);
  t.contact_position = 0.2;
  CHECK(r.position_of(t) == 0.2);
  t.position_unknown = true;
  CHECK_FALSE(r.position_of(t));
}

TEST_CASE("channels and takes are found by name, files below the rig's folder") {
  rosin::rig r;
  r.channels.resize(1);
  r.channels[0].name = "near";
  r.takes.resize(1);
  r.takes[0].name = "bow-1";
  CHECK(r.channel("near") == &r.channels[0]);
  CHECK(r.channel("far") == nullptr);
  CHECK_FALSE(r.has_both_forces());
  r.channels.push_back(r.channels[0]);
  r.channels[1].name = "far";
  CHECK(r.has_both_forces());
  CHECK(r.find_take("bow-1") == &r.takes[0]);
  CHECK(r.find_take("bow-2") == nullptr);
  CHECK(r.path_of("a.wav") == "a.wav");
  r.folder = "runs/12";
  CHECK(r.path_of("a.wav") == "runs/12/a.wav");
}

TEST_CASE("names stand for the enumerators in their order") {
  CHECK(name_of(rosin::quantity::termination_force) == "termination-force");
  CHECK(name_of(rosin::quantity::bow_speed) == "bow-speed");
  CHECK(name_of(rosin::quantity::unused) == "unused");
  CHECK(name_of(rosin::take_kind::bow) == "bow");
  CHECK(name_of(rosin::friction_model::elasto_plastic) == "elasto-plastic");
}

}  // namespace acquire_rig
