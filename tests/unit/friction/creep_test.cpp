// SPDX-License-Identifier: MIT
#include <rosin/friction/creep.hpp>

#include <cmath>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace friction_creep {

namespace {

rosin::load_line<double> line_for(double sticking) { return {0.0, 2.0, 2.0 * sticking, 0.3, 1e-6}; }

}  // namespace

TEST_CASE("in place of sticking it creeps, exponentially in the force") {
  const rosin::two_exponential_curve<> curve;
  rosin::creep law{curve, {.limit_speed_m_s = 5e-3, .sharpness = 0.05}};
  for (const double sticking : {1e-6, 0.1, 0.25, 0.34, 0.358, -0.1, -0.3, -0.355}) {
    const auto line = line_for(sticking);
    const auto contact = law(line);
    CAPTURE(sticking);
    CHECK(contact.converged);
    CHECK(!contact.slipping);
    const double expected = 5e-3 * std::exp((std::abs(contact.force_N) / 0.3 - 1.2) / 0.05);
    CHECK(std::abs(line.slip(contact.force_N)) == test::approx(std::min(expected, 2 * std::abs(sticking))).epsilon(1e-6));
    CHECK(contact.force_N * line.slip(contact.force_N) <= 0);
  }
}

TEST_CASE("beyond the limit it slips as the curve says") {
  rosin::creep law{rosin::two_exponential_curve<>{}};
  rosin::velocity_curve plain{rosin::two_exponential_curve<>{}};
  for (const double sticking : {0.37, 0.6, 1.0, 0.5}) {
    const auto contact = law(line_for(sticking));
    CHECK(contact.slipping);
    CHECK(contact.force_N == plain(line_for(sticking)).force_N);
  }
  law.reset();
  CHECK(!law(line_for(0.3)).slipping);
}

TEST_CASE("without load there is no motion") {
  rosin::creep law{rosin::two_exponential_curve<>{}};
  const auto contact = law(line_for(0.0));
  CHECK(contact.force_N == 0.0);
  CHECK(contact.converged);
}

}  // namespace friction_creep
