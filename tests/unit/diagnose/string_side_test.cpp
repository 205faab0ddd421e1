// SPDX-License-Identifier: MIT
#include <rosin/diagnose/string_side.hpp>

#include <doctest/doctest.h>

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

TEST_CASE("behind a load velocity is continuous and force jumps by what the load takes, from piece to piece as of transmission matrices") {
  const auto s = ideal_waves(2300);
  const rosin::scatterer bead{.position = 0.2, .mass_s = 3e-5}, finger{.position = 0.4, .resistance = 0.3};
  rosin::string_side side{{{2e-4, bead}, {4e-4, finger}}, {}};
  side.end.modes = {{2500, 12, 40}};
  // (Z v, f) carried piece by piece from the end: v = Z Y F, f = F.
  complex v = side.end.admittance({0, s.omega}), f = 1;
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

TEST_CASE("loads belong to the side of the contact that they are on, in order from its end") {
  rosin::pluck_scene scene;
  scene.scatterers = {{.position = 0.9}, {.position = 0.1}, {.position = 0.6}, {.position = 0.2}};
  scene.ends[0].conductance = 0.01;
  const auto sides = rosin::sides_of(scene, {3e-4, 7e-4});
  REQUIRE(sides[0].loads.size() == 2);
  REQUIRE(sides[1].loads.size() == 2);
  CHECK(sides[0].loads[0].first == doctest::Approx(1e-4));
  CHECK(sides[0].loads[1].first == doctest::Approx(2e-4));
  CHECK(sides[1].loads[0].first == doctest::Approx(1e-4));
  CHECK(sides[1].loads[1].first == doctest::Approx(4e-4));
  CHECK_FALSE(sides[0].end.rigid());
  CHECK(sides[1].end.rigid());
}
