// SPDX-License-Identifier: MIT
#include <rosin/simulate/point_modes.hpp>

#include <doctest/doctest.h>

#include <rosin/simulate/modal_bank.hpp>

#include <array>

#include "support/approx.hpp"

namespace simulate_point_modes {

TEST_CASE("a point of the string in a bank of modes with all its ports and ends moves just so") {
  const rosin::modal_rig rig{.string = {.length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660}, .torsion = {7, 3.5, 15}};
  for (const double limit_Hz : {5e3, 40e3, 110e3}) {  // one, eight and more modes
    const auto modes = rosin::torsional_modes(rig, limit_Hz);
    const double position = 0.237, h = 1 / 256e3;
    rosin::point_modes point{modes, position, h};
    rosin::modal_bank<1> bank{modes, rosin::damping_convention::viscous, {position}, h};
    CHECK(point.mobility() == test::approx(bank.mobility(0, 0)));
    CHECK(point.compliance() == test::approx(bank.compliance(0)));
    for (int i = 0; i < 400; ++i) {
      const double force = i < 200 ? std::sin(0.01 * i * i) : 0.0;
      point.advance(force);
      bank.advance({force});
      CHECK(std::abs(point.free() - bank.free().velocity[0]) < 1e-13);
    }
  }
}

TEST_CASE("a lasting force brings it to rest, deflected by its compliance; without modes nothing moves") {
  const std::array modes{rosin::string_mode{1, 4000, 0.5, 6e-5, 0}, rosin::string_mode{2, 9000, 0.5, 6e-5, 0}};
  rosin::point_modes point{modes, 0.3, 1e-5};
  double deflection = 0, last = 0;
  for (int i = 0; i < 4000; ++i) {
    const double velocity = point.free() + point.mobility() * 2;
    deflection += (velocity + last) / 2 * 1e-5;
    last = velocity;
    point.advance(2);
  }
  CHECK(std::abs(last) < 1e-9);
  CHECK(deflection == test::approx(2 * point.compliance()).epsilon(2e-3));
  rosin::point_modes none;
  none.advance(1);
  CHECK(none.free() == 0.0);
  CHECK(none.mobility() == 0.0);
}

}  // namespace simulate_point_modes
