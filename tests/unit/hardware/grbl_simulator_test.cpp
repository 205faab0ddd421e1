// SPDX-License-Identifier: MIT
#include <rosin/hardware/grbl_simulator.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("a stroke is the trapezoid that was asked for") {
  rosin::grbl_simulator sled;
  CHECK(sled.receive("$120=1000\n", 0) == "ok\r\n");
  CHECK(sled.receive("G21G91G1X-100F12000\n", 0) == "ok\r\n");  // 0.2 m/s: 0.2 s and 20 mm up, 60 mm in 0.3 s, 0.2 s down
  CHECK(sled.advance(0.1).empty());
  CHECK(sled.speed_m_s() == test::approx(0.1).epsilon(0.01));
  CHECK(sled.position_m() == test::approx(-0.005).epsilon(0.01));
  CHECK(sled.advance(0.3).empty());
  CHECK(sled.speed_m_s() == test::approx(0.2));
  CHECK(sled.position_m() == test::approx(-0.04).epsilon(0.01));
  CHECK(sled.receive("?", 0.3).starts_with("<Run|MPos:-40.0"));
  CHECK(sled.advance(0.68).empty());
  CHECK(sled.moving());
  CHECK(sled.advance(0.72).empty());
  CHECK_FALSE(sled.moving());
  CHECK(sled.receive("?", 0.72) == "<Idle|MPos:-100.000,0.000,0.000|FS:0,0>\r\n");
}

TEST_CASE("feed hold, going on, reset while moving, limits") {
  rosin::grbl_simulator sled;
  sled.settings[120] = 1000;
  CHECK(sled.receive("G21G91G1X-100F12000\n", 0) == "ok\r\n");
  CHECK(sled.receive("!", 0.3).empty());
  CHECK(sled.receive("?", 0.4).starts_with("<Hold:1|"));
  CHECK(sled.receive("?", 0.6).starts_with("<Hold:0|MPos:-60.0"));  // 40 + 20 mm to slow down
  CHECK(sled.receive("~?", 0.7).starts_with("<Run|"));
  CHECK(sled.receive("?", 1.5).starts_with("<Idle|MPos:-100.000"));
  CHECK(sled.receive("G91G1X-301F12000\n", 1.5).starts_with("ALARM:2"));
  CHECK(sled.receive("?$X\n", 1.5).empty());  // as GRBL: nothing but a reset helps
  CHECK(sled.receive("\x18", 1.5).find("to unlock") != std::string::npos);
  CHECK(sled.receive("G91G1X-1F12000\n", 1.5) == "error:9\r\n");
  CHECK(sled.receive("$X\n", 1.5).find("ok") != std::string::npos);
  CHECK(sled.receive("G91G1X50F12000\n", 1.5) == "ok\r\n");
  CHECK(sled.receive("$120=5\n", 1.6) == "error:8\r\n");
  CHECK(sled.receive("\x18", 1.7).find("ALARM:3") != std::string::npos);
  CHECK(sled.receive("$X\n", 1.7).find("ok") != std::string::npos);
  sled.switch_mm = -70;
  CHECK(sled.receive("G91G1X60F12000\n", 1.7) == "ok\r\n");
  CHECK(sled.advance(3).starts_with("ALARM:1"));
  CHECK(sled.position_m() == test::approx(-0.07).epsilon(0.01));
}

TEST_CASE("dialects: work coordinates, inches, reports that nobody asked for; silence while it homes") {
  rosin::grbl_simulator sled;
  sled.reports_work = true;
  CHECK(sled.receive("?", 0) == "<Idle|WPos:0.000,0.000,0.000|FS:0,0>\r\n");
  sled.offset_mm = -25.4;
  sled.settings[13] = 1;
  CHECK(sled.receive("?", 0) == "<Idle|WPos:1.000,0.000,0.000|FS:0.000,0|WCO:-1.000,0.000,0.000>\r\n");
  sled.report_every_s = 0.1;
  CHECK(sled.advance(0.05).starts_with("<Idle|"));
  CHECK(sled.advance(0.09).empty());
  sled.report_every_s = 0;
  sled.settings[22] = 1;
  sled.home_s = 2;
  CHECK(sled.receive("$H\n", 1).empty());
  CHECK(sled.receive("?$$\n", 2).empty());
  CHECK(sled.advance(3.1) == "ok\r\n");
  CHECK(sled.receive("$H\n", 4).empty());
  CHECK(sled.receive("\x18", 5).starts_with("ALARM:6"));
}
