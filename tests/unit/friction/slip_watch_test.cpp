// SPDX-License-Identifier: MIT
#include <rosin/friction/slip_watch.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

namespace friction_slip_watch {

using rosin::contact_state;

TEST_CASE("a Helmholtz motion with ripple: one slip a period, for both ways of the rod") {
  for (const double rod : {0.2, -0.2}) {
    rosin::slip_watch<double> watch{rod};
    int slipping = 0;
    for (int n = 0; n < 10000; ++n) {
      const bool slips = n % 100 >= 70;  // 30 of 100 samples back, at -7/3 of the rod's speed
      const double ripple = 0.15 * rod * std::sin(0.9 * n);
      if (watch((slips ? -7.0 / 3 * rod : rod) + ripple) == contact_state::slipping) ++slipping;
    }
    CHECK(watch.slips() == 100);
    CHECK(slipping == 3000);
  }
}

TEST_CASE("what lies between the thresholds keeps the state; nothing is said without a number or a speed") {
  rosin::slip_watch<float> watch{0.2F, 0.4F};
  CHECK(watch.state() == contact_state::unknown);
  CHECK(watch(0.2F) == contact_state::sticking);
  CHECK(watch(0.14F) == contact_state::sticking);
  CHECK(watch(0.1F) == contact_state::slipping);
  CHECK(watch(0.14F) == contact_state::slipping);
  CHECK(watch(0.17F) == contact_state::sticking);
  CHECK(watch(NAN) == contact_state::unknown);
  CHECK(watch(-0.3F) == contact_state::slipping);
  CHECK(watch.slips() == 1);
  rosin::slip_watch<float> still{0.0F};
  CHECK(still(1.0F) == contact_state::unknown);
}

}  // namespace friction_slip_watch
