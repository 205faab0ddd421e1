// SPDX-License-Identifier: MIT
#include <rosin/calibrate/stroke_scale.hpp>

#include <rosin/calibrate/stroke_fit.hpp>
#include <rosin/condition/low_pass.hpp>
#include <rosin/reconstruct/whole_record.hpp>
#include <rosin/torsion/contact_signal.hpp>
#include <rosin/torsion/torsion_response.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"
#include "support/uneven_strokes.hpp"

TEST_CASE("The surface that sticks tells the scale of the velocity, slips and noise or not") {
  rosin::gaussian_source g{4};
  std::vector<double> rod, surface;
  for (int i = 0; i < 20000; ++i) {
    rod.push_back(0.1 * std::min(1.0, i / 2000.0) * (1 + 0.01 * std::sin(0.003 * i)));
    surface.push_back(0.96 * (i % 200 < 170 ? rod.back() : -5.6 * rod.back()) + 1e-3 * g());
  }
  const auto scale = rosin::scale_from_sticking({{surface, rod, 50e3, 8e3}});
  REQUIRE_MESSAGE(scale, scale.error());
  CHECK(scale->factor == test::approx(1 / 0.96).epsilon(5e-4));
  CHECK(scale->sticking[0] == test::approx(0.85).epsilon(0.03));
}

TEST_CASE("A string that never sticks tells no scale") {
  rosin::gaussian_source g{4};
  std::vector<double> rod(20000, 0.1), surface;
  for (int i = 0; i < 20000; ++i) surface.push_back(0.2 * g());
  const auto scale = rosin::scale_from_sticking({{surface, rod, 50e3, 8e3}});
  CHECK(scale.error() == "the string sticks in none of the strokes: the scale of the force over the impedance cannot be had");
}

TEST_CASE("From strokes alone to F/Z: fit, reconstruction, torsion as declared, and the rod's speed") {
  auto drawn = test::draw_strokes(1, 3, 0.6);
  const auto& truth = drawn.machine.rig.string;
  for (std::size_t i = 0; i < 3; ++i) {  // Helmholtz motion, in the middle of Schelleng's triangle
    auto& s = drawn.strokes[i];
    s.speed_m_s = 0.1, s.normal_force_N = 2 * truth.impedance_Ns_m() * s.speed_m_s / s.position / 0.4 * 0.6;
  }
  std::vector<rosin::modal_take> played;
  const auto takes = test::recorded(drawn, &played);
  const auto fit = rosin::fit_strokes(takes, drawn.guess);
  REQUIRE_MESSAGE(fit, fit.error());
  const auto told = rosin::impedance_of(drawn.declared_length_m, 1e-3, drawn.declared_tension_N, 0.01,
                                        fit->value[rosin::stroke_layout::fundamental], 1e-6);
  CHECK(std::abs(told.value_Ns_m / truth.impedance_Ns_m() - 1) < 3 * told.relative_sd);
  CHECK(told.relative_sd == test::approx(std::hypot(0.01, 1e-3)).epsilon(1e-3));
  const double half = std::exp(fit->value[rosin::stroke_layout::ln_gain_ratio] / 2);
  const rosin::band limits{7000, 8000};
  std::vector<std::vector<double>> surface, rod;
  for (std::size_t t = 0; t < takes.size(); ++t) {
    auto force = takes[t].force_N;
    for (double& x : force[0]) x /= half;
    for (double& x : force[1]) x *= half;
    const auto string = fit->string(t);
    const auto at = string.seen_from(fit->position(t), told.value_Ns_m);
    const auto motion = rosin::reconstruct_whole(
        at, [&](double f) { return string.propagation_rate(f); }, {fit->noise.sensor_N, 0.03, fit->noise.model}, force[0],
        force[1], limits, 50e3);
    const auto& twist = drawn.machine.rig.torsion;
    const rosin::torsion_waveguide turning{{at.delay_s[0] / twist.speed_ratio, at.delay_s[1] / twist.speed_ratio},
                                           twist.impedance_ratio * told.value_Ns_m,
                                           twist.quality};
    const auto known = motion.versions.known;
    const auto part = [&](const std::vector<double>& x) { return std::span(x).subspan(known.begin, known.end - known.begin); };
    rosin::contact_signal<> f{part(motion.combined.force_N), 50e3};
    auto turned = f.through({1e9}, turning);
    for (std::size_t i = 0; i < turned.size(); ++i) turned[i] += part(motion.combined.velocity_m_s)[i];
    surface.push_back(std::move(turned));
    const auto moved = part(played[t].rod_velocity_m_s);
    rod.emplace_back(moved.begin(), moved.end());
  }
  std::vector<rosin::moving_surface> seen;
  for (std::size_t t = 0; t < takes.size(); ++t) seen.push_back({surface[t], rod[t], 50e3, 8e3});
  const auto scale = rosin::scale_from_sticking(seen);
  REQUIRE_MESSAGE(scale, scale.error());
  const double expected = told.value_Ns_m / truth.impedance_Ns_m() / std::sqrt(drawn.machine.gain[0] * drawn.machine.gain[1]);
  CHECK(scale->factor == test::approx(expected).epsilon(3e-3));
}
