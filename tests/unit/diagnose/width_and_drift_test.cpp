// SPDX-License-Identifier: MIT
#include <rosin/diagnose/width_and_drift.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

namespace {

/// Strokes of a rod that touches the string over 3 mm, calibrated at another tension than theirs.
struct drifted_strokes {
  static constexpr double width_m = 3e-3;
  contact_rigs::stroke a, b;
  std::vector<rosin::contact_take> takes;

  explicit drifted_strokes(double drift)
      : a{contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 81, 0.27, 0.1, 0.3e-3, width_m)},
        b{contact_rigs::play(contact_rigs::curve(), contact_rigs::fast(), contact_rigs::rolls, 83, 0.27, 0.1, 0.3e-3, width_m)} {
    for (const auto* s : {&a, &b}) takes.push_back(rosin::at_tension(s->take(), 1 / (1 + drift) - 1));
  }
  static rosin::torsion_values declared(double drift) {
    return rosin::at_tension(*contact_rigs::declared().torsion, 1 / (1 + drift) - 1);
  }
};

}  // namespace

TEST_CASE("width and drift: a tension and back again is where it was") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 81);
  const auto there = rosin::at_tension(a.take(), 0.02), back = rosin::at_tension(there, 1 / 1.02 - 1);
  CHECK(there.delay_s[0] == test::approx(a.take().delay_s[0] / std::sqrt(1.02)));
  CHECK(there.impedance_Ns_m == test::approx(a.take().impedance_Ns_m * std::sqrt(1.02)));
  CHECK(there.stiffness_s2 == test::approx(a.take().stiffness_s2 / 1.02 / 1.02));
  CHECK(back.delay_s[1] == test::approx(a.take().delay_s[1]));
  const rosin::torsion_values torsion{7, 3.5, 15};
  const double z = there.impedance_Ns_m * rosin::at_tension(torsion, 0.02).impedance_ratio;
  CHECK(z == test::approx(a.take().impedance_Ns_m * 3.5));  // in Ns m it stays
}

TEST_CASE("width and drift: both are found at once" * doctest::test_suite("long")) {
  for (const double drift : {-0.01, 0.006}) {
    const drifted_strokes strokes(drift);
    const auto found = rosin::find_width_and_drift(strokes.takes, drifted_strokes::declared(drift));
    REQUIRE(found);
    CHECK(std::abs(found->relative - drift) < 2e-3);  // along a valley: a wider contact at less tension does nearly as well
    CHECK(found->sd < 5e-4);
    CHECK(found->gain > 1000);
    const double c = 2 * contact_rigs::e_string.length_m * contact_rigs::e_string.fundamental_Hz;
    CHECK(2 * found->half_delay_s * c == test::approx(drifted_strokes::width_m).epsilon(0.15));
  }
}

TEST_CASE("width and drift: nothing without the forces on the terminations, the speed of the rod, room for a width, or strokes") {
  const drifted_strokes strokes(0);
  auto bare = strokes.takes;
  bare[1].far_N = {};
  CHECK_FALSE(rosin::find_width_and_drift(bare, drifted_strokes::declared(0)));
  auto still = strokes.takes, at_end = strokes.takes;
  still[0].rod_speed_m_s = 0, at_end[1].delay_s[0] = 1e-6;
  CHECK_FALSE(rosin::find_width_and_drift(still, drifted_strokes::declared(0)));
  CHECK_FALSE(rosin::find_width_and_drift(at_end, drifted_strokes::declared(0)));
  CHECK_FALSE(rosin::find_width_and_drift({}, drifted_strokes::declared(0)));
}
