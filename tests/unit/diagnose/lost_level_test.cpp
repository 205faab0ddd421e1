// SPDX-License-Identifier: MIT
#include <rosin/diagnose/lost_level.hpp>

#include <doctest/doctest.h>

#include "slips_by_hand.hpp"
#include "support/approx.hpp"

namespace {

/// Friction by the contact's temperature, with all its memory.
struct lasting_heat {
  rosin::contact_heat<double> contact{{.layer_m = 3e-6, .area_per_newton_m2 = 1e-7}};
  double operator()(double v, double normal_N) {
    const double mu = 0.3 + 0.7 * std::exp(-contact.temperature_rise_K() / 25);
    contact(v * normal_N * mu, v, normal_N, 1 / rosin_test::slip_rate_Hz);
    return mu;
  }
};

/// A little noise, and the mean of the force taken away: returned.
double spoil(rosin::slip_record& r) {
  double mean = 0;
  for (std::size_t i = 0; i < r.force_N.size(); ++i) {
    r.force_N[i] += 1e-3 * r.normal_N * std::sin(1.3 * static_cast<double>(i * i % 977));
    mean += r.force_N[i] / static_cast<double>(r.force_N.size());
  }
  for (double& f : r.force_N) f -= mean;
  rosin_test::find_slips(r);
  return mean;
}

/// `lost` is what the means were, in newtons.
std::vector<rosin::slip_record> without_their_mean(bool thermal, std::vector<double>& lost) {
  std::vector<rosin::slip_record> records;
  for (const double strength : {1.0, 1.4}) {
    records.push_back(thermal ? rosin_test::slips_by_hand(strength, 7000, 0.5, lasting_heat{})
                              : rosin_test::slips_by_hand(strength, 7000, 0.5, rosin_test::curve_by_hand{}));
    lost.push_back(spoil(records.back()));
  }
  return records;
}

}  // namespace

TEST_CASE("lost level: heat knows where zero is" * doctest::test_suite("long")) {
  std::vector<double> lost;
  const auto found = rosin::find_lost_levels(without_their_mean(true, lost));
  CHECK(found.law == rosin::contact_law::thermal);
  REQUIRE(found.takes.size() == 2);
  for (std::size_t t = 0; t < 2; ++t) {
    CHECK(std::abs(found.takes[t].level_N - lost[t]) < 3 * found.takes[t].sd_N);
    CHECK(found.takes[t].sd_N < 0.08 * 0.3 * 1.4);
  }
}

TEST_CASE("lost level: one stroke alone knows it less well") {
  std::vector<double> lost;
  auto records = without_their_mean(true, lost);
  records.resize(1);
  const auto found = rosin::find_lost_levels(records);
  CHECK(found.common_sd >= 0.1);
  CHECK(std::abs(found.takes[0].level_N - lost[0]) < 3 * found.takes[0].sd_N);
}

TEST_CASE("lost level: a velocity curve tells the levels against each other, no more") {
  std::vector<double> lost;
  const auto records = without_their_mean(false, lost);
  const auto found = rosin::find_lost_levels(records);
  CHECK(found.law == rosin::contact_law::velocity_curve);
  CHECK(found.common_sd == test::approx(0.15));
  REQUIRE(found.takes.size() == 2);
  const auto error = [&](std::size_t t) { return (found.takes[t].level_N - lost[t]) / records[t].normal_N; };
  CHECK(std::abs(error(0) - error(1)) < 0.01);
  CHECK(std::abs(error(0)) < 0.3);
  CHECK(found.takes[0].sd_N == test::approx(0.15 * records[0].normal_N));
}

TEST_CASE("lost level: a stroke the other way has its level the other way") {
  std::vector<double> lost;
  auto records = without_their_mean(false, lost);
  for (auto& r : records)
    for (auto* values : {&r.force_N, &r.relative_m_s})
      for (double& x : *values) x = -x;
  const auto found = rosin::find_lost_levels(records);
  CHECK(found.takes[0].level_N < 0);
}
