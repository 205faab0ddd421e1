// SPDX-License-Identifier: MIT
#include <rosin/diagnose/sensor_chain.hpp>

#include <rosin/simulate/burdened_sensors.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

constexpr double chain_rate = 128e3;

/// A burst of two tones that begins and ends gently, sampled `fine` times as often.
std::vector<double> burst(std::size_t fine = 1) {
  std::vector<double> out(3000 * fine);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t = static_cast<double>(i) / (chain_rate * static_cast<double>(fine)), turn = 2 * std::numbers::pi * t;
    out[i] = std::exp(-std::pow((t - 0.008) / 0.0022, 2)) * (std::sin(900 * turn) + 0.3 * std::sin(7e3 * turn));
  }
  return out;
}

double farthest(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

TEST_CASE("a sensor's ringing in the frequency domain is that of its mass on a spring, step by step, and can be divided out") {
  auto stepped = burst(32);
  rosin::detail::ring_along(stepped, 11e3, 12, 1 / (chain_rate * 32));
  std::vector<double> expected;
  for (std::size_t i = 0; i < stepped.size(); i += 32) expected.push_back(stepped[i]);
  rosin::pluck_scene scene;
  scene.sensors[0].resonance_Hz = 11e3, scene.sensors[0].q = 12;
  std::array<std::vector<double>, 2> force{burst(), burst()};
  rosin::pass_sensors(force, scene, chain_rate);
  CHECK(farthest(force[0], expected) < 2e-4);
  CHECK(force[1] == burst());
  rosin::detail::unring(force[0], scene.sensors[0], chain_rate);
  CHECK(farthest(force[0], burst()) < 1e-6);
}

TEST_CASE("delay, high-pass and leakage, in the order in which the channels have them") {
  rosin::pluck_scene scene;
  scene.sensors[1].delay_s = 2 / chain_rate, scene.sensors[0].corner_Hz = scene.sensors[1].corner_Hz = 9, scene.crosstalk = 0.1;
  std::array<std::vector<double>, 2> force{burst(), burst()};
  for (double& x : force[1]) x *= -0.5;
  auto passed = force;
  rosin::pass_sensors(passed, scene, chain_rate);
  auto late = force[1];
  late.insert(late.begin(), 2, 0.0), late.resize(force[0].size());
  for (auto* x : {&force[0], &late}) rosin::pass_ac_coupled(std::span(*x), 9, chain_rate);
  for (const std::size_t i : {700U, 1024U, 1300U, 2900U}) {
    CHECK(passed[0][i] == test::approx(force[0][i] + 0.1 * late[i]).epsilon(1e-6).scale(0.1));
    CHECK(passed[1][i] == test::approx(late[i] + 0.1 * force[0][i]).epsilon(1e-6).scale(0.1));
  }
}

TEST_CASE("a wire that lets go slowly: what a sudden release makes, spread over the rate at which the force goes") {
  constexpr double lasts_s = 50e-6;
  constexpr std::size_t fine = 64;
  const auto sudden = burst(fine);
  const auto steps = static_cast<std::size_t>(lasts_s * chain_rate * fine);
  std::vector<double> expected;
  for (std::size_t i = 0; i < sudden.size(); i += fine) {
    double sum = 0, all = 0;
    for (std::size_t k = 0; k <= steps; ++k) {
      const double weight = std::sin(std::numbers::pi * static_cast<double>(k) / static_cast<double>(steps));
      sum += weight * (i >= k ? sudden[i - k] : 0.0), all += weight;
    }
    expected.push_back(sum / all);
  }
  rosin::pluck_scene scene;
  scene.release_duration_s = lasts_s;
  std::array<std::vector<double>, 2> force{burst(), burst()};
  rosin::pass_wire(force, scene, chain_rate);
  CHECK(farthest(force[0], expected) < 1e-3);
  CHECK(farthest(force[0], burst()) > 0.1);
}
