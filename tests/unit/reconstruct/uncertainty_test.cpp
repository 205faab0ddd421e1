// SPDX-License-Identifier: MIT
// How well stated deviations cover real errors is tested with fine_tune_test.cpp, on a bowed string.
#include <rosin/reconstruct/uncertainty.hpp>

#include <doctest/doctest.h>

#include <random>

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
  CHECK(std::sqrt(force / count) == doctest::Approx(sure.force_noise_N).epsilon(0.03));
  CHECK(std::sqrt(velocity / count) == doctest::Approx(sure.velocity_noise_m_s).epsilon(0.03));
  CHECK(sure.force_model_N < 0.3 * sure.force_noise_N);
  CHECK(sure.force_scale == 0.01);
  CHECK(sure.velocity_scale == doctest::Approx(std::hypot(0.01, 0.02)));
  CHECK(sure.force_sd_N.size() == near.size());
}
