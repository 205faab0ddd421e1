// SPDX-License-Identifier: MIT
#include <rosin/diagnose/even_tension.hpp>

#include <rosin/diagnose/tension_drift.hpp>
#include <rosin/reconstruct/consistency.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support/approx.hpp"
#include "support/burdened_stroke.hpp"

namespace {

using test::burdened_stroke;

const rosin::modal_rig stretchy{
    {.length_m = 0.32, .tension_N = 50, .fundamental_Hz = 500, .bending_stiffness_Nm2 = 4e-5, .loss = {.quality = 1000}},
    {7, 3.5, 15}};

}  // namespace

TEST_CASE("the stretch of a string in Helmholtz motion is that of the two straight parts of the string") {
  // the corner s from an end: (E A / 2 T L) h^2 (1 / s + 1 / (L - s)) with h = v s (L - s) / (2 f p L^2), bowed at p L
  const double f0 = 400, rate = 100e3, tension = 60, axial = 2e4, p = 0.25, length = 0.3;
  const double c = 2 * length * f0, z = tension / c, jump = 2 * z * 0.2 / p;  // of the force on an end
  std::array<std::vector<double>, 2> F{std::vector<double>(2000), std::vector<double>(2000)};
  for (std::size_t i = 0; i < 2000; ++i)
    for (std::size_t end = 0; end < 2; ++end) {  // sawteeth, half a period apart
      const double phase = static_cast<double>(i) * f0 / rate + (end == 0 ? 0.0 : 0.5);
      F[end][i] = (end == 0 ? 1 : -1) * jump * (phase - std::floor(phase) - 0.5);
    }
  const std::array<double, 2> delay{p / (2 * f0), (1 - p) / (2 * f0)};
  const auto e = rosin::stretch_by_motion(F, delay, rate, tension, axial);
  const double h_most = 0.2 / (8 * f0 * p);  // of the corner's parabola, m
  for (std::size_t i = 600; i < 1400; i += 13) {
    const double phase = static_cast<double>(i) * f0 / rate, u = std::abs(2 * (phase - std::floor(phase)) - 1);
    const double s = u * length, h = 4 * h_most * u * (1 - u);
    const double expected = axial / (2 * tension * length) * h * h * (1 / std::max(1e-9, s) + 1 / std::max(1e-9, length - s));
    INFO(i);
    CHECK(e[i] == test::approx(expected).epsilon(0.03).scale(3e-4));
  }
}

TEST_CASE("a stretched stroke is reconstructed on the clock of its waves as well as a steady one") {
  constexpr double axial_N = 15e3, speed_m_s = 0.3;
  const auto at = rosin::contact_at(stretchy.string, burdened_stroke::position);
  const auto reconstruct = [&](const rosin::bow_point& point, const auto& force_N) {
    return rosin::reconstructor<double>(point, burdened_stroke::limits, burdened_stroke::rate_Hz)(force_N[0], force_N[1]);
  };
  const burdened_stroke steady(stretchy, {}, speed_m_s), bowed(stretchy, {.axial_stiffness_N = axial_N}, speed_m_s);
  const auto reference = steady.errors_of(reconstruct(at, steady.end_N));

  const auto e = rosin::stretch_by_motion(bowed.end_N, at.delay_s, burdened_stroke::rate_Hz, stretchy.string.tension_N, axial_N);
  const rosin::wave_clock clock(e);
  auto tuned = at;
  rosin::detail::tighten(tuned, clock.mean_stretch());
  const auto raw = reconstruct(tuned, bowed.end_N);
  const auto even_mean = bowed.errors_of(raw);

  auto motion = reconstruct(tuned, std::array{clock.even(bowed.end_N[0]), clock.even(bowed.end_N[1])});
  const auto parts = rosin::consistency_delta(motion.force_near_N, motion.force_far_N);
  clock.read_back(motion);
  const auto found = bowed.errors_of(motion);
  INFO("steady ", reference[0], " ", reference[1], ", mean tension ", even_mean[0], " ", even_mean[1], ", waves' clock ",
       found[0], " ", found[1], ", mean stretch ", clock.mean_stretch());
  CHECK(parts < 0.25 * rosin::consistency_delta(raw.force_near_N, raw.force_far_N));
  CHECK(even_mean[0] > 5 * reference[0]);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(even_mean[i] > 1.5 * reference[i]);
    CHECK(found[i] < 1.3 * reference[i] + 0.0004);
  }
}

TEST_CASE("a wave clock that nothing stretches leaves a record as it is; what is read back is known a little less far") {
  const rosin::wave_clock clock(std::vector<double>(500, 0.0));
  std::vector<double> x(500);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::sin(0.3 * static_cast<double>(i));
  const auto y = clock.even(x);
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(y[i] == test::approx(x[i]).epsilon(1e-5).scale(1));
  rosin::bow_motion<double> m{x, x, x, x, {100, 400}};
  clock.read_back(m);
  CHECK(m.known.begin == 125);
  CHECK(m.known.end == 375);
  CHECK(std::isnan(m.force_near_N[124]));
  CHECK(m.velocity_far_m_s[200] == test::approx(x[200]).epsilon(1e-5).scale(1));
  CHECK(rosin::wave_clock({}).even({}).empty());
}
