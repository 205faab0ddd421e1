// SPDX-License-Identifier: MIT
#include <rosin/simulate/regime.hpp>

#include <doctest/doctest.h>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/profiled_rod.hpp>
#include <rosin/simulate/wave_stroke.hpp>

#include "support/approx.hpp"

namespace simulate_regime {

namespace {

constexpr double rate = 48000, f0 = 480;  // 100 samples a period

/// Slips of 12 samples at these times (in periods), 60 periods in all.
rosin::regime_finding with_slips_at(const std::vector<double>& onsets) {
  std::vector<double> slip(6000, 0.001), rod(6000, 0.2);
  for (const double t : onsets)
    for (std::size_t n = 0; n < 12; ++n) slip.at(static_cast<std::size_t>(100 * t) + n) = -0.8;
  return rosin::classify(slip, rod, rate, f0);
}

std::vector<double> every(double periods, double from) {
  std::vector<double> onsets;
  for (double t = from; t < 59.8; t += periods) onsets.push_back(t);
  return onsets;
}

}  // namespace

TEST_CASE("drawn patterns get their names and transients") {
  const auto helmholtz = with_slips_at(every(1, 7.25));
  CHECK(helmholtz.regime == rosin::bowed_regime::helmholtz);
  CHECK(helmholtz.transient_periods == test::approx(7.25).epsilon(0.01));
  CHECK(helmholtz.slips_per_period == test::approx(1).epsilon(0.1));

  auto twice = every(1, 10);
  for (const double t : every(1, 10.37)) twice.push_back(t);
  std::sort(twice.begin(), twice.end());
  const auto multiple = with_slips_at(twice);
  CHECK(multiple.regime == rosin::bowed_regime::multiple_slip);
  CHECK(multiple.transient_periods == test::approx(10).epsilon(0.05));

  CHECK(with_slips_at(every(3, 4)).regime == rosin::bowed_regime::low_frequency);
  CHECK(with_slips_at({}).regime == rosin::bowed_regime::none);
  CHECK(with_slips_at({3.5}).regime == rosin::bowed_regime::none);
  CHECK(with_slips_at({3.5}).transient_periods == test::approx(3.5));

  std::vector<double> wild;
  for (int i = 0; i < 70; ++i) wild.push_back(1 + 0.8 * i + 0.3 * std::sin(i * i));
  const auto raucous = with_slips_at(wild);
  CHECK(raucous.regime == rosin::bowed_regime::raucous);
  CHECK(raucous.transient_periods == test::approx(60));
}

TEST_CASE("a pattern that breaks off in between begins after the break") {
  auto onsets = every(1, 5);
  onsets.erase(onsets.begin() + 15);  // the one at 20
  CHECK(with_slips_at(onsets).transient_periods == test::approx(21).epsilon(0.01));
  onsets.erase(onsets.end() - 5);
  CHECK(with_slips_at(onsets).regime == rosin::bowed_regime::raucous);
}

TEST_CASE("a rod that stands still makes no slips") {
  const std::vector<double> slip(6000, 0.5), rod(6000, 0.0);
  CHECK(rosin::classify(slip, rod, rate, f0).regime == rosin::bowed_regime::none);
}

TEST_CASE("names") {
  CHECK(name_of(rosin::bowed_regime::helmholtz) == "helmholtz");
  CHECK(name_of(rosin::bowed_regime::raucous) == "raucous");
}

TEST_CASE("a string bowed as a player would settles into Helmholtz motion, and a rod hardly pressed does not") {
  const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                        .tension_N = 72.5,
                                        .fundamental_Hz = 660,
                                        .bending_stiffness_Nm2 = 4.7e-5,
                                        .loss = {.quality = 500}},
                             .torsion = {7, 3.5, 15}};
  const auto bowed = [&](double normal_N) {
    const rosin::profiled_rod rod{{}, {{0, 0}, {0.02, 0.1}}, {{0, normal_N}}};
    const auto take = rosin::simulate_wave_stroke(rig, rosin::velocity_curve{rosin::two_exponential_curve<>{}}, rod, {0.11, 0.12},
                                                  {.sample_rate_Hz = 64000, .oversampling = 4});
    REQUIRE_MESSAGE(take, take.error());
    std::vector<double> slip(take->size());
    for (std::size_t n = 0; n < slip.size(); ++n)
      slip[n] = take->centre_velocity_m_s[n] + take->torsion_velocity_m_s[n] - take->rod_velocity_m_s[n];
    return rosin::classify(slip, take->rod_velocity_m_s, 64000, 660);
  };
  const auto firm = bowed(0.2), faint = bowed(0.02);
  CHECK_MESSAGE(firm.regime == rosin::bowed_regime::helmholtz, name_of(firm.regime));
  CHECK(firm.transient_periods < 60);
  CHECK_MESSAGE(faint.regime != rosin::bowed_regime::helmholtz, name_of(faint.regime));
}

}  // namespace simulate_regime
