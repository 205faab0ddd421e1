// SPDX-License-Identifier: MIT
#include <rosin/simulate/travelling_string.hpp>

#include "support/approx.hpp"
#include "support/middle_of.hpp"
#include "support/violin_e_string.hpp"

#include <doctest/doctest.h>

namespace simulate_travelling_string {

namespace {

rosin::modal_rig rig(bool turns) {
  auto out = test::violin_e_string;
  if (!turns) out.torsion = {};
  return out;
}

}  // namespace

TEST_CASE("a force that stays while the contact travels holds the string where it would be held there") {
  const auto string = rig(false);
  const auto design = rosin::design_travelling_wave(string, {0.2, 0.3}, {.oversampling = 2, .band_Hz = 40e3});
  REQUIRE_MESSAGE(design, design.error());
  const double step_s = design->kernels.step_s;
  rosin::travelling_string<double> waves{*design, 0.2};
  double now = 0;
  std::vector<double> place;
  const int steps = static_cast<int>(0.5 / step_s);
  for (int n = 0; n < steps; ++n) {
    const double x = 0.2 + 0.1 * std::min(1.0, 2.0 * n / steps);
    waves.move_to(x);
    // the contact goes on along a string that is bent at it: mean of both sides
    const double slope = x < 0.3 ? 0.1 * 2 / 0.5 * string.string.length_m * ((1 - x) - x) / 2 / string.string.tension_N : 0;
    place.push_back(now += (waves.apply(1).centre_m_s + slope) * step_s);
  }
  CHECK(test::middle_of(std::span(place).last(place.size() / 4)) ==
        test::approx(rosin::static_compliance_m_N(string.string, 0.3)).epsilon(0.02));
}

TEST_CASE("what the ends hear adds up to the force that stays, shared as on a lever") {
  const auto string = rig(false);
  const auto design = rosin::design_travelling_wave(string, {0.2, 0.3}, {.oversampling = 2, .band_Hz = 40e3});
  REQUIRE(design);
  rosin::travelling_string<double> waves{*design, 0.2};
  const int steps = static_cast<int>(0.6 / design->kernels.step_s),
            period = static_cast<int>(std::lround(1 / (660 * design->kernels.step_s)));
  std::array<double, 2> mean{};
  for (int n = 0; n < steps; ++n) {
    waves.move_to(0.2 + 0.08 * std::min(1.0, 2.0 * n / steps));
    waves.apply(1);
    if (n + 20 * period < steps) continue;
    for (std::size_t j = 0; j < 2; ++j) mean[j] += waves.wave(j, waves.waves() - 1) / (20 * period);
  }
  CHECK(mean[0] == test::approx(0.72).epsilon(5e-3));
  CHECK(mean[1] == test::approx(0.28).epsilon(5e-3));
}

TEST_CASE("torsion is that of the place where the contact is") {
  const auto string = rig(true);
  const auto design = rosin::design_travelling_wave(string, {0.2, 0.4}, {.oversampling = 2, .band_Hz = 40e3});
  REQUIRE(design);
  rosin::travelling_turn moved{*design, 0.2}, there{*design, 0.4};
  CHECK(moved.mobility() != test::approx(there.mobility()));
  moved.move_to(0.4);
  CHECK(moved.mobility() == test::approx(there.mobility()));
  double turned = 0;
  for (int n = 0; n < 100000; ++n) {
    there.move_to(0.4);
    turned += (there.free() + there.mobility()) * design->kernels.step_s;
    there.advance(1);
  }
  CHECK(turned == test::approx(0.4 * 0.6 / design->turn_stiffness_N_m).epsilon(1e-3));
}

TEST_CASE("between an end and a contact that sticks the string rings down as a shorter one does") {
  auto string = rig(false);
  string.string.loss.quality = 3000;
  const auto design = rosin::design_travelling_wave(string, {0.03, 0.05}, {.oversampling = 8});
  REQUIRE_MESSAGE(design, design.error());
  rosin::travelling_string<double> waves{*design, 0.04};
  std::array<double, 2> largest{};
  const int steps = static_cast<int>(0.1 / design->kernels.step_s);
  for (int n = 0; n < steps; ++n) {
    waves.move_to(0.04);
    const auto line = waves.line({});
    const double force = n < 100 ? 1 : -line.free_velocity_m_s / line.mobility_m_Ns;
    waves.apply(force);
    if (n > steps / 10) largest[n < steps / 2 ? 0 : 1] = std::max(largest[n < steps / 2 ? 0 : 1], std::abs(force));
  }
  CHECK(largest[0] > 1e-3);
  CHECK(largest[1] < largest[0]);
}

TEST_CASE("a contact is held within the range of its kernels") {
  const auto design = rosin::design_travelling_wave(rig(true), {0.2, 0.22}, {.oversampling = 2, .band_Hz = 40e3});
  REQUIRE(design);
  rosin::travelling_string<double> waves{*design, 0.2};
  CHECK(waves.move_to(0.21) == 0.21);
  CHECK(waves.move_to(1.2) == 0.22);
  CHECK(waves.line({}).mobility_m_Ns > 0);
  CHECK(waves.move_to(std::nan("")) == 0.2);
}

TEST_CASE("in single precision the same motion") {
  const auto design = rosin::design_travelling_wave(rig(true), {0.2, 0.22}, {.oversampling = 2, .band_Hz = 40e3});
  REQUIRE(design);
  rosin::travelling_string<double> exact{*design, 0.2};
  rosin::travelling_string<float> single{*design, 0.2};
  for (int n = 0; n < 4000; ++n) {
    const double x = 0.2 + 0.02 * n / 4000, force = std::sin(0.02 * n);
    exact.move_to(x), single.move_to(x);
    CHECK(static_cast<double>(single.line({}).free_velocity_m_s) ==
          test::approx(exact.line({}).free_velocity_m_s).epsilon(1e-4).scale(1));
    exact.apply(force), single.apply(static_cast<float>(force));
  }
}

}  // namespace simulate_travelling_string
