// SPDX-License-Identifier: MIT
#include <rosin/calibrate/stroke_layout.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

using strokes_layout = rosin::stroke_layout;

TEST_CASE("Parameters of strokes stand in order and have names") {
  const strokes_layout l(3, 4);
  CHECK(l.size() == 6 + 3 + 3 + 4);
  CHECK(l.name(strokes_layout::skew) == "skew_s");
  CHECK(l.name(l.position(1)) == "position of take 2");
  CHECK(l.name(l.drift(2)) == "drift of take 3");
  CHECK(l.name(l.own_q(3)) == "ln_q of mode 4");
}

TEST_CASE("A tension that drifts moves pitch and dispersion of one take as a string's does") {
  const strokes_layout l(2, 2);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(l.size());
  v[strokes_layout::fundamental] = 300, v[strokes_layout::inharmonicity] = 5e-5,
  v[strokes_layout::ln_inverse_quality] = std::log(1e-3);
  v[l.drift(1)] = 1e-3;
  const rosin::string_parameters at_rest{0.3, 60, 300, 5e-5 * 60 * 0.09 / std::pow(std::numbers::pi, 2)};
  auto tighter = at_rest;
  tighter.fundamental_Hz *= std::exp(1e-3), tighter.tension_N *= std::exp(2e-3);
  CHECK(l.string(v, 0).stiffness_s2 == test::approx(at_rest.stiffness_s2()).epsilon(1e-12));
  CHECK(l.string(v, 1).fundamental_Hz == test::approx(tighter.fundamental_Hz).epsilon(1e-12));
  CHECK(l.string(v, 1).stiffness_s2 == test::approx(tighter.stiffness_s2()).epsilon(1e-12));
  CHECK(l.string(v, 1).loss.quality == test::approx(1000));
}
