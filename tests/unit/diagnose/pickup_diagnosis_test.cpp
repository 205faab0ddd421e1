// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_diagnosis.hpp>

#include <doctest/doctest.h>

#include "pickup_plucks.hpp"

using namespace rosin;

namespace {

pickup_diagnosis diagnosed(rosin_test::heard_string s, double force_N = 0.3) {
  s.limit_Hz = 4000;
  const std::vector<pickup_signal> fitted{s.pluck("one", 0.13, force_N, 1)}, held{s.pluck("two", 0.22, 1.3 * force_N, 2)};
  const pickup_question ask{220, {}, {}, 0.8};
  auto d = diagnose_pickups(fitted, held, ask);
  REQUIRE(d);
  return *std::move(d);
}

void check_named(const pickup_diagnosis& d, const char* effect, std::size_t which, double truth, double tolerance) {
  REQUIRE(d.missing.size() == 1);
  CHECK(d.missing[0].effect == effect);
  CHECK(d.missing[0].values[which].value == doctest::Approx(truth).epsilon(tolerance));
  CHECK(d.explained);
  CHECK(d.after < 0.5 * d.before);
}

}  // namespace

TEST_CASE("diagnose_pickups: no mismatch where nothing is concealed") {
  const auto d = diagnosed({});
  CHECK(d.missing.empty());
  CHECK_FALSE(d.mismatched);
  CHECK(d.before < 1.2 * d.floor);
}

TEST_CASE("diagnose_pickups: what is concealed is named, alone, from one pluck, and foretells another" *
          doctest::test_suite("long")) {
  rosin_test::heard_string s;
  s.inharmonicity = 1e-4;
  check_named(diagnosed(s), "bending-stiffness", 0, 1e-4, 0.01);
  s = {}, s.internal_s = 4e-7;
  check_named(diagnosed(s), "frequency-dependent-loss", 0, 4e-7, 0.02);
  s = {}, s.detuning = 0.002, s.coupling = 0.3;
  check_named(diagnosed(s), "second-polarization", 0, 0.002, 0.01);
  s = {}, s.burden.axial_stiffness_N = 4000;
  const auto glide = diagnosed(s, 2);
  REQUIRE(glide.missing.size() == 1);
  CHECK(glide.missing[0].effect == "tension-modulation");
  CHECK(16 * std::pow(s.tension_N, 3) * glide.glide_per_power == doctest::Approx(4000).epsilon(0.07));
}

TEST_CASE("diagnose_pickups: an effect that the catalogue is not to know ends unexplained") {
  rosin_test::heard_string s;
  s.inharmonicity = 1e-4, s.limit_Hz = 4000;
  const std::vector<pickup_signal> fitted{s.pluck("one", 0.13, 0.3, 1)}, held{s.pluck("two", 0.22, 0.3, 2)};
  const pickup_question ask{220, {}, {"bending-stiffness"}, 0.8};
  const auto d = diagnose_pickups(fitted, held, ask);
  REQUIRE(d);
  CHECK(d->mismatched);
  CHECK_FALSE(d->explained);
}
