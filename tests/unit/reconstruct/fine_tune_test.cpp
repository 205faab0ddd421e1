// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/fine_tune.hpp>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/reconstruct/uncertainty.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <doctest/doctest.h>

#include <cmath>

#include "support/approx.hpp"

namespace reconstruct_fine_tune {

namespace {

const rosin::string_parameters string{
    .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 659.69, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 1000}};
const rosin::band limits{20e3, 40e3};
constexpr double noise_N = 0.3e-3;

struct recorded {
  rosin::modal_take truth;
  std::vector<double> near, far;
};

const recorded& bowed() {
  static const recorded r = [] {
    recorded out;
    out.truth = *rosin::simulate_stroke({.string = string}, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                                        rosin::steady_rod{.speed_m_s = 0.2, .normal_force_N = 0.3},
                                        {.position = 0.3, .duration_s = 0.06}, {.oversampling = 4});
    const rosin::converter sensor{.gain = 1, .newtons_per_full_scale = 2, .noise_N = noise_N, .bits = 16};
    out.near = rosin::convert(out.truth.force_near_N, out.truth.sample_rate_Hz, sensor, 1).newtons();
    out.far = rosin::convert(out.truth.force_far_N, out.truth.sample_rate_Hz, sensor, 2).newtons();
    return out;
  }();
  return r;
}

/// As a good pluck leaves it.
rosin::calibration exact() {
  rosin::calibration c;
  c.at = rosin::contact_at(string, 0.3);
  c.noise_N = {noise_N, noise_N};
  rosin::waveform_vector sd;
  sd << 1e-9, 1e-9, 1e-17, 1e-7, 1e-11, 3e-5;
  c.covariance = sd.cwiseAbs2().asDiagonal();
  return c;
}

}  // namespace

TEST_CASE("what is right already stays where it is, within the noise") {
  const rosin::fine_tuning t = rosin::fine_tune(exact(), bowed().near, bowed().far, limits, bowed().truth.sample_rate_Hz);
  CHECK(t.sigmas < 4);
  CHECK(std::abs(t.shift[0]) < 2e-8);
  CHECK(t.delta_after <= t.delta_before);
  CHECK(t.delta_after > 0.8 * t.delta_before);
}

TEST_CASE("a drift of tension and a moved rod are found, and the waveform mends") {
  rosin::calibration off = exact();
  const double stretch = 1.004, moved = 8e-7;  // 0.8 % of tension; a fifth of a millimetre
  off.at.delay_s = {off.at.delay_s[0] * stretch + moved, off.at.delay_s[1] * stretch - moved};
  off.gain = {1.003, 0.998};
  const rosin::fine_tuning t = rosin::fine_tune(off, bowed().near, bowed().far, limits, bowed().truth.sample_rate_Hz);
  CHECK(t.sigmas > 20);
  CHECK(t.tuned.at.delay_s[0] == test::approx(exact().at.delay_s[0]).epsilon(2e-4));
  CHECK(t.tuned.at.delay_s[1] == test::approx(exact().at.delay_s[1]).epsilon(2e-4));
  CHECK(t.tuned.gain[0] / t.tuned.gain[1] == test::approx(1).epsilon(1e-3));
  CHECK(t.delta_after < 0.1 * t.delta_before);
}

TEST_CASE("stated standard deviations are what the error is") {
  const rosin::calibration c = exact();
  const double rate_Hz = bowed().truth.sample_rate_Hz;
  const auto motion = rosin::reconstructor<double>(c.at, limits, rate_Hz)(bowed().near, bowed().far);
  const auto clean = rosin::reconstructor<double>(c.at, limits, rate_Hz)(bowed().truth.force_near_N, bowed().truth.force_far_N);
  const auto answers = rosin::sensitivity(c, bowed().near, bowed().far, limits, rate_Hz);
  const auto sure = rosin::uncertainty(c, motion, answers, c.noise_N, limits, rate_Hz);
  double force = 0, velocity = 0, stated_f = 0, stated_v = 0;
  for (std::size_t i = motion.known.begin; i < motion.known.end; ++i) {
    force += std::pow(motion.force_N(i) - clean.force_N(i), 2);
    velocity += std::pow(motion.velocity_m_s(i) - clean.velocity_m_s(i), 2);
    stated_f += std::pow(sure.force_sd_N[i], 2);
    stated_v += std::pow(sure.velocity_sd_m_s[i], 2);
  }
  CHECK(std::sqrt(stated_f / force) == test::approx(1).epsilon(0.1));
  CHECK(std::sqrt(stated_v / velocity) == test::approx(1).epsilon(0.1));
}

TEST_CASE("what the versions disagree in beyond noise widens the error bars") {
  rosin::calibration off = exact();
  off.at.delay_s[0] += 3e-7;
  const double rate_Hz = bowed().truth.sample_rate_Hz;
  const auto motion = rosin::reconstructor<double>(off.at, limits, rate_Hz)(bowed().near, bowed().far);
  const auto answers = rosin::sensitivity(off, bowed().near, bowed().far, limits, rate_Hz);
  const auto sure = rosin::uncertainty(off, motion, answers, off.noise_N, limits, rate_Hz);
  CHECK(sure.force_model_N > sure.force_noise_N);
}

}  // namespace reconstruct_fine_tune
