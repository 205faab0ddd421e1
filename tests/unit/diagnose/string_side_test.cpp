// SPDX-License-Identifier: MIT
#include <rosin/diagnose/string_side.hpp>

#include <rosin/diagnose/loaded_motion.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

using complex = std::complex<double>;

rosin::detail::side_waves ideal_waves(double f_Hz) { return rosin::detail::waves_at(f_Hz, 0, {2, 2 * std::numbers::pi * f_Hz}); }

}  // namespace

TEST_CASE("a plain side is sinh and cosh") {
  const auto s = ideal_waves(1700);
  const auto here = rosin::string_side{}.at(3e-4, s);
  CHECK(std::abs(here.velocity - std::sinh(s.gamma * 3e-4)) < 1e-12);
  CHECK(std::abs(here.force - std::cosh(s.gamma * 3e-4)) < 1e-12);
}

TEST_CASE(
    "behind a load velocity is continuous and force jumps by what the load takes, from piece to piece as of transmission "
    "matrices") {
  const auto s = ideal_waves(2300);
  const rosin::scatterer bead{.position = 0.2, .mass_s = 3e-5}, finger{.position = 0.4, .resistance = 0.3};
  rosin::string_side side{{{2e-4, bead}, {4e-4, finger}}, {}};
  side.end_modes = {{2500, 12, 40}};
  // (Z v, f) carried piece by piece from the end: v = Z Y F, f = F.
  complex v = side.end_modes[0]({0, s.omega}), f = 1;
  double at = 0;
  const auto carry = [&](double to) {
    const complex c = std::cosh(s.gamma * (to - at)), h = std::sinh(s.gamma * (to - at)), w = v * c + f * h;
    f = v * h + f * c, v = w, at = to;
  };
  for (const auto& [place, load] : side.loads) {
    carry(place);
    const auto before = side.at(place * (1 - 1e-9), s), after = side.at(place * (1 + 1e-9), s);
    CHECK(std::abs(before.velocity - v) < 1e-6);
    CHECK(std::abs(before.force - f) < 1e-6);
    f += load.impedance({0, s.omega}) * v;
    CHECK(std::abs(after.velocity - v) < 1e-6);
    CHECK(std::abs(after.force - f) < 1e-6);
  }
  carry(7e-4);
  CHECK(std::abs(side.at(7e-4, s).velocity - v) < 1e-9);
  CHECK(std::abs(side.at(7e-4, s).force - f) < 1e-9);
}

TEST_CASE("on a stiff string velocity and force belong to one wave, and are what a point between both ends would be told") {
  constexpr double f_Hz = 30e3, eps = 4e-12, to_near_s = 3e-4, to_far_s = 5e-4;
  const rosin::bow_point point{{to_near_s, to_far_s}, eps, {800, 0, 0}, 0.2};
  const auto s = rosin::detail::waves_at(f_Hz, eps, rosin::propagation_rate(f_Hz, eps, point.loss));
  REQUIRE(s.force_factor > 1.05);
  rosin::string_side side{{{1e-4, {.mass_s = 2e-6}}}, {{2500, 12, 4e4}}};
  constexpr double h = 1e-9;
  const auto slope = (side.at(to_near_s + h, s).velocity - side.at(to_near_s - h, s).velocity) / (2 * h);
  CHECK(std::abs(slope / s.gamma - side.at(to_near_s, s).force) < 1e-6);
  // The same side in the reconstruction's own terms: ends that move in one, loads as echoes in the other.
  const complex moved = side.end_modes[0]({0, s.omega});
  const rosin::bow_point_transfer<rosin::with_moving_ends<rosin::full_physics>> transfer(point, {40e3, 50e3}, 128e3);
  const auto h_of = transfer(f_Hz);
  const auto echo = rosin::detail::echo_of_loads(side.loads, to_near_s, point, f_Hz, 1, moved);
  const complex force = 0.5 * (h_of[0] + h_of[4]) + 0.5 * (h_of[2] + h_of[6]) * moved + 0.5 * (echo.own_force + echo.other_force);
  CHECK(std::abs(s.force_factor * side.at(to_near_s, s).force - force) < 1e-6 * std::abs(force));
}

TEST_CASE("loads belong to the side of the contact that they are on, in order from its end") {
  rosin::pluck_scene scene;
  scene.scatterers = {{.position = 0.9}, {.position = 0.1}, {.position = 0.6}, {.position = 0.2}};
  scene.ends[0].modes = {{900, 20, 3}};
  const auto sides = rosin::sides_of(scene, {3e-4, 7e-4});
  REQUIRE(sides[0].loads.size() == 2);
  REQUIRE(sides[1].loads.size() == 2);
  CHECK(sides[0].loads[0].first == test::approx(1e-4));
  CHECK(sides[0].loads[1].first == test::approx(2e-4));
  CHECK(sides[1].loads[0].first == test::approx(1e-4));
  CHECK(sides[1].loads[1].first == test::approx(4e-4));
  CHECK(sides[0].end_modes.size() == 1);
  CHECK(sides[1].end_modes.empty());
}
