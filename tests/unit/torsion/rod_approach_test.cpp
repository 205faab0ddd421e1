// SPDX-License-Identifier: MIT
#include <rosin/torsion/rod_approach.hpp>

#include "support/approx.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <random>

namespace torsion_rod_approach {

namespace {

constexpr double rate_Hz = 100e3, period_s = 5e-3, rod_m_s = -0.2;

/// Slips for 15 % of each period, at first of more; the rod's speed as a function of time, torsion and noise while it sticks.
template <class Speed>
std::vector<double> stroke(Speed&& speed, double duration_s = 0.35) {
  std::mt19937 source(5);
  std::normal_distribution<double> normal;
  std::vector<double> v(static_cast<std::size_t>(duration_s * rate_Hz));
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double t = static_cast<double>(i) / rate_Hz, phase = std::fmod(t / period_s, 1.0);
    const bool slips = phase < 0.15 || (t < 0.05 && phase > 0.6);
    v[i] = slips ? -5 * rod_m_s : speed(t) + 0.03 * std::sin(2 * 3.14159265 * 1730 * t) + 0.002 * normal(source);
  }
  for (std::size_t i = 0; i < 300; ++i) v[i] = v[v.size() - 1 - i] = std::numeric_limits<double>::quiet_NaN();
  return v;
}

rosin::rod_approach found_in(const std::vector<double>& v) {
  return rosin::find_rod_approach(v, rate_Hz, period_s, rod_m_s, 0.03);
}

}  // namespace

TEST_CASE("rod's approach: how much of the speed is missing when, and until when too much is, though the declared speed is off") {
  for (const double time_s : {0.02, 0.07}) {
    CAPTURE(time_s);
    const auto v = stroke([&](double t) { return 1.02 * rod_m_s * (1 - std::exp(-(t - 0.005) / time_s)); });
    const auto found = found_in(v);
    REQUIRE(found.seen());
    CHECK(found.time_s == test::approx(time_s).epsilon(0.2));
    for (const double t : {0.04, 0.06, 0.1})
      CHECK(std::abs(found.lag(t) - std::exp(-(t - 0.005) / time_s)) < 0.025);  // columns take up the rest
    CHECK(found.lag(found.within_s(0.1)) == test::approx(0.1).epsilon(1e-9));
    CHECK(found.from(0.05).lag(0.02) == test::approx(found.lag(0.07)).epsilon(1e-9));
  }
}

TEST_CASE(
    "rod's approach: a rod that is as fast as it will be approaches nothing, nor does a ripple or a record too short to tell") {
  CHECK_FALSE(found_in(stroke([](double) { return rod_m_s; })).seen());
  CHECK_FALSE(found_in(stroke([](double t) { return t < 0.03 ? rod_m_s * t / 0.03 : rod_m_s; })).seen());
  CHECK_FALSE(found_in(stroke([](double t) { return rod_m_s * (1 + 0.01 * std::sin(2 * 3.14159265 * 31 * t)); })).seen());
  CHECK_FALSE(found_in(stroke([](double t) { return rod_m_s * (1 - std::exp(-t / 0.07)); }, 0.08)).seen());
  CHECK(rosin::rod_approach{}.lag(1) == 0);
  CHECK(rosin::rod_approach{}.within_s(0.1) == 0);
}

}  // namespace torsion_rod_approach
