// SPDX-License-Identifier: MIT
#include <rosin/hardware/grbl_protocol.hpp>

#include <doctest/doctest.h>

#include <rosin/hardware/grbl_simulator.hpp>

#include <clocale>
#include <cstdlib>
#include <support/temporary_folder.hpp>

#include "support/approx.hpp"

TEST_CASE("status reports of GRBL 1.1, as its manual shows them, and of its relatives") {
  auto s = rosin::parse_grbl_status("<Run|MPos:-12.500,0.000,0.000|FS:12000,0>");
  REQUIRE(s);
  CHECK(s->state == rosin::motion_state::running);
  CHECK(s->machine == -12.5);
  CHECK(s->feed == 12000);
  s = rosin::parse_grbl_status("<Hold:1|MPos:0.000,-10.000,5.000|Bf:15,128|F:600|WCO:1.500,0.000,0.000>");
  REQUIRE(s);
  CHECK(s->state == rosin::motion_state::holding);
  CHECK_FALSE(s->at_rest);
  CHECK(s->feed == 600);
  CHECK(s->offset == 1.5);
  s = rosin::parse_grbl_status("<Hold:0|WPos:-4.000,0.000,0.000>");
  REQUIRE(s);
  CHECK(s->at_rest);
  CHECK(s->work == -4);
  CHECK_FALSE(s->machine);
  CHECK_FALSE(s->feed);
  s = rosin::parse_grbl_status("<Idle,MPos:5.529,0.560,7.000,WPos:1.529,-5.440,-0.000>");  // version 0.9
  REQUIRE(s);
  CHECK(s->state == rosin::motion_state::idle);
  CHECK(s->machine == 5.529);
  CHECK(rosin::parse_grbl_status("<Alarm:11|MPos:1.000,0.000,0.000|FS:0,0>")->state == rosin::motion_state::alarm);
  CHECK(rosin::parse_grbl_status("<Home|MPos:1.000,0.000,0.000>")->homing);
  s = rosin::parse_grbl_status("<Odd|MPos:1,2,3>");
  REQUIRE(s);
  CHECK_FALSE(s->state);
  CHECK(s->word == "Odd");
  for (const char* none : {"ok", "", "<>", "<Idle>", "<Idle|MPos:x>", "[MSG:<b>]"}) CHECK_FALSE(rosin::parse_grbl_status(none));
}

TEST_CASE("greetings, and numbers for the controller") {
  for (const char* one : {"Grbl 1.1h ['$' for help]", "GrblHAL 1.1f ['$' or '$HELP' for help]", "grblHAL 1.1f",
                          "Grbl 3.6 [FluidNC v3.6.8 (wifi) '$' for help]"})
    CHECK(rosin::is_grbl_greeting(one));
  for (const char* none : {"grbl", "ok", "", "[MSG:Grbl]", "Marlin 2.1"}) CHECK_FALSE(rosin::is_grbl_greeting(none));
  CHECK(rosin::grbl_number(-40.5) == "-40.500");
  CHECK(rosin::grbl_number(1e300).size() == 305);
}

TEST_CASE("a program with decimal commas speaks and understands the controller's language all the same") {
  const test::temporary_folder folder;
  const std::string path = folder.str();
  const bool made = std::system(("localedef -i de_DE -f UTF-8 " + path + "/de_DE.UTF-8 >" + path + "/said 2>&1").c_str()) == 0;
  ::setenv("LOCPATH", path.c_str(), 1);
  const bool german = made && std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  if (german) CHECK(*std::localeconv()->decimal_point == ',');
  else MESSAGE("there is no localedef, or no German to make: tried in the locale that there is");
  CHECK(rosin::grbl_number(-40.5) == "-40.500");
  CHECK(rosin::parse_grbl_status("<Idle|MPos:-12.500,0.000,0.000|FS:0,0>")->machine == -12.5);
  CHECK(rosin::parse_grbl_setting("$120=10.500")->second == 10.5);
  rosin::grbl_simulator sled;
  CHECK(sled.receive("$120=10.500\n", 0) == "ok\r\n");
  CHECK(sled.receive("$$\n", 0).find("$120=10.500\r\n") != std::string::npos);
  CHECK(sled.receive("G21G91G1X-40.500F12000.000\n", 0) == "ok\r\n");
  std::setlocale(LC_ALL, "C");
  ::unsetenv("LOCPATH");
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
  CHECK(rosin::parse_grbl_setting("$110=500.000 (x max rate, mm/min)")->second == 500);
  CHECK(rosin::grbl_error("error: Bad number format").value() == "error: Bad number format");
  CHECK_FALSE(rosin::grbl_alarm("ok"));
  CHECK_FALSE(rosin::grbl_error("ALARM:1"));
}
