// SPDX-License-Identifier: MIT
// Carried along by a string that oscillates: the force is then known for all time.
#include <rosin/simulate/moving_load.hpp>

#include <doctest/doctest.h>

#include <cmath>

#include "support/approx.hpp"

namespace simulate_moving_load {

TEST_CASE("a lump that is carried along takes M v' + R v + K y, to second order in the step") {
  const rosin::point_load load{0.3, 2e-5, 0.004, 150};
  const double w = 2 * 3.14159265358979323846 * 440, speed = 0.7;
  const auto worst = [&](double h) {
    rosin::moving_load m{load, speed, speed * std::cos(w * h), 0};  // v = speed cos(w t)
    double miss = 0;
    for (int n = 1; n * h < 0.01; ++n) {
      const double t = n * h, now = speed * std::cos(w * t);
      const double on_string = -m.alpha(h) * now - m.beta(h);
      const double due = -load.mass_kg * w * speed * std::sin(w * t) + load.resistance_Ns_m * now +
                         load.stiffness_N_m * speed / w * std::sin(w * t);
      miss = std::max(miss, std::abs(on_string + due));
      m.move(h, now);
    }
    return miss;
  };
  const double full = load.mass_kg * w * speed;
  CHECK(worst(1e-6) < 1e-5 * full);
  CHECK(worst(4e-6) / worst(2e-6) == test::approx(4).epsilon(0.02));
}

}  // namespace simulate_moving_load
