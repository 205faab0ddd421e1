// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_effects.hpp>

#include <doctest/doctest.h>

#include "pickup_tables.hpp"
#include "support/approx.hpp"

using namespace rosin;

namespace {

void check_found(const char* name, const pickup_law& truth, double pickup_law::*what, double tolerance) {
  const auto table = rosin_test::table_from(truth, 16, 0, 0, 3);
  const fitted_law base = fit_law(table, ideal_string(200), {.fundamental_Hz = 200, .inverse_q = 1e-3});
  double best = -1e300;
  std::string likeliest;
  for (const auto& e : law_effects(200, 16)) {
    const fitted_law f = with_effect(table, base, e);
    if (evidence_of(f, 16) > best) best = evidence_of(f, 16), likeliest = e.name;
    if (e.name == name) CHECK(f.law.*what == test::approx(truth.*what).epsilon(tolerance));
  }
  CHECK(likeliest == name);
  CHECK(best > evidence_of(base, 16) + 20);
}

}  // namespace

TEST_CASE("with_effect: each effect of the law is found from nothing, and is the likeliest") {
  const pickup_law plain{.fundamental_Hz = 200, .inverse_q = 1e-3};
  pickup_law l = plain;
  l.inharmonicity = 2e-5;
  check_found("bending-stiffness", l, &pickup_law::inharmonicity, 0.02);
  l = plain, l.internal_s = 3e-7;
  check_found("frequency-dependent-loss", l, &pickup_law::internal_s, 0.02);
  l = plain, l.bead_position = 0.31, l.bead_mass = 0.004;
  check_found("point-mass", l, &pickup_law::bead_position, 0.01);
  l = plain, l.finger_position = 0.17, l.finger_resistance = 0.003;
  check_found("point-damper", l, &pickup_law::finger_position, 0.01);
  l = plain, l.support_Hz = 1130, l.support_q = 12, l.support_lightness = 0.1;
  check_found("support-resonance", l, &pickup_law::support_Hz, 0.01);
}
