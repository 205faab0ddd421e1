// SPDX-License-Identifier: MIT
// A lighter form of the figures of docs/explain/strokes.md: shorter and fewer strokes.
#include <rosin/calibrate/stroke_fit.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"
#include "support/uneven_strokes.hpp"

namespace {

using fit_layout = rosin::stroke_layout;

/// rms error of ln Q of the modes up to an edge.
double error_of_q(const rosin::uneven_string& found, const test::uneven_machine& machine, double edge_Hz) {
  double sum = 0, count = 0;
  for (int n = 1; found.partial_Hz(n) < edge_Hz; ++n, ++count) {
    const double f = found.partial_Hz(n), truth = machine.rig.string.loss.inverse_q(f) * std::exp(-machine.ln_own_q(n));
    sum += std::pow(std::log(found.inverse_q(f) / truth), 2);
  }
  return std::sqrt(sum / count);
}

}  // namespace

TEST_CASE("Strokes alone tell pitch, stiffness, loss, places and the ratio of the gains") {
  const auto drawn = test::draw_strokes(1, 4, 0.6);
  const auto fit = rosin::fit_strokes(test::recorded(drawn), drawn.guess);
  REQUIRE_MESSAGE(fit, fit.error());
  const auto& truth = drawn.machine.rig.string;
  CHECK(fit->converged);
  CHECK(fit->holds());
  CHECK_FALSE(fit->odd.has_value());
  CHECK(fit->unidentified.empty());
  CHECK(fit->value[fit_layout::fundamental] == test::approx(truth.fundamental_Hz).epsilon(1e-5));
  CHECK(fit->value[fit_layout::inharmonicity] == test::approx(truth.inharmonicity()).epsilon(0.02));
  CHECK(std::abs(fit->value[fit_layout::ln_gain_ratio] - std::log(drawn.machine.gain[0] / drawn.machine.gain[1])) < 1e-3);
  for (std::size_t t = 0; t < 4; ++t) {
    CHECK(std::abs(fit->position(t) - drawn.strokes[t].position) < 1e-4);
    CHECK(fit->misfit[t] == test::approx(1).epsilon(0.3));
    CHECK_FALSE(fit->drifted(t));
  }
  CHECK(error_of_q(fit->string(), drawn.machine, 7000) < 0.1);
  for (std::size_t c = 0; c < 2; ++c) CHECK(fit->noise.sensor_N[c] == test::approx(drawn.machine.noise_N[c]).epsilon(0.15));
}

TEST_CASE("A stroke that contradicts the others is named, and the rest is fitted without it") {
  auto drawn = test::draw_strokes(3, 4, 0.5);
  auto takes = test::recorded(drawn);
  for (double& x : takes[2].force_N[1]) x *= 1.15;  // a connector that came loose
  const auto fit = rosin::fit_strokes(takes, drawn.guess);
  REQUIRE_MESSAGE(fit, fit.error());
  REQUIRE(fit->odd.has_value());
  CHECK(*fit->odd == 2);
  CHECK(fit->position(2) == drawn.declared[2]);
  CHECK(std::abs(fit->position(3) - drawn.strokes[3].position) < 1e-4);
  CHECK(fit->value[fit_layout::fundamental] == test::approx(drawn.machine.rig.string.fundamental_Hz).epsilon(1e-5));
}

TEST_CASE("A tension that drifts from stroke to stroke is found") {
  auto drawn = test::draw_strokes(6, 4, 0.5);
  drawn.strokes[1].tension_drift = 2e-4, drawn.strokes[3].tension_drift = -3e-4;
  const auto fit = rosin::fit_strokes(test::recorded(drawn), drawn.guess);
  REQUIRE_MESSAGE(fit, fit.error());
  CHECK_FALSE(fit->odd.has_value());
  CHECK(fit->value[fit->layout.drift(1)] - fit->value[fit->layout.drift(0)] == test::approx(2e-4).epsilon(0.05));
  CHECK(fit->value[fit->layout.drift(3)] - fit->value[fit->layout.drift(0)] == test::approx(-3e-4).epsilon(0.05));
  CHECK((fit->drifted(1) || fit->drifted(3)));
}

TEST_CASE("A contact that is not at one place is said not to be one") {
  auto drawn = test::draw_strokes(7, 3, 0.4);
  for (auto& s : drawn.strokes) s.width = 0.03;
  const auto fit = rosin::fit_strokes(test::recorded(drawn), drawn.guess);
  REQUIRE_MESSAGE(fit, fit.error());
  CHECK_FALSE(fit->holds());
}

TEST_CASE("A stroke that cannot be used is a reason not to begin") {
  const auto fit = rosin::fit_strokes({}, {.fundamental_Hz = 300});
  CHECK(fit.error() == "no stroke to fit");
}
