// SPDX-License-Identifier: MIT
// How well stated deviations cover real errors is tested with fine_tune_test.cpp, on a bowed string.
#include <rosin/reconstruct/uncertainty.hpp>

#include <doctest/doctest.h>

#include <numbers>
#include <random>

#include "support/approx.hpp"

namespace reconstruct_uncertainty {

TEST_CASE("white noise comes out of the kernels as large as stated") {
  constexpr double rate_Hz = 128e3;
  const rosin::band limits{20e3, 45e3};
  rosin::calibration c;
  c.at = rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {800, 0, 0}}, 0.2);
  c.scale_relative_sd = 0.01;
  c.impedance_relative_sd = 0.02;
  const std::array<double, 2> noise{2e-3, 1e-3};
  std::mt19937_64 random{3};
  std::normal_distribution<double> gauss;
  std::vector<double> near(60000), far(60000);
  for (double& x : near) x = noise[0] * gauss(random);
  for (double& x : far) x = noise[1] * gauss(random);
  const auto motion = rosin::reconstructor<double>(c.at, limits, rate_Hz)(near, far);
  const auto s = rosin::sensitivity(c, near, far, limits, rate_Hz);
  const auto sure = rosin::uncertainty(c, motion, s, noise, limits, rate_Hz);
  double force = 0, velocity = 0;
  for (std::size_t i = motion.known.begin; i < motion.known.end; ++i) {
    force += motion.force_N(i) * motion.force_N(i);
    velocity += motion.velocity_m_s(i) * motion.velocity_m_s(i);
  }
  const double count = static_cast<double>(motion.known.end - motion.known.begin);
  CHECK(std::sqrt(force / count) == test::approx(sure.force_noise_N).epsilon(0.03));
  CHECK(std::sqrt(velocity / count) == test::approx(sure.velocity_noise_m_s).epsilon(0.03));
  CHECK(sure.force_model_N < 0.3 * sure.force_noise_N);
  CHECK(sure.force_scale == 0.01);
  CHECK(sure.velocity_scale == test::approx(std::hypot(0.01, 0.02)));
  CHECK(sure.force_sd_N.size() == near.size());
}

TEST_CASE("what the convention of damping leaves open is counted, although both versions agree") {
  rosin::calibration c;
  c.at = rosin::contact_at({0.314, 72.5, 659.69, 4.7e-5, {500, 0, 0}}, 0.2);
  constexpr std::size_t n = 4000;
  rosin::bow_motion<double> motion;
  motion.known = {0, n};
  for (std::size_t i = 0; i < n; ++i) {
    const double wave = std::sin(2 * std::numbers::pi * static_cast<double>(i) / 100);
    motion.force_near_N.push_back(0.3 + 0.2 * wave);
    motion.velocity_near_m_s.push_back(0.4 * wave);
  }
  motion.force_far_N = motion.force_near_N;
  motion.velocity_far_m_s = motion.velocity_near_m_s;
  rosin::reconstruction_sensitivity s;
  for (auto* part : {&s.force, &s.velocity, &s.difference}) part->setZero(n, rosin::waveform_parameters);
  const auto sure = rosin::uncertainty(c, motion, s, {0, 0}, {20e3, 45e3}, 128e3);
  CHECK(sure.force_model_N == test::approx(0.2 / std::numbers::sqrt2 / (2 * 500)).epsilon(1e-6));
  CHECK(sure.velocity_model_m_s == test::approx(0.4 / std::numbers::sqrt2 / (2 * 500)).epsilon(1e-6));
  CHECK(sure.force_sd_N[n / 2] == test::approx(sure.force_model_N));
}

}  // namespace reconstruct_uncertainty
