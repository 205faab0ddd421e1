// SPDX-License-Identifier: MIT
#include <rosin/propagate/termination_modes.hpp>

#include <rosin/propagate/termination_table.hpp>

#include <doctest/doctest.h>

namespace propagate_termination_modes {

namespace {

constexpr double Z = 0.175;
const rosin::modal_termination body{
    {{280, 25, Z / 0.25}, {460, 35, Z / 0.12}, {900, 30, Z / 0.1}, {2400, 8, Z / 0.03}, {3800, 25, Z / 0.2}}};

std::vector<rosin::measured_admittance> table_of(const rosin::modal_termination& end, double to_Hz, double step_Hz) {
  std::vector<rosin::measured_admittance> table;
  for (double f = step_Hz; f <= to_Hz; f += step_Hz) table.push_back({f, end.relative_admittance(f) / Z});
  return table;
}

/// Off between the measuring points too, by an rms over frequencies.
double off(const rosin::modal_termination& found, const auto& wanted, double from_Hz, double to_Hz) {
  double differs = 0, all = 0;
  for (double f = from_Hz; f < to_Hz; f *= 1.013) {
    const auto z = wanted.relative_admittance(f);
    differs += std::norm(found.relative_admittance(f) - z), all += std::norm(z);
  }
  return std::sqrt(differs / all);
}

}  // namespace

TEST_CASE("modes stay what they are, and what is rigid needs none") {
  const auto same = rosin::as_modes(body);
  REQUIRE(same);
  CHECK(same->end.modes.size() == body.modes.size());
  const auto rigid = rosin::as_modes(rosin::rigid_termination{});
  REQUIRE(rigid);
  CHECK(rigid->end.modes.empty());
}

TEST_CASE("of a table made from modes come these modes, and few besides") {
  const auto table = rosin::complete_admittance(table_of(body, 12e3, 2), Z);
  REQUIRE(table);
  const auto found = rosin::as_modes(*table, {.from_Hz = 50, .to_Hz = 8e3, .tolerance = 3e-3});
  REQUIRE(found);
  MESSAGE(found->end.modes.size(), " modes, mismatch ", found->mismatch, ", off ", off(found->end, *table, 60, 7e3),
          ", from the modes ", off(found->end, body, 60, 7e3));
  CHECK(found->mismatch < 0.01);
  CHECK(found->end.modes.size() < 30);
  CHECK(off(found->end, *table, 60, 7e3) < 0.01);
  CHECK(off(found->end, body, 60, 7e3) < 0.015);
}

TEST_CASE("a dashpot, a delayed echo and what no mode is") {
  const auto damper = rosin::reflecting_end({-0.8}, 48e3);
  REQUIRE(damper);
  const auto slow = rosin::as_modes(*damper, {.tolerance = 1e-2});
  REQUIRE(slow);
  MESSAGE("dashpot: ", slow->end.modes.size(), " modes, mismatch ", slow->mismatch);
  CHECK(off(slow->end, *damper, 100, 15e3) < 0.02);
  std::vector<double> soft;  // -1 at 0 Hz, less above: a spring and a dashpot
  for (int n = 0; n < 40; ++n) soft.push_back(-0.3 * std::pow(0.7, n));
  const auto spring = rosin::reflecting_end(soft, 96e3);
  REQUIRE(spring);
  const auto sprung = rosin::as_modes(*spring, {.tolerance = 5e-3});
  REQUIRE(sprung);
  MESSAGE("spring and dashpot: ", sprung->end.modes.size(), " modes, mismatch ", sprung->mismatch);
  CHECK(sprung->mismatch < 0.02);
}

TEST_CASE("what few modes cannot be is refused") {
  const auto table = rosin::complete_admittance(table_of(body, 12e3, 5), Z);
  REQUIRE(table);
  const auto refused = rosin::as_modes(*table, {.modes = 1});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().find("modes come no nearer") != std::string::npos);
}

}  // namespace propagate_termination_modes
