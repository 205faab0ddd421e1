// SPDX-License-Identifier: MIT
#include <rosin/torsion/torsion_fit.hpp>

#include <doctest/doctest.h>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/propagate/bow_point.hpp>
#include <rosin/reconstruct/reconstructor.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include "support/approx.hpp"

namespace torsion_torsion_fit {

namespace {

constexpr double rate = 128e3;
const rosin::string_parameters e_string{
    .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 1000}};

struct reconstructed {
  std::vector<double> force, velocity;
  double speed = 0;
};

/// A stroke as two 16-bit converters hear it, brought back to the bow.
reconstructed stroke(const rosin::modal_torsion& torsion, double position, double speed, double normal, double noise_N,
                     std::uint64_t seed) {
  const auto take =
      rosin::simulate_stroke({.string = e_string, .torsion = torsion}, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                             rosin::steady_rod{.speed_m_s = speed, .normal_force_N = normal, .start_s = 0.002, .rise_s = 0.005},
                             {.position = position, .duration_s = 0.09}, {.oversampling = 4});
  REQUIRE(take);
  const rosin::converter sensor{.gain = 1, .newtons_per_full_scale = 2, .noise_N = noise_N, .bits = 16};
  const auto near = rosin::convert(take->force_near_N, rate, sensor, seed),
             far = rosin::convert(take->force_far_N, rate, sensor, seed + 1);
  rosin::reconstructor<double> reconstruct(rosin::contact_at(e_string, position), {38400, 57600}, rate, 1e-5);
  const auto motion = reconstruct(near.newtons(), far.newtons());
  reconstructed r{std::vector<double>(take->size()), std::vector<double>(take->size()), speed};
  for (std::size_t i = 0; i < take->size(); ++i) r.force[i] = motion.force_N(i), r.velocity[i] = motion.velocity_m_s(i);
  return r;
}

std::vector<rosin::stick_take> takes_of(const std::vector<reconstructed>& strokes, double position) {
  const auto at = rosin::contact_at(e_string, position);
  std::vector<rosin::stick_take> takes;
  for (const auto& s : strokes)
    takes.push_back({s.force, s.velocity, rate, s.speed, at.delay_s, at.impedance_Ns_m, 1e-3, 57600, 0.02});
  return takes;
}

}  // namespace

TEST_CASE("torsion fit: speed to 1 %, impedance to 5 %, Q to 20 %, without being told where to look, and honest errors") {
  struct {
    rosin::modal_torsion torsion;
    double position;
  } cases[] = {{{7.0, 3.5, 15}, 0.3}, {{6.2, 4.0, 40}, 0.17}, {{7.4, 3.3, 18, true}, 0.26}};
  for (const auto& c : cases) {
    const std::vector<reconstructed> strokes{stroke(c.torsion, c.position, 0.2, 0.3, 0.4e-3, 7),
                                             stroke(c.torsion, c.position, 0.14, 0.4, 0.4e-3, 70)};
    const auto fit = rosin::fit_torsion(takes_of(strokes, c.position));
    REQUIRE(fit);
    CHECK(fit->decided());
    CHECK(fit->value.speed_ratio == test::approx(c.torsion.speed_ratio).epsilon(0.003));
    CHECK(fit->value.impedance_ratio == test::approx(c.torsion.impedance_ratio).epsilon(0.03));
    CHECK(fit->value.q == test::approx(c.torsion.quality).epsilon(0.08));
    CHECK(std::abs(fit->value.speed_ratio - c.torsion.speed_ratio) < 3.5 * fit->sd.speed_ratio);
    CHECK(std::abs(fit->value.impedance_ratio - c.torsion.impedance_ratio) < 3.5 * fit->sd.impedance_ratio);
    CHECK(std::abs(fit->value.q - c.torsion.quality) < 3.5 * fit->sd.q);
    CHECK(fit->sd.speed_ratio < 0.005 * fit->value.speed_ratio);
    CHECK(fit->damping == rosin::torsion_convention(true, c.torsion.causal));  // what the simulation has
    CHECK(fit->gain > 500);
  }
}

TEST_CASE("torsion fit: wound strings that turn slowly, slack ones that turn fast") {
  for (const double speed : {3.2, 14.0}) {
    const rosin::modal_torsion torsion{speed, 3.0, 30};
    const std::vector<reconstructed> strokes{stroke(torsion, 0.23, 0.2, 0.3, 0.4e-3, 7),
                                             stroke(torsion, 0.23, 0.14, 0.4, 0.4e-3, 70)};
    const auto fit = rosin::fit_torsion(takes_of(strokes, 0.23));
    REQUIRE(fit);
    CHECK(fit->decided());
    CHECK(fit->value.speed_ratio == test::approx(speed).epsilon(0.01));
  }
}

TEST_CASE("torsion fit: says what the data cannot tell") {
  SUBCASE("a string that does not turn") {
    const std::vector<reconstructed> strokes{stroke({}, 0.3, 0.2, 0.3, 0.4e-3, 3)};
    const auto fit = rosin::fit_torsion(takes_of(strokes, 0.3));
    CHECK((!fit || !fit->decided()));
  }
  SUBCASE("noise above everything") {
    const std::vector<reconstructed> strokes{stroke({7, 3.5, 15}, 0.3, 0.2, 0.3, 0.2, 5)};
    const auto fit = rosin::fit_torsion(takes_of(strokes, 0.3));
    CHECK((!fit || !fit->decided()));
  }
  SUBCASE("nothing sticks") {
    std::vector<double> force(9000, 0.1), velocity(9000);
    for (std::size_t i = 0; i < velocity.size(); ++i) velocity[i] = -0.5 + 0.2 * std::sin(0.05 * static_cast<double>(i));
    const auto fit = rosin::fit_torsion({{force, velocity, rate, 0.2, {2.3e-4, 5.3e-4}, 0.175, 1e-3}});
    CHECK((!fit || !fit->decided()));
  }
  SUBCASE("no take at all, or too short a one") {
    CHECK_FALSE(rosin::fit_torsion({}));
    const std::vector<double> few(100, 0.1);
    CHECK_FALSE(rosin::fit_torsion({{few, few, rate, 0.2, {2.3e-4, 5.3e-4}, 0.175, 1e-3}}));
  }
}

}  // namespace torsion_torsion_fit
