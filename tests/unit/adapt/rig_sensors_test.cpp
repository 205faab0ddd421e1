// SPDX-License-Identifier: MIT
#include <rosin/adapt/rig_sensors.hpp>

#include <doctest/doctest.h>

#include <support/rig_text.hpp>

TEST_CASE("[channels]: each key, its type, range and name") {
  constexpr test::bad_key rows[] = {
      {"index = 0, ", "", "rig.toml:13: channels.near.index: is missing"},
      {"index = 0", "index = -1", "rig.toml:13: channels.near.index: must be 0 ... 1023, is -1"},
      {"index = 0", "index = 0.5", "rig.toml:13: channels.near.index: must be a whole number"},
      {"index = 0", "index = 1", "rig.toml:14: channels.near.index: is 1, as that of far"},
      {"index = 0", "indx = 0",
       "rig.toml:13: channels.near.index: is missing\nrig.toml:13: channels.near.indx: unknown key; did you mean index?"},
      {"newtons_per_full_scale = 1.65, ", "", "rig.toml:13: channels.near.newtons_per_full_scale: is missing"},
      {"newtons_per_full_scale = 1.65", "newtons_per_full_scale = -1.65",
       "rig.toml:13: channels.near.newtons_per_full_scale: must be larger than 0 and at most 1e+09, is -1.65"},
      {"gain_tolerance = 0.05", "gain_tolerance = 1",
       "rig.toml:13: channels.near.gain_tolerance: must be at least 0 and less than 1, is 1"},
      {"gain_tolerance = 0.05", "position = 0.1",
       "rig.toml:13: channels.near.position: only a channel that measures the string's motion has a position"},
      {"ac_coupled_Hz = 0.5", "ac_coupled_Hz = 0",
       "rig.toml:14: channels.far.ac_coupled_Hz: must be larger than 0 and at most 10000, is 0"},
      {"index = 2, quantity = \"string-velocity\"", "index = 2",
       "rig.toml:15: channels.magnet.quantity: is missing\nrig.toml:15: channels.magnet.position: only a channel that measures "
       "the string's motion has a position"},
      {"string-velocity", "string-velocty",
       "rig.toml:15: channels.magnet.position: only a channel that measures the string's motion has a position\nrig.toml:15: "
       "channels.magnet.quantity: unknown name \"string-velocty\"; did you mean string-velocity?"},
      {"position = 0.30 }", "position = 1.0 }",
       "rig.toml:15: channels.magnet.position: must be larger than 0 and less than 1, is 1"},
      {"position = 0.30 }", "newtons_per_full_scale = 2 }",
       "rig.toml:15: channels.magnet.newtons_per_full_scale: is no scale of the quantity string-velocity"},
      {"\"bow-speed\"", "\"termination-force\"",
       "rig.toml:16: channels.sled.metres_per_second_per_full_scale: is no scale of the quantity termination-force\nrig.toml:16: "
       "channels.sled.newtons_per_full_scale: is missing\nrig.toml:16: channels.sled.quantity: the channels near and far, and "
       "only they, measure termination-force"},
      {"gain_tolerance = 0.05", "quantity = \"unused\"",
       "rig.toml:13: channels.near.newtons_per_full_scale: is no scale of the quantity unused\nrig.toml:13: "
       "channels.near.quantity: the channels near and far, and only they, measure termination-force"},
      {"sled = { index = 4, quantity = \"bow-speed\", metres_per_second_per_full_scale = 1 }", "sled = 4",
       "rig.toml:16: channels.sled: must be a table, as { index = 0, ... }"},
  };
  // the order within a line is that of discovery
  for (const auto& row : rows) {
    CAPTURE(row.from);
    CAPTURE(row.to);
    const std::string said = test::problems_of(test::changed(row.from, row.to));
    std::istringstream lines{std::string{row.message}};
    for (std::string line; std::getline(lines, line);) CHECK(said.find(line) != std::string::npos);
    CHECK(said.size() == row.message.size());
  }
}

TEST_CASE("every quantity has its own scale") {
  for (const auto& row : {std::pair{"string-displacement", "metres_per_full_scale"},
                          {"sound", "pascals_per_full_scale"},
                          {"normal-force", "newtons_per_full_scale"},
                          {"bow-speed", "metres_per_second_per_full_scale"}}) {
    const auto [quantity, key] = row;
    CAPTURE(row.first);
    const auto text = test::changed("quantity = \"bow-speed\", metres_per_second_per_full_scale = 1",
                                    std::string{"quantity = \""} + quantity + "\", " + key + " = 3");
    const auto r = rosin::parse_rig(text, "rig.toml");
    CHECK(r.error() == "");
    REQUIRE(r);
    CHECK(r->channel("sled")->per_full_scale == 3.0);
  }
}

TEST_CASE("[terminations]: rigid, fit, modes or a file") {
  constexpr test::bad_key rows[] = {
      {"near = \"fit\"", "near = 3", "rig.toml:27: terminations.near: must be a text in quotes"},
      {"near = \"fit\"", "left = \"fit\"", "rig.toml:27: terminations.left: unknown key; known here: near, far"},
      {"near = \"fit\"", "near = {}", "rig.toml:27: terminations.near.modes: is missing"},
      {"[ { frequency_Hz = 460, q = 35, mass_kg = 0.12 } ]", "[]", "rig.toml:28: terminations.far.modes: is empty"},
      {"[ { frequency_Hz = 460, q = 35, mass_kg = 0.12 } ]", "1",
       "rig.toml:28: terminations.far.modes: must be a list, as [ { frequency_Hz = 460, q = 35, mass_kg = 0.12 } ]"},
      {"[ { frequency_Hz = 460, q = 35, mass_kg = 0.12 } ]", "[1]", "rig.toml:28: terminations.far.modes[0]: must be a table"},
      {"frequency_Hz = 460, ", "", "rig.toml:28: terminations.far.modes[0].frequency_Hz: is missing"},
      {"q = 35, ", "", "rig.toml:28: terminations.far.modes[0].q: is missing"},
      {", mass_kg = 0.12", "", "rig.toml:28: terminations.far.modes[0].mass_kg: is missing"},
      {"mass_kg = 0.12", "mass_kg = -0.12",
       "rig.toml:28: terminations.far.modes[0].mass_kg: must be larger than 0 and at most 10000, is -0.12"},
      {"mass_kg = 0.12", "mass_g = 120",
       "rig.toml:28: terminations.far.modes[0].mass_kg: is missing\nrig.toml:28: terminations.far.modes[0].mass_g: unknown key; "
       "did you mean mass_kg?"},
  };
  CHECK_BAD_KEYS(rows)
}

TEST_CASE("a column by its name instead of its place; a variable is one") {
  const auto sled = [](const std::string& how) { return test::changed("sled = { index = 4,", "sled = { " + how); };
  for (const char* key : {"column", "variable"}) {
    const auto r = rosin::parse_rig(sled(std::string{key} + " = \"v (m/s)\","), "rig.toml");
    CHECK(r.error() == "");
    REQUIRE(r);
    CHECK(r->channel("sled")->column == "v (m/s)");
    CHECK(r->channel("sled")->index == -1);
  }
  CHECK(test::problems_of(sled("")) == "rig.toml:16: channels.sled.index: is missing");
  CHECK(test::problems_of(sled("index = 4, column = \"v\",")) ==
        "rig.toml:16: channels.sled.column: contradicts index, which stands beside it");
  CHECK(test::problems_of(sled("column = 4,")) == "rig.toml:16: channels.sled.column: must be a text in quotes");
}

TEST_CASE("where the takes are tables, columns are in SI units unless a scale is given") {
  constexpr std::string_view tables = R"(schema = 1
[string]
length_m = 0.7
tension_N = 145
fundamental_Hz = 98
[channels]
normal = { index = 0, quantity = "normal-force" }
bow = { index = 1, quantity = "bow-speed", metres_per_second_per_full_scale = 0.001 }
near = { index = 2 }
far = { index = 3 }
[files]
rate_Hz = 50000
[[take]]
name = "whole_1"
kind = "bow"
file = "whole_1.csv"
contact_position = 0.1
)";
  const auto r = rosin::parse_rig(tables, "rig.toml");
  CHECK(r.error() == "");
  REQUIRE(r);
  CHECK(r->channel("near")->per_full_scale == 1.0);
  CHECK(r->channel("near")->scale_assumed);
  CHECK(r->channel("bow")->per_full_scale == 0.001);
  CHECK_FALSE(r->channel("bow")->scale_assumed);
  CHECK(test::problems_of(test::changed("whole_1.csv", "whole_1.wav", tables)) ==
        "rig.toml:9: channels.near.newtons_per_full_scale: is missing\n"
        "rig.toml:10: channels.far.newtons_per_full_scale: is missing\n"
        "rig.toml:13: take[0].normal_force_N: is missing");
}
