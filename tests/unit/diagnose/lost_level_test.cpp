// SPDX-License-Identifier: MIT
#include <rosin/diagnose/lost_level.hpp>

#include <doctest/doctest.h>

namespace {

/// Slips made by hand, the mean of the force taken away; `lost` is what it was, as a coefficient of friction.
std::vector<rosin::slip_record> without_their_mean(bool thermal, std::vector<double>& lost) {
  std::vector<rosin::slip_record> records;
  for (const double strength : {1.0, 1.4}) {
    rosin::slip_record r;
    r.rate_Hz = 128e3, r.normal_N = 0.3 * strength;
    rosin::contact_heat<double> contact({.layer_m = 3e-6, .area_per_newton_m2 = 1e-7});
    double sum = 0;
    for (std::size_t i = 0; i < 7000; ++i) {
      const std::size_t at = i % 250, slip = i / 250;
      const double size = 0.5 + 0.3 * std::sin(1.7 * static_cast<double>(slip)), u = static_cast<double>(at) / 100;
      const double v = at < 100 ? strength * size * std::sin(std::numbers::pi * u) * (1 + 0.4 * std::sin(11 * u)) + 0.05 : 0;
      const double mu = thermal ? 0.3 + 0.7 * std::exp(-contact.temperature_rise_K() / 25) : 0.4 + 0.5 * std::exp(-v / 0.15);
      const double f = v > 0 ? r.normal_N * mu : 0.2 * r.normal_N;
      contact(v * f, v, r.normal_N, 1 / r.rate_Hz);
      r.force_N.push_back(f + 1e-3 * r.normal_N * std::sin(1.3 * static_cast<double>(i * i % 977)));
      r.relative_m_s.push_back(-v);
      sum += r.force_N.back();
    }
    const double mean = sum / static_cast<double>(r.force_N.size());
    for (double& f : r.force_N) f -= mean;
    lost.push_back(mean);
    r.phases = rosin::find_phases(r.relative_m_s, 0.2, {.least = 0.1});
    r.slips = rosin::slips_of(r.force_N, r.relative_m_s, r.phases, 0.2, r.normal_N, 0, 2);
    records.push_back(std::move(r));
  }
  return records;
}

}  // namespace

TEST_CASE("lost level: heat knows where zero is") {
  std::vector<double> lost;
  const auto found = rosin::find_lost_levels(without_their_mean(true, lost));
  CHECK(found.law == rosin::contact_law::thermal);
  REQUIRE(found.takes.size() == 2);
  for (std::size_t t = 0; t < 2; ++t) {
    CHECK(std::abs(found.takes[t].level_N - lost[t]) < 3 * found.takes[t].sd_N);
    CHECK(found.takes[t].sd_N < 0.08 * 0.3 * 1.4);
  }
}

TEST_CASE("lost level: a velocity curve tells the levels against each other, no more") {
  std::vector<double> lost;
  const auto records = without_their_mean(false, lost);
  const auto found = rosin::find_lost_levels(records);
  CHECK(found.law == rosin::contact_law::velocity_curve);
  CHECK(found.common_sd == doctest::Approx(0.15));
  REQUIRE(found.takes.size() == 2);
  const auto error = [&](std::size_t t) { return (found.takes[t].level_N - lost[t]) / records[t].normal_N; };
  CHECK(std::abs(error(0) - error(1)) < 0.01);
  CHECK(std::abs(error(0)) < 0.3);
  CHECK(found.takes[0].sd_N == doctest::Approx(0.15 * records[0].normal_N));
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
