// SPDX-License-Identifier: MIT
#include <rosin/adapt/toml_fields.hpp>

#include <doctest/doctest.h>

namespace {

struct reading {
  toml::table table;
  rosin::problem_log log{"a.toml"};
  rosin::toml_fields fields;

  explicit reading(std::string_view text) : table{toml::parse(text)}, fields{table, "t", log} {}
  [[nodiscard]] std::string problems() const { return log.to_failure().message; }
};

}  // namespace

TEST_CASE("a number may be written as a whole one, and has to be finite and in its range") {
  reading r{"a = 2\nb = 2.5\nc = -1\nd = nan\ne = '3'\nf = inf"};
  CHECK(r.fields.number("a", rosin::up_to(10)) == 2.0);
  CHECK(r.fields.number("b", rosin::up_to(10)) == 2.5);
  CHECK_FALSE(r.fields.number("missing", rosin::up_to(10)));
  CHECK(r.log.empty());
  CHECK_FALSE(r.fields.number("c", rosin::up_to(10)));
  CHECK_FALSE(r.fields.number("d", rosin::up_to(10)));
  CHECK_FALSE(r.fields.number("e", rosin::up_to(10)));
  CHECK_FALSE(r.fields.number("f", {}));
  CHECK(r.problems() ==
        "a.toml:3: t.c: must be larger than 0 and at most 10, is -1\n"
        "a.toml:4: t.d: must be larger than 0 and at most 10, is nan\n"
        "a.toml:5: t.e: must be a number\n"
        "a.toml:6: t.f: must be a finite number, is inf");
}

TEST_CASE("whole numbers, texts, flags and choices say what they want to be") {
  reading r{"i = 1.5\nj = 70\nk = ''\nl = 3\nm = 'yes'\nn = 'blu'"};
  constexpr std::array colours{"red", "blue"};
  CHECK_FALSE(r.fields.integer("i", 0, 9));
  CHECK_FALSE(r.fields.integer("j", 0, 9));
  CHECK_FALSE(r.fields.text("k"));
  CHECK_FALSE(r.fields.text("l"));
  CHECK_FALSE(r.fields.flag("m"));
  CHECK_FALSE(r.fields.choice("n", colours));
  CHECK(r.problems() ==
        "a.toml:1: t.i: must be a whole number\na.toml:2: t.j: must be 0 ... 9, is 70\n"
        "a.toml:3: t.k: must not be empty\na.toml:4: t.l: must be a text in quotes\n"
        "a.toml:5: t.m: must be true or false\na.toml:6: t.n: unknown name \"blu\"; did you mean blue?");
}

TEST_CASE("tables and lists") {
  reading r{"a = { x = 1 }\nb = [ { x = 2 }, 7 ]\nc = 5\nd = 5"};
  CHECK(r.fields.table("a") != nullptr);
  int seen = 0;
  r.fields.each_table("b", "a list", [&](rosin::toml_fields one) { seen += one.number("x", {}) ? 1 : 0; });
  CHECK(seen == 1);
  CHECK(r.fields.table("c") == nullptr);
  CHECK(r.fields.list("d", "a list of things") == nullptr);
  CHECK(r.problems() ==
        "a.toml:2: t.b[1]: must be a table\na.toml:3: t.c: must be a table\na.toml:4: t.d: must be a list of things");
}

TEST_CASE("keys that nobody asked for are unknown, with the nearest that was asked for") {
  reading r{"lenght = 1\nwidth = 2"};
  (void)r.fields.number("length", {});
  (void)r.fields.number("width", {});
  r.fields.unknown();
  CHECK(r.problems() == "a.toml:1: t.lenght: unknown key; did you mean length?");
}

TEST_CASE("a missing key has the line of its table") {
  const auto table = toml::parse("\n\n[t]\na = 1");
  rosin::problem_log log{"a.toml"};
  rosin::toml_fields fields{*table["t"].as_table(), "t", log};
  (void)fields.required_number("b", rosin::up_to(1));
  CHECK(log.to_failure().message == "a.toml:3: t.b: is missing");
}
