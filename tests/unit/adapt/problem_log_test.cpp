// SPDX-License-Identifier: MIT
#include <rosin/adapt/problem_log.hpp>

#include <doctest/doctest.h>

#include <array>

TEST_CASE("problems come by line, each once, with file and place") {
  rosin::problem_log log{"rig.toml"};
  CHECK(log.empty());
  log.add(12, "string.tension_N", "must be larger than 0, is -3");
  log.add(3, "schema", "is missing");
  log.add(12, "string.tension_N", "must be larger than 0, is -3");
  log.add(0, "", "cannot be read");
  CHECK(log.size() == 3);
  CHECK(log.to_failure().message ==
        "rig.toml: cannot be read\nrig.toml:3: schema: is missing\nrig.toml:12: string.tension_N: must be larger than 0, is -3");
}

TEST_CASE("what a file holds cannot break a message in two or run on for ever") {
  rosin::problem_log log{"a"};
  log.add(1, "x\ny\x1b[2J", std::string(5000, 'z'));
  const std::string text = log.to_failure().message;
  CHECK(text.find('\n') == std::string::npos);
  CHECK(text.find('\x1b') == std::string::npos);
  CHECK(text.size() < 1100);
}

TEST_CASE("the distance of Levenshtein, capitals aside") {
  CHECK(rosin::edit_distance("", "") == 0);
  CHECK(rosin::edit_distance("kitten", "sitting") == 3);
  CHECK(rosin::edit_distance("tension_n", "tension_N") == 0);
  CHECK(rosin::edit_distance("", "abc") == 3);
  CHECK(rosin::edit_distance("abc", "ca") == 3);
}

TEST_CASE("the nearest name is suggested, and all of them where none is near") {
  constexpr std::array names{"length_m", "tension_N", "fundamental_Hz"};
  CHECK(rosin::suggestion("lenght_m", names) == "; did you mean length_m?");
  CHECK(rosin::suggestion("fundamental", names) == "; did you mean fundamental_Hz?");
  CHECK(rosin::suggestion("colour", names) == "; known here: length_m, tension_N, fundamental_Hz");
  CHECK(rosin::suggestion(std::string(100000, 'x'), names).size() < 60);
}
