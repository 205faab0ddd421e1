// SPDX-License-Identifier: MIT
#include <rosin/calibrate/stroke_calibration.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

rosin::stroke_fit_result found_strokes() {
  rosin::stroke_fit_result fit;
  fit.layout = rosin::stroke_layout(2, 3);
  fit.value = Eigen::VectorXd::Zero(fit.layout.size());
  fit.value[rosin::stroke_layout::fundamental] = 300, fit.value[rosin::stroke_layout::inharmonicity] = 5e-5;
  fit.value[rosin::stroke_layout::ln_inverse_quality] = std::log(1e-3), fit.value[rosin::stroke_layout::ln_gain_ratio] = 0.02;
  fit.value[fit.layout.position(0)] = 0.1, fit.value[fit.layout.position(1)] = 0.15, fit.value[fit.layout.drift(1)] = 1e-3;
  fit.covariance = 1e-8 * Eigen::MatrixXd::Identity(fit.layout.size(), fit.layout.size());
  return fit;
}

}  // namespace

TEST_CASE("A calibration of a take is at its place and of its tension") {
  const auto fit = found_strokes();
  const auto c = rosin::calibration_from(fit, 1, 0.3, 0.01, 0.03);
  const double f0 = 300 * std::exp(1e-3);
  CHECK(c.at.delay_s[0] == test::approx(0.15 / (2 * f0)).epsilon(1e-12));
  CHECK(c.at.delay_s[1] == test::approx(0.85 / (2 * f0)).epsilon(1e-12));
  CHECK(c.gain[0] / c.gain[1] == test::approx(std::exp(0.02)).epsilon(1e-12));
  CHECK(c.at.loss.quality == test::approx(1000));
  CHECK(c.scale_relative_sd == 0.03);
}

TEST_CASE("Its covariance is that of the fit, by how the waveform parameters change") {
  const auto fit = found_strokes();
  const Eigen::MatrixXd to = rosin::waveform_jacobian(fit, 1);
  for (Eigen::Index p = 0; p < fit.layout.size(); ++p) {
    const double step = p == rosin::stroke_layout::fundamental ? 1e-3 : 1e-7;
    auto up = fit, down = fit;
    up.value[p] += step, down.value[p] -= step;
    const auto a = rosin::calibration_from(up, 1, 0.3, 0, 0), b = rosin::calibration_from(down, 1, 0.3, 0, 0);
    const std::array slope{
        a.at.delay_s[0] - b.at.delay_s[0],           a.at.delay_s[1] - b.at.delay_s[1],
        a.at.stiffness_s2 - b.at.stiffness_s2,       1 / a.at.loss.quality - 1 / b.at.loss.quality,
        a.at.loss.internal_s - b.at.loss.internal_s, std::log(a.gain[0] / a.gain[1]) - std::log(b.gain[0] / b.gain[1])};
    for (Eigen::Index w = 0; w < 6; ++w)
      CHECK(std::abs(slope[static_cast<std::size_t>(w)] / (2 * step) - to(w, p)) <= 1e-5 * std::abs(to(w, p)) + 1e-15);
  }
}
