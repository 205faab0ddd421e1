// SPDX-License-Identifier: MIT
#include <rosin/adapt/rig_edit.hpp>

#include <doctest/doctest.h>

namespace adapt_rig_edit {

namespace {

const std::string block = "\n[[take]]\nname = \"b\"\nkind = \"quiet\"\nfile = \"b.wav\"\n";

/// What was put in, where all else is as it was.
std::string added(const std::string& before) {
  const auto after = rosin::with_take(before, block, "rig.toml");
  REQUIRE_MESSAGE(after.has_value(), after.error());
  std::size_t same = 0;
  while (same < before.size() && (*after)[same] == before[same]) ++same;
  CHECK(after->ends_with(before.substr(same)));
  const auto takes = rosin::find_named_takes(*after, "rig.toml");
  REQUIRE(takes.has_value());
  CHECK(takes->back().name == "b");
  CHECK(takes->back().file == "b.wav");
  return after->substr(same, after->size() - before.size());
}

}  // namespace

TEST_CASE("a take is put in at the end; every line of the text stays, comments too") {
  const std::string text = "# mine\nschema = 1\n[[take]] # the first\nname = \"a\"\nfile = 'a.wav'\n\n# last words\n";
  CHECK(added(text) == block);
  CHECK(added(text + "[friction]\nmodel = \"thermal\" # after the takes\n") == block);
  CHECK(added("") == block);
  CHECK(added("# no break at the end") == "\n" + block);
  CHECK(added("schema = 1\r\n") == "\r\n[[take]]\r\nname = \"b\"\r\nkind = \"quiet\"\r\nfile = \"b.wav\"\r\n");
}

TEST_CASE("takes in a list in brackets stay one, with their comments") {
  const std::string one = "{ name = \"b\", kind = \"quiet\", file = \"b.wav\" }";
  CHECK(added("take = []\n[string]\nlength_m = 1\n") == "\n  " + one);
  CHECK(added("title = \"Saite, größer\"\ntake = [ {name = \"ä\", file = \"a.wav\"} ] # all\n[string]\n") == ",\n  " + one);
  CHECK(added("take = [\n  {name = \"a\", file = \"a.wav\"}, # the first\n]\n") == "\n  " + one + ",");
}

TEST_CASE("what nothing can be added to is refused by name, and so is what is no TOML") {
  CHECK(rosin::with_take("take = 3\n", block, "rig.toml").error() ==
        "rig.toml: take: must be a list of tables, each headed [[take]]");
  CHECK(rosin::with_take("take = [\n", block, "rig.toml").error().starts_with("rig.toml:"));
  CHECK(rosin::with_take("a = 'broken\n", block, "rig.toml").error().starts_with("rig.toml:1"));
}

TEST_CASE("remarks stand below the take that they are about") {
  const std::string head = "[[take]]\nname = \"a\"\nprofile = [[0, 0],\n  [1, 2]] # steady\n",
                    rest = "\n# next\n[[take]]\nfile = \"b.wav\"";
  const auto text = [&](const std::string& file) {
    return rosin::with_remarks(head + "file = \"a.wav\"\n" + rest, file, {"x", "y"}, "f");
  };
  CHECK(*text("a.wav") == head + "file = \"a.wav\"\n# x\n# y\n" + rest + "\n");
  CHECK(*text("b.wav") == head + "file = \"a.wav\"\n" + rest + "\n# x\n# y\n");
  CHECK(*text("c.wav") == head + "file = \"a.wav\"\n" + rest + "\n# x\n# y\n");
  CHECK(*rosin::with_remarks("[[take]]\nfile = \"a.wav\"\nprofile = [[0, 0],\n  [1, 2]] # steady\n[string]\n", "a.wav", {"x"},
                             "f") == "[[take]]\nfile = \"a.wav\"\nprofile = [[0, 0],\n  [1, 2]] # steady\n# x\n[string]\n");
}

}  // namespace adapt_rig_edit
