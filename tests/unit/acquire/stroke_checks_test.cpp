// SPDX-License-Identifier: MIT
#include <rosin/acquire/stroke_checks.hpp>

#include <doctest/doctest.h>

#include <rosin/acquire/checks.hpp>
#include <support/bowed_take.hpp>

namespace acquire_stroke_checks {

namespace {

std::string kinds(const test::stroke& s, std::vector<std::vector<double>> columns, const rosin::rig& rig) {
  const auto c = rosin::check_take(rig, rig.takes[0], test::signals_from(s, std::move(columns)));
  std::string out;
  for (const auto& f : c.findings) out += f.kind + "(" + f.channel + ":" + name_of(f.level) + ") ";
  return out;
}
std::string kinds(const test::stroke& s, std::vector<std::vector<double>> columns) {
  return kinds(s, std::move(columns), test::bowing_machine(s));
}

}  // namespace

TEST_CASE("a sound stroke raises no alarm; its offset is a note; its motion is told") {
  test::stroke s;
  CHECK(kinds(s, test::bowed_columns(s)) == "offset(normal:note) ");
  s.lift_s = 10;
  CHECK(kinds(s, test::bowed_columns(s)) == "offset(normal:note) ");
  s.onset_s = 0;
  CHECK(kinds(s, test::bowed_columns(s)) == "");
  const auto rig = test::bowing_machine(s);
  const auto c = rosin::check_take(rig, rig.takes[0], test::bowed_signals(s));
  REQUIRE(c.motion);
  CHECK(c.motion->steady_speed_m_s);
  CHECK(c.motion->speed_m_s.empty());
}

TEST_CASE("columns that were swapped") {
  const test::stroke s;
  auto x = test::bowed_columns(s);
  std::swap(x[2], x[3]);
  CHECK(kinds(s, x).find("swapped-channels(:error)") != std::string::npos);
  x = test::bowed_columns(s);
  std::swap(x[1], x[2]);
  CHECK(kinds(s, x).find("swapped-channels(bow:error)") != std::string::npos);
  x = test::bowed_columns(s);
  std::swap(x[0], x[3]);
  CHECK(kinds(s, x).find("swapped-channels(normal:error)") != std::string::npos);
  x = test::bowed_columns(s);
  for (double& v : x[0]) v *= 0.1;  // a tenth of the force cannot drag the string so
  CHECK(kinds(s, x).find("friction-above-normal-force") == std::string::npos);
  test::stroke strong = s;
  strong.normal_force_N = 6, strong.offset_N = 0;
  x = test::bowed_columns(strong);
  for (double& v : x[0]) v *= 0.1;
  CHECK(kinds(strong, x).find("friction-above-normal-force(normal:warning)") != std::string::npos);
}

TEST_CASE("a force channel below zero, a bow that does not move") {
  test::stroke s;
  s.normal_force_N = 0.02, s.offset_N = -0.06;
  CHECK(kinds(s, test::bowed_columns(s)).find("below-zero(normal:warning)") != std::string::npos);
  s = {};
  auto x = test::bowed_columns(s);
  for (double& v : x[0]) v = -v;
  CHECK(kinds(s, x).find("below-zero(normal:error)") != std::string::npos);
  x = test::bowed_columns(s);
  for (std::size_t i = 0; i < x[1].size(); ++i) x[1][i] = i % 3 == 0 ? 1e-5 : -1e-5;
  CHECK(kinds(s, x).find("no-motion(bow:error)") != std::string::npos);
}

TEST_CASE("a wrong rate is told by the pitch; a string that slips twice or sounds flat is no fault") {
  test::stroke s;
  const auto x = test::bowed_columns(s);
  auto rig = test::bowing_machine(s);
  s.rate_Hz = 44100;
  CHECK(kinds(s, x, rig).find("wrong-pitch(near:error)") != std::string::npos);
  s = {};
  for (const double pitch : {0.99, 0.5, 2.0, 3.0}) {
    CAPTURE(pitch);
    s.sounds_Hz = pitch * s.fundamental_Hz;
    CHECK(kinds(s, test::bowed_columns(s)).find("wrong-pitch") == std::string::npos);
  }
}

TEST_CASE("steady_s where the bow does not move is doubted") {
  const test::stroke s;
  auto rig = test::bowing_machine(s);
  rig.takes[0].steady_s = {0.0, 0.1};
  CHECK(kinds(s, test::bowed_columns(s), rig).find("unsteady(bow:note)") != std::string::npos);
}

}  // namespace acquire_stroke_checks
