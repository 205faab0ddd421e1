// SPDX-License-Identifier: MIT
#include <rosin/adapt/toml_guard.hpp>

#include <doctest/doctest.h>

namespace {

int line_of(std::string_view text) {
  const auto fault = rosin::find_toml_fault(text);
  return fault ? fault->line : 0;
}

}  // namespace

TEST_CASE("headers that do not begin with a key are found, with their line") {
  CHECK(line_of("[&") == 1);
  CHECK(line_of("a = 1\n[[[b]]]\n") == 2);
  CHECK(line_of("a = 1\n\n  [ +b]\n") == 3);
  CHECK(line_of("[[=") == 1);
  CHECK(line_of("[\n") == 1);
  CHECK(line_of("[#b]\n") == 1);
  CHECK(line_of("[\xc3\xa4]\n") == 1);
  CHECK(line_of("a = '''\n[&\n'''\n[&") == 4);
  CHECK(line_of("a = \"x\n[&") == 2);  // a string that was not closed ends with its line
}

TEST_CASE("sound headers, and what looks like one inside of a list or a string") {
  for (const std::string_view text :
       {"[a]", "[ a . b ]\n", "[[take]]", "[\"a b\"]", "['x']", "[-]", "[_1]", "[]", "[", "[[", "",
        "a = [\n[+1, 2],\n[{}]\n]\n[b]", "a = { b = [\n[#c\n] ] }\n", "a = \"\"\"\n[&\n\\\"\"\"\n[&\n\"\"\"\n[b]",
        "a = '''\n[&\n'''", "# [&\n#[&", "a = \"[\\\"\" # [\n[b]", "a = '\\'\n[b]", "a = 1 [&"}) {
    CAPTURE(text);
    CHECK(line_of(text) == 0);
  }
}

TEST_CASE("brackets that close nothing") {
  CHECK(line_of("a = [ }") == 1);
  CHECK(line_of("\na = { b = ] }") == 2);
  CHECK(line_of("a = ]") == 1);
  CHECK(line_of("a = [\n{ b = [ 1, 2 ] } # ]\n]\n'}' = ']'") == 0);
  CHECK(line_of("a = [") == 0);  // toml++ says that itself
}

TEST_CASE("strings begin where a key or a value may") {
  CHECK(line_of("a = 2b'''\xc5\x8a'''") == 1);
  CHECK(line_of("a 'b' = 1") == 1);
  CHECK(line_of("a = ''''x'''''\n[b]\nc = \"\"\"\"y\"\"\"\"") == 0);
  CHECK(line_of("\"a\".'b' = [ 'c', \"d\",\n'e' ]\n['f']\n[[ \"g\" ]]\nh = { 'i' = '' }") == 0);
}

TEST_CASE("letters beyond ASCII belong into strings and comments") {
  CHECK(line_of("a = 1\ng\xc5\x8a") == 2);
  CHECK(line_of("a = \xc2\xa0") == 1);
  CHECK(line_of("\xef\xbb\xbf# \xc5\x8a\na = \"\xc5\x8a\" # \xc5\x8a\nb = '''\n\xc5\x8a'''\n\"\xc5\x8a\" = 1") == 0);
}

TEST_CASE("control characters other than tab and line break are no TOML") {
  CHECK(line_of(std::string_view{"a = 1\nb\0 = 2", 11}) == 2);
  CHECK(line_of("a = '\x1b'") == 1);
  CHECK(line_of("a = '\x7f'") == 1);
  CHECK(line_of("a\t= 1\r\n") == 0);
}
