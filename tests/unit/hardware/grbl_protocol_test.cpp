// SPDX-License-Identifier: MIT
#include <rosin/hardware/grbl_protocol.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("status reports of GRBL 1.1, as its manual shows them") {
  auto s = rosin::parse_grbl_status("<Run|MPos:-12.500,0.000,0.000|FS:12000,0>");
  REQUIRE(s);
  CHECK(s->state == rosin::motion_state::running);
  CHECK(s->position_m == test::approx(-0.0125));
  CHECK(s->speed_m_s == test::approx(0.2));
  s = rosin::parse_grbl_status("<Hold:1|MPos:0.000,-10.000,5.000|Bf:15,128|F:600|WCO:0.000,0.000,0.000>");
  REQUIRE(s);
  CHECK(s->state == rosin::motion_state::holding);
  CHECK(s->speed_m_s == test::approx(0.01));
  CHECK(rosin::parse_grbl_status("<Alarm|MPos:1.000,0.000,0.000|FS:0,0>")->state == rosin::motion_state::alarm);
  CHECK(rosin::parse_grbl_status("<Idle|MPos:1.000,0.000,0.000>")->state == rosin::motion_state::idle);
  for (const char* none : {"ok", "", "<>", "<Idle>", "<Idle|WPos:1,2,3>", "<Odd|MPos:1,2,3>", "<Idle|MPos:x>"})
    CHECK_FALSE(rosin::parse_grbl_status(none));
}

TEST_CASE("settings, errors and alarms") {
  const auto setting = rosin::parse_grbl_setting("$120=10.500");
  REQUIRE(setting);
  CHECK(setting->first == 120);
  CHECK(setting->second == 10.5);
  for (const char* none : {"$", "$=", "$x=1", "$1=", "120=1", "$99999=1"}) CHECK_FALSE(rosin::parse_grbl_setting(none));
  CHECK(rosin::grbl_error("error:9").value().find("locked") != std::string::npos);
  CHECK(rosin::grbl_error("error:999").value() == "error:999 (unknown)");
  CHECK(rosin::grbl_alarm("ALARM:1").value().find("hard limit") != std::string::npos);
  CHECK_FALSE(rosin::grbl_alarm("ok"));
  CHECK_FALSE(rosin::grbl_error("ALARM:1"));
}
