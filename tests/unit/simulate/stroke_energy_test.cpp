// SPDX-License-Identifier: MIT
#include <rosin/simulate/stroke_energy.hpp>

#include <doctest/doctest.h>

#include <cmath>

#include "support/approx.hpp"

namespace simulate_stroke_energy {

TEST_CASE("what is not found again is told as a part of what was given") {
  rosin::stroke_energy e{.rod_J = 10, .friction_J = 6, .transverse = {3, 1, 1.7}, .torsion = {1, 0.2, 0.8}, .left_out_J = 0.1};
  CHECK(e.string_error() == test::approx(0.3 / 4));
  CHECK(e.error() == test::approx(0.2 / 10));
  e.transverse.lost_J = 2;
  CHECK(std::abs(e.string_error()) < 1e-15);
  CHECK(rosin::stroke_energy{}.error() == 0.0);
  CHECK(rosin::stroke_energy{}.string_error() == 0.0);
}

}  // namespace simulate_stroke_energy
