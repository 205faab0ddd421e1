// SPDX-License-Identifier: MIT
#include <rosin/diagnose/hum_effect.hpp>

#include <rosin/diagnose/scene_plucks.hpp>

#include <doctest/doctest.h>

#include <random>

#include "support/approx.hpp"

namespace {

constexpr double hum_rate_Hz = 20000, hum_begin_s = 0.0123;

/// Noise of 5 mN in both channels, and lines at 60 and 180 Hz.
rosin::take_residual humming(double amplitude_N, double mains_Hz = 60) {
  std::mt19937 random{7};
  std::normal_distribution<double> noise{0, 0.005};
  rosin::take_residual rest{{Eigen::VectorXd(2800), Eigen::VectorXd(2800)}, hum_begin_s, hum_rate_Hz, 1, {}};
  for (Eigen::Index i = 0; i < 2800; ++i) {
    const double t = hum_begin_s + static_cast<double>(i) / hum_rate_Hz, turn = 2 * std::numbers::pi * mains_Hz * t;
    const double hum = amplitude_N * (std::cos(turn + 0.7) + 0.3 * std::cos(3 * turn - 1));
    rest.residual[0][i] = hum + noise(random);
    rest.residual[1][i] = -0.5 * hum + noise(random);
  }
  return rest;
}

const rosin::string_facts hummed{311, hum_rate_Hz, 9000, 0.2, 0.6, 3};

}  // namespace

TEST_CASE("hum: what is left over tells where to begin, in that take alone") {
  const auto hum = rosin::hum_effect(hummed, 60);
  const auto starts = hum.seek(humming(0.004));
  REQUIRE(starts.size() == 1);
  const std::vector<double>& s = starts[0];
  REQUIRE(s.size() == hum.parameters.size());
  CHECK(s[0] == 60);
  rosin::pluck_scene here, elsewhere;
  hum.apply(here, s.data(), 1);
  hum.apply(elsewhere, s.data(), 0);
  const auto near = here.hum[0].amplitude_N[0], far = here.hum[0].amplitude_N[1];
  CHECK(std::abs(near - std::polar(0.004, 0.7)) < 6e-4);
  CHECK(std::abs(far + std::polar(0.002, 0.7)) < 6e-4);
  for (const auto& line : elsewhere.hum) CHECK(std::abs(line.amplitude_N[0]) == 0);
  double third = 0;
  for (const auto& line : here.hum)
    if (line.frequency_Hz == 180) third = std::abs(line.amplitude_N[0]);
  CHECK(third == test::approx(0.0012).epsilon(0.4));
}

TEST_CASE("hum: noise is not taken for it, nor another mains' frequency") {
  CHECK(rosin::hum_effect(hummed, 60).seek(humming(0)).empty());
  CHECK(rosin::hum_effect(hummed, 50).seek(humming(0)).empty());
  CHECK(rosin::hum_effect(hummed, 60).seek(humming(0.0015)).size() == 1);
}

TEST_CASE("hum: slow noise is not taken for it; above slow noise it is found") {
  int taken = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 random{seed};
    std::normal_distribution<double> white{0, 0.005};
    rosin::take_residual rest = humming(0);
    for (auto& x : rest.residual) {
      double slow = 0;  // below 300 Hz, of four times the white noise's amplitude there
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        slow += 2 * std::numbers::pi * 300 / hum_rate_Hz * (4 * white(random) - slow);
        x[i] = slow + white(random);
      }
    }
    taken += rosin::hum_effect(hummed, 60).seek(rest).empty() ? 0 : 1;
    const auto hum = humming(0.01);
    for (std::size_t c = 0; c < 2; ++c) rest.residual[c] += hum.residual[c];
    CHECK(rosin::hum_effect(hummed, 60).seek(rest).size() == 1);
  }
  CHECK(taken <= 2);
}

TEST_CASE("hum: no line near a partial of the string") {
  const auto hum = rosin::hum_effect({300.5, hum_rate_Hz, 9000, 0.2, 0.6, 1}, 60);  // five times 60 is the fundamental
  rosin::pluck_scene s;
  const std::vector<double> start(hum.parameters.size(), 0.0);
  hum.apply(s, start.data(), 0);
  CHECK(s.hum.size() == 5);
  CHECK(hum.parameters.size() == 1 + 4 * 5);
  // a thirtieth beside it they can be told apart: what the partial does the others tell as well
  CHECK(rosin::hum_effect({290.6, hum_rate_Hz, 9000, 0.2, 0.6, 1}, 60).parameters.size() == 1 + 4 * 6);
}

TEST_CASE("hum: a line close to a partial goes with others, and is none by itself") {
  const rosin::string_facts facts{302.6, hum_rate_Hz, 9000, 0.2, 0.6, 3};
  const auto hum = rosin::hum_effect(facts, 60);  // five times 60 is 0.9 % below the fundamental
  const auto among_others = hum.seek(humming(0.004));
  REQUIRE(among_others.size() == 1);
  rosin::pluck_scene s;
  hum.apply(s, among_others[0].data(), 1);
  CHECK(std::any_of(s.hum.begin(), s.hum.end(), [](const auto& line) { return line.frequency_Hz == 300; }));
  CHECK(hum.seek(humming(0.02, 300)).empty());
}
