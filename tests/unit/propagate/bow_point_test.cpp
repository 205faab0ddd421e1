// SPDX-License-Identifier: MIT
#include <rosin/propagate/bow_point.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace propagate_bow_point {

TEST_CASE("a contact's travel times add up to half a period, in the ratio of the lengths") {
  const rosin::string_parameters s{0.33, 70, 640, 5e-5, {900, 0, 0}};
  const rosin::bow_point at = rosin::contact_at(s, 0.27);
  CHECK(at.delay_s[0] + at.delay_s[1] == test::approx(0.5 / 640));
  CHECK(at.delay_s[0] * s.wave_speed_m_s() == test::approx(0.27 * 0.33));
  CHECK(at.impedance_Ns_m == s.impedance_Ns_m());
  CHECK(at.stiffness_s2 == s.stiffness_s2());
  CHECK(at.loss.quality == 900);
}

}  // namespace propagate_bow_point
