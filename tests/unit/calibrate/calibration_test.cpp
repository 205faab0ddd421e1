// SPDX-License-Identifier: MIT
#include <rosin/calibrate/calibration.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/approx.hpp"

TEST_CASE("a calibration carries values and covariance over from the fit") {
  using layout = rosin::pluck_layout;
  std::vector<rosin::pluck_take> takes(2);
  takes[0].position = 0.201;
  takes[1].position = 0.2;
  rosin::pluck_fit_result fit;
  fit.layout = layout(takes, {});
  fit.value = Eigen::VectorXd::Zero(fit.layout.size());
  fit.value[layout::fundamental] = 650;
  fit.value[layout::inharmonicity] = 6e-5;
  fit.value[layout::inverse_quality] = 1e-3;
  fit.value[layout::gain_near] = std::log(1.1);
  fit.value[layout::gain_far] = std::log(0.9);
  fit.value[fit.layout.position(0)] = 0.2004;
  fit.value[fit.layout.position(1)] = 0.199;
  Eigen::VectorXd sd = Eigen::VectorXd::Constant(fit.layout.size(), 1e-12);
  sd[layout::fundamental] = 0.01;
  sd[fit.layout.position(1)] = 1e-4;
  sd[layout::gain_near] = sd[layout::gain_far] = 0.02;
  fit.covariance = sd.cwiseAbs2().asDiagonal();
  // Gains known to 1 % in common, and much better against each other.
  fit.covariance(layout::gain_near, layout::gain_far) = fit.covariance(layout::gain_far, layout::gain_near) = 0.02 * 0.02 * 0.999;

  const rosin::calibration c = rosin::calibration_from(fit, 0.2, 0.17, 0.015);
  CHECK(c.position == 0.199);  // of the take that was declared nearest, though the other one turned out nearer
  CHECK(c.at.delay_s[0] == test::approx(0.199 / 1300));
  CHECK(c.at.delay_s[1] == test::approx(0.801 / 1300));
  CHECK(c.at.stiffness_s2 == test::approx(6e-5 / std::pow(2 * std::numbers::pi * 650, 2)));
  CHECK(c.at.loss.quality == test::approx(1000));
  CHECK(c.gain[0] == test::approx(1.1));
  const double from_pitch = c.at.delay_s[0] * 0.01 / 650, from_position = 1e-4 / 1300;
  CHECK(std::sqrt(c.covariance(0, 0)) == test::approx(std::hypot(from_pitch, from_position)));
  CHECK(c.covariance(0, 1) ==
        test::approx(c.at.delay_s[0] * c.at.delay_s[1] * std::pow(0.01 / 650, 2) - from_position * from_position));
  CHECK(c.scale_relative_sd == test::approx(0.02).epsilon(1e-3));
  CHECK(std::sqrt(c.covariance(5, 5)) == test::approx(0.02 * std::sqrt(2 * 0.001)));
  CHECK(c.impedance_relative_sd == 0.015);
}

TEST_CASE("moving a calibration moves what it says, and moving it back brings it back") {
  rosin::calibration c;
  c.at = {{1e-4, 3e-4}, 4e-12, {900, 1e-8, 0}, 0.17};
  rosin::waveform_vector by;
  by << 1e-7, -2e-7, 1e-14, 1e-5, 1e-9, 0.01;
  const rosin::calibration moved = c.moved(by);
  CHECK(moved.at.delay_s[1] == test::approx(2.998e-4));
  CHECK(1 / moved.at.loss.quality == test::approx(1 / 900.0 + 1e-5));
  CHECK(moved.gain[0] / moved.gain[1] == test::approx(std::exp(0.01)));
  CHECK(moved.gain[0] * moved.gain[1] == test::approx(1));
  CHECK(moved.moved(-by).at.loss.quality == test::approx(900));
}
