// SPDX-License-Identifier: MIT
#include <rosin/hardware/grbl_lines.hpp>

#include <doctest/doctest.h>

#include <vector>

namespace {

/// The text in pieces of so many bytes.
std::vector<std::string> lines_of(const std::string& text, std::size_t piece) {
  rosin::grbl_lines from;
  std::vector<std::string> out;
  for (std::size_t at = 0; at < text.size(); at += piece) {
    const std::string part = text.substr(at, piece);
    from.push({reinterpret_cast<const std::uint8_t*>(part.data()), part.size()});
    while (auto line = from.next()) out.push_back(*std::move(line));
  }
  return out;
}

}  // namespace

TEST_CASE("lines come whole, in whatever pieces, with reports that cut them taken out") {
  const std::string report = "<Idle|MPos:0.000,0.000,0.000|FS:0,0>";
  const std::string text = "\r\nGrbl 1.1h ['$' for help]\r\n$110=60" + report + "\r\n000.000\r\no" + report + "\r\nk\r\nok\r" +
                           report + "\r\n\n  [MSG:a < b > c]\n" + report + "\r\n" + report + "ok\r\n";
  const std::vector<std::string> right{"Grbl 1.1h ['$' for help]", report, "$110=60000.000", report, "ok", report, "ok",
                                       "[MSG:a < b > c]",          report, report,           "ok"};
  for (const std::size_t piece : {1U, 2U, 3U, 7U, 1000U}) CHECK(lines_of(text, piece) == right);
}

TEST_CASE("noise and what never ends a line: nothing grows, and the next line is whole") {
  CHECK(lines_of(std::string("\xff\x00\xfeGrbl 1.1\n", 12), 1) == std::vector<std::string>{"Grbl 1.1"});
  CHECK(lines_of(std::string(100000, '<') + "\nok\n", 100) == std::vector<std::string>{"ok"});
  CHECK(lines_of("half", 4).empty());
}
