// SPDX-License-Identifier: MIT
#include <rosin/acquire/recording.hpp>

#include <doctest/doctest.h>

namespace acquire_recording {

namespace {

rosin::recording stereo() {
  rosin::recording r;
  r.file = "a.wav";
  r.sample_rate_Hz = 1000;
  r.channels = {{0.5, -0.25}, {0.125, 0}};
  return r;
}

rosin::sensor_channel channel(const std::string& name, int index, double scale) {
  rosin::sensor_channel c;
  c.name = name;
  c.index = index;
  c.per_full_scale = scale;
  return c;
}

}  // namespace

TEST_CASE("the channel map turns full scales into newtons, whatever the order of the columns") {
  rosin::rig r;
  r.channels = {channel("far", 0, 2), channel("near", 1, 4)};
  const auto s = rosin::signals_of(r, rosin::take{}, stereo());
  REQUIRE(s);
  CHECK(s->far_N() == std::vector<double>{1.0, -0.5});
  CHECK(s->near_N() == std::vector<double>{0.5, 0.0});
  CHECK(s->frames() == 2);
  CHECK(s->time_s(1) == 0.001);
}

TEST_CASE("an uncalibrated channel stays in full scales, an unused one is left out") {
  rosin::rig r;
  r.channels = {channel("pickup", 0, 1), channel("spare", 1, 1)};
  r.channels[0].quantity = rosin::quantity::string_velocity;
  r.channels[0].per_full_scale.reset();
  r.channels[1].quantity = rosin::quantity::unused;
  const auto s = rosin::signals_of(r, rosin::take{}, stereo());
  REQUIRE(s);
  REQUIRE(s->signals.size() == 1);
  CHECK(s->find("pickup")->values == stereo().channels[0]);
  CHECK(s->find("spare") == nullptr);
}

TEST_CASE("too few channels: file, key and line are named") {
  rosin::rig r;
  r.file = "rig.toml";
  r.channels = {channel("near", 0, 1), channel("far", 2, 1)};
  r.channels[1].line = 14;
  const auto s = rosin::signals_of(r, rosin::take{}, stereo());
  REQUIRE_FALSE(s);
  CHECK(s.error() == "a.wav: has 2 channel(s), but rig.toml:14: channels.far.index is 2");
}

TEST_CASE("a table's column by its name; its full scale is its largest magnitude") {
  rosin::recording table = stereo();
  table.columns = {"a", "b"}, table.is_table = true;
  rosin::rig r;
  r.file = "rig.toml";
  r.channels = {channel("near", -1, 2)};
  r.channels[0].column = "b";
  const auto s = rosin::signals_of(r, rosin::take{}, table);
  REQUIRE(s);
  CHECK(s->near_N() == std::vector<double>{0.25, 0});
  CHECK(s->find("near")->full_scale == 0.25);
  r.channels[0].column = "c";
  CHECK(rosin::signals_of(r, rosin::take{}, table).error() ==
        "a.wav: has the columns a, b, but rig.toml:0: channels.near.column is \"c\"");
  CHECK(rosin::signals_of(r, rosin::take{}, stereo()).error() ==
        "a.wav: has no named columns, but rig.toml:0: channels.near.column is \"c\"");
}

TEST_CASE("which files are tables") {
  for (const char* name : {"a.csv", "A.CSV", "b/c.tsv", "x.npy", "x.mat", "x.h5", "x.hdf5"})
    CHECK_FALSE(rosin::table_ending(name).empty());
  for (const char* name : {"a.wav", "csv", ".csv", "a.csv.wav", ""}) CHECK(rosin::table_ending(name).empty());
}

TEST_CASE("the step of a converter") {
  rosin::recording r = stereo();
  CHECK(r.step() == std::ldexp(1.0, -15));
  r.bits = 24;
  CHECK(r.step() == std::ldexp(1.0, -23));
  r.float_format = true;
  CHECK(r.step() == 0.0);
  CHECK(r.duration_s() == 0.002);
}

}  // namespace acquire_recording
