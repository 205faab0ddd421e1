// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_findings.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

using namespace rosin;

TEST_CASE("pickup_namer: strays become hum and strings, and evidence adds up") {
  pickup_diagnosis d;
  d.structures = {{}};
  d.strays.mains_Hz = 50, d.strays.resolution_Hz = 1;
  d.strays.hum = {{50, 0.1, 200, 1}, {150, 0.05, 50, 1}};
  d.strays.others = {{329.6, 0.2, 400, 0.5}, {659.3, 0.1, 90, 0.5}, {247, 0.01, 80, 0.6}};
  d.law.alone = {{"bending-stiffness", 3.0}};
  const pickup_question ask{220, {}, {}};
  detail::pickup_namer{d, ask}.name_all();
  REQUIRE(d.missing.size() == 3);
  CHECK(d.missing[0].effect == "mains-hum");
  CHECK(d.missing[1].values[0].value == test::approx(247));
  CHECK(d.missing[2].effect == "sympathetic-string");
  CHECK(d.missing[2].gain == test::approx(490));  // with its second partial
  CHECK(d.missing[2].values[0].value == test::approx(329.6));
  REQUIRE(d.ranking.size() > 2);
  CHECK(d.ranking.front().first.size() == 3);
  CHECK(d.ranking.front().second == 0);
  const auto stiff = std::find_if(d.ranking.begin(), d.ranking.end(),
                                  [](const auto& r) { return r.first == std::vector<std::string>{"bending-stiffness"}; });
  REQUIRE(stiff != d.ranking.end());
  CHECK(stiff->second == test::approx(3.0 - 820));
}

TEST_CASE("pickup_question: what is declared, or is not to be known, is not asked for") {
  const pickup_question ask{220, {"bending-stiffness"}, {"mains-hum"}};
  CHECK(ask.is_declared("bending-stiffness"));
  CHECK_FALSE(ask.is_declared("mains-hum"));
  CHECK_FALSE(ask.asks_for("bending-stiffness"));
  CHECK_FALSE(ask.asks_for("mains-hum"));
  CHECK(ask.asks_for("air-loss"));
}
