// SPDX-License-Identifier: MIT
#include <rosin/adapt/rig_takes.hpp>

#include <doctest/doctest.h>

#include <support/rig_text.hpp>

TEST_CASE("[[take]]: each key, its type, range and name") {
  constexpr test::bad_key rows[] = {
      {"name = \"pluck-1\"\n", "", "rig.toml:45: take[0].name: is missing"},
      {"name = \"pluck-1\"", "name = \"\"", "rig.toml:46: take[0].name: must not be empty"},
      {"name = \"pluck-1\"", "name = \"a/b\"", "rig.toml:46: take[0].name: must not hold / or \\"},
      {"name = \"pluck-1\"", "name = \"pluck\\n1\"", "rig.toml:46: take[0].name: must be one line, without control characters"},
      {"name = \"bow-1\"", "name = \"pluck-1\"",
       "rig.toml:59: take[2].name: \"pluck-1\" is the name of an earlier take, line 45"},
      {"kind = \"pluck\"\n", "", "rig.toml:45: take[0].kind: is missing"},
      {"kind = \"pluck\"", "kind = \"pluk\"", "rig.toml:47: take[0].kind: unknown name \"pluk\"; did you mean pluck?"},
      {"file = \"pluck-1.wav\"\n", "", "rig.toml:45: take[0].file: is missing"},
      {"file = \"pluck-1.wav\"", "file = \"/pluck-1.wav\"",
       "rig.toml:48: take[0].file: must be a path relative to the folder of the rig file"},
      {"force_N = 1.0\n", "", "rig.toml:45: take[0].force_N: is missing"},
      {"force_N = 1.0", "force_N = 0.0", "rig.toml:49: take[0].force_N: must be larger than 0 and at most 10000, is 0"},
      {"force_tolerance = 0.03", "force_tolerance = 3",
       "rig.toml:50: take[0].force_tolerance: must be at least 0 and less than 1, is 3"},
      {"contact_position = 0.25", "contact_position = 25",
       "rig.toml:51: take[0].contact_position: must be larger than 0 and less than 1, is 25"},
      {"contact_position = 0.25", "contact_position = 0.25\nposition_unknown = true",
       "rig.toml:52: take[0].position_unknown: contradicts contact_position, which stands beside it"},
      {"contact_position = 0.25", "position_unknown = 1", "rig.toml:51: take[0].position_unknown: must be true or false"},
      {"contact_position = 0.25", "strength = 0", "rig.toml:51: take[0].strength: must be larger than 0 and at most 1e+09, is 0"},
      {"contact_position = 0.25", "start_s = -1", "rig.toml:51: take[0].start_s: must be at least 0 and at most 3600, is -1"},
      {"contact_position = 0.25", "speed_m_s = 1", "rig.toml:51: take[0].speed_m_s: does not belong to a take of kind pluck"},
      {"contact_position = 0.25", "normal_force_N = 1",
       "rig.toml:51: take[0].normal_force_N: does not belong to a take of kind pluck"},
      {"file = \"quiet.wav\"", "file = \"quiet.wav\"\nforce_N = 1",
       "rig.toml:57: take[1].force_N: does not belong to a take of kind quiet"},
      {"hold_out = true", "steady_s = [0.2]", "rig.toml:65: take[2].steady_s: must be a pair of times, as [1.5, 1.9]"},
      {"hold_out = true", "steady_s = 0.2", "rig.toml:65: take[2].steady_s: must be a pair of times, as [1.5, 1.9]"},
      {"hold_out = true", "steady_s = [0.2, 0.2]", "rig.toml:65: take[2].steady_s: ends before it begins"},
      {"hold_out = true", "steady_s = [-1, 0.2]",
       "rig.toml:65: take[2].steady_s[0]: must be at least 0 and at most 1000000, is -1"},
      {"contact_position = 0.25", "steady_s = [0, 1]", "rig.toml:51: take[0].steady_s: does not belong to a take of kind pluck"},
      {"hold_out = true", "rate_Hz = 50000",
       "rig.toml:65: take[2].rate_Hz: belongs to a table of numbers: this file tells its own rate"},
      {"file = \"bow-1.wav\"", "file = \"bow-1.csv\"",
       "rig.toml:58: take[2].rate_Hz: is missing, and there is neither [files] rate_Hz nor [files] time_column: a table does not "
       "tell its rate"},
      {"speed_m_s = 0.20", "speed_m_s = -0.20", "rig.toml:62: take[2].speed_m_s: must be larger than 0 and at most 100, is -0.2"},
      {"normal_force_N = 0.30\n", "", "rig.toml:58: take[2].normal_force_N: is missing"},
      {"normal_force_N = 0.30", "normal_force_N = 0",
       "rig.toml:63: take[2].normal_force_N: must be larger than 0 and at most 10000, is 0"},
      {"normal_force_N = 0.30", "normal_force_N = 0.30\nforce_N = 1",
       "rig.toml:64: take[2].force_N: does not belong to a take of kind bow"},
      {"hold_out = true", "hold_out = \"yes\"", "rig.toml:65: take[2].hold_out: must be true or false"},
      {"hold_out = true", "holdout = true", "rig.toml:65: take[2].holdout: unknown key; did you mean hold_out?"},
      {"[[0, 0], [0.02, 0.2]]", "0.2",
       "rig.toml:64: take[2].speed_profile_m_s: must be a list of pairs, as [[0, 0], [0.05, 0.2]]"},
      {"[[0, 0], [0.02, 0.2]]", "[]", "rig.toml:64: take[2].speed_profile_m_s: is empty"},
      {"[0.02, 0.2]]", "[0.02]]", "rig.toml:64: take[2].speed_profile_m_s[1]: must be a pair [time in s, value]"},
      {"[0.02, 0.2]]", "[0, 0.2]]", "rig.toml:64: take[2].speed_profile_m_s[1]: is not later than the point before it"},
      {"hold_out = true", "position_profile = [[0, 0.3], [0.1, 1]]",
       "rig.toml:65: take[2].position_profile[1][1]: must be larger than 0 and less than 1, is 1"},
      {"hold_out = true", "position_profile = [[0, 0.3]]\ncontact_position = 0.2",
       "rig.toml:66: take[2].contact_position: contradicts position_profile, which stands beside it"},
      {"contact_position = 0.25", "position_profile = [[0, 0.3]]",
       "rig.toml:51: take[0].position_profile: does not belong to a take of kind pluck"},
      {"[0.02, 0.2]]", "[0.02, 'x']]", "rig.toml:64: take[2].speed_profile_m_s[1][1]: must be a number"},
  };
  CHECK_BAD_KEYS(rows)
}

TEST_CASE("positions: of the take, or of [contact], or unknown and said so") {
  const std::string without = test::changed("[contact]\nposition = 0.30\n", "");
  CHECK(test::problems_of(without) == "rig.toml:56: take[2].contact_position: is missing, and there is no [contact] position");
  CHECK(test::problems_of(test::changed("hold_out = true", "position_unknown = true", without)) == "");
  CHECK(test::problems_of(test::changed("hold_out = true", "contact_position = 0.1", without)) == "");
  CHECK(test::problems_of(test::changed("hold_out = true", "position_profile = [[0, 0.1], [0.2, 0.15]]", without)) == "");
}

TEST_CASE("what a channel measures need not be declared") {
  CHECK(test::problems_of(test::changed("speed_m_s = 0.20\n", "")) == "");  // the sled
  const std::string text = test::changed("speed_m_s = 0.20\n", "");
  CHECK(test::problems_of(test::changed(", metres_per_second_per_full_scale = 1 ", " ", text)) ==
        "rig.toml:58: take[2].speed_m_s: is missing");  // but not in metres per second
  CHECK(test::problems_of(test::changed("index = 4, quantity = \"bow-speed\", metres_per_second_per_full_scale",
                                        "index = 4, quantity = \"normal-force\", newtons_per_full_scale",
                                        test::changed("normal_force_N = 0.30\n", ""))) == "");
}

TEST_CASE("a table: its rate in the take, in [files], or a column of times") {
  const std::string text = test::changed("file = \"bow-1.wav\"", "file = \"bow-1.csv\"");
  const auto own =
      rosin::parse_rig(test::changed("hold_out = true", "rate_Hz = 50000\nsteady_s = [0.1, 0.25]", text), "rig.toml");
  CHECK(own.error() == "");
  REQUIRE(own);
  CHECK(own->takes[2].rate_Hz == 50000.0);
  CHECK(own->takes[2].steady_s == std::pair{0.1, 0.25});
  CHECK(test::problems_of(test::changed("[contact]", "[files]\nrate_Hz = 50000\n[contact]", text)) == "");
  CHECK(test::problems_of(test::changed("[contact]", "[files]\ntime_column = 0\n[contact]", text)) == "");
}

TEST_CASE("no takes, or something else in their place") {
  const std::string text{test::rig_text};
  const std::string head = text.substr(0, text.find("[[take]]"));
  CHECK(test::problems_of(head) == "rig.toml:1: take: is missing");
  CHECK(test::problems_of("take = 5\n" + head) == "rig.toml:1: take: must be a list of tables, each headed [[take]]");
}
