// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_diagnosis.hpp>

#include <doctest/doctest.h>

#include "pickup_plucks.hpp"
#include "support/approx.hpp"

using namespace rosin;

namespace {

pickup_diagnosis diagnosed(const pickup_signal& fitted, const pickup_signal& held, double pitch_Hz = 220) {
  auto d = diagnose_pickups({fitted}, {held}, {pitch_Hz, {}, {}, 0.8});
  REQUIRE(d);
  return *std::move(d);
}

pickup_diagnosis diagnosed(rosin_test::heard_string s, double force_N = 0.3) {
  s.limit_Hz = 4000;
  return diagnosed(s.pluck("one", 0.13, force_N, 1), s.pluck("two", 0.22, 1.3 * force_N, 2));
}

void check_named(const pickup_diagnosis& d, const char* effect, std::size_t which, double truth, double tolerance) {
  REQUIRE(d.missing.size() == 1);
  CHECK(d.missing[0].effect == effect);
  CHECK(d.missing[0].values[which].value == test::approx(truth).epsilon(tolerance));
  CHECK(d.explained);
  CHECK(d.after < 0.5 * d.before);
}

}  // namespace

TEST_CASE("diagnose_pickups: no mismatch where nothing is concealed" * doctest::test_suite("long")) {
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
  CHECK(16 * std::pow(s.tension_N, 3) * glide.glide_per_power == test::approx(4000).epsilon(0.07));
}

TEST_CASE("diagnose_pickups: an effect that the catalogue is not to know ends unexplained" * doctest::test_suite("long")) {
  rosin_test::heard_string s;
  s.inharmonicity = 1e-4, s.limit_Hz = 4000;
  const std::vector<pickup_signal> fitted{s.pluck("one", 0.13, 0.3, 1)}, held{s.pluck("two", 0.22, 0.3, 2)};
  const pickup_question ask{220, {}, {"bending-stiffness"}, 0.8};
  const auto d = diagnose_pickups(fitted, held, ask);
  REQUIRE(d);
  CHECK(d->mismatched);
  CHECK_FALSE(d->explained);
}

TEST_CASE("diagnose_pickups: a hum close to a partial does not bend it" * doctest::test_suite("long")) {
  rosin_test::heard_string s;
  s.fundamental_Hz = 212, s.limit_Hz = 4000, s.noise = 3e-4;
  const auto humming = [&](pickup_signal p, double phase) {
    for (std::size_t i = 0; i < p.values.size(); ++i)
      for (const int h : {1, 2, 4})
        p.values[i] += 0.004 / h * std::sin(h * 314.159265358979 * static_cast<double>(i) / s.rate_Hz + phase);
    return p;
  };
  const auto d = diagnosed(humming(s.pluck("one", 0.13, 0.3, 1), 1), humming(s.pluck("two", 0.22, 0.4, 2), 2), 212);
  REQUIRE(d.missing.size() == 1);
  CHECK(d.missing[0].effect == "mains-hum");
  CHECK(d.strays.hum.size() == 3);
  CHECK(d.explained);
  CHECK(d.after < 1.3 * d.floor);
  const auto* first = d.table.find(1);
  REQUIRE(first != nullptr);
  CHECK(first->decay_per_s == test::approx(3.14159265358979 * 212 / s.quality).epsilon(0.01));
}

TEST_CASE("diagnose_pickups: partials that a bead has moved far off are found where it foretells them" *
          doctest::test_suite("long")) {
  rosin_test::heard_string s;
  s.limit_Hz = 60000, s.steps_per_sample = 8;
  s.burden.loads.push_back({0.433, 0.017 * s.mass_kg(), 0});
  const auto d = diagnosed(s.pluck("one", 0.13, 0.3, 1), s.pluck("two", 0.22, 0.4, 2));
  check_named(d, "point-mass", 1, 0.017, 0.002);
  CHECK(d.after < 2 * d.floor);
  for (int n = 1; n <= 12; ++n) CHECK(d.table.find(n) != nullptr);
}

TEST_CASE("diagnose_pickups: what is heard above the highest partial that is followed is no mismatch" *
          doctest::test_suite("long")) {
  rosin_test::heard_string s;
  s.fundamental_Hz = 60, s.limit_Hz = 7000, s.quality = 2500, s.noise = 3e-4;
  const auto d = diagnosed(s.pluck("one", 0.13, 0.3, 1), s.pluck("two", 0.22, 0.4, 2), 60);
  CHECK(d.table.lines.back().number <= 64);
  CHECK(d.missing.empty());
  CHECK_FALSE(d.mismatched);
}
