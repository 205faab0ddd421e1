// SPDX-License-Identifier: MIT
#include <rosin/calibrate/free_decay.hpp>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <doctest/doctest.h>

#include <cmath>

#include "support/approx.hpp"

namespace {

constexpr double pi = 3.14159265358979323846, rate_Hz = 128e3;
using samples = std::vector<double>;

rosin::modal_rig e_rig() {
  return {.string = {.length_m = 0.314,
                     .tension_N = 72.5,
                     .fundamental_Hz = 660,
                     .bending_stiffness_Nm2 = 4.7e-5,
                     .loss = {.quality = 1000}},
          .torsion = {7, 3.5, 15}};
}

double stiffness_of(const rosin::string_parameters& s) {
  return s.bending_stiffness_Nm2 * std::pow(pi / s.length_m, 2) / s.tension_N;
}

rosin::free_decay_options expecting(const rosin::string_parameters& s) { return {.inharmonicity = 1.1 * stiffness_of(s)}; }

/// Bowed, and lifted at 0.08 s.
rosin::modal_take lifted() {
  const auto rod = [](double t) noexcept {
    return rosin::rod_state{0.2 * std::min(t / 0.01, 1.0), 0.3 * std::clamp((0.08 - t) / 0.004, 0.0, 1.0)};
  };
  return *rosin::simulate_stroke(e_rig(), rosin::velocity_curve<rosin::two_exponential_curve<>>{}, rod, {.duration_s = 0.25},
                                 {.oversampling = 4, .mode_limit_Hz = 160e3});
}

samples recorded(const samples& force_N, std::uint64_t seed) {
  return rosin::convert(force_N, rate_Hz, {.gain = 1.03, .newtons_per_full_scale = 1, .noise_N = 3e-4, .ac_coupled_Hz = 3}, seed)
      .newtons();
}

samples wave(std::size_t size, double (*f)(double)) {
  samples out(size);
  for (std::size_t n = 0; n < size; ++n) out[n] = f(static_cast<double>(n) / rate_Hz);
  return out;
}

}  // namespace

TEST_CASE("after a bow that was lifted: pitch within 0.1 cent and Q within one per cent from a recording of 16 bits") {
  const auto take = lifted();
  const auto& string = e_rig().string;
  const auto off = rosin::contact_ends(take.contact_force_N, rate_Hz, 660);
  REQUIRE(off);
  const double lift_s = static_cast<double>(*off) / rate_Hz;
  CHECK(lift_s > 0.078);
  CHECK(lift_s < 0.083);
  const auto near = recorded(take.force_near_N, 5), far = recorded(take.force_far_N, 6);
  const auto decay = rosin::fit_free_decay({near, far}, rate_Hz, 663, lift_s, expecting(string));
  REQUIRE(decay);
  CHECK(std::abs(1200 * std::log2(decay->fundamental_Hz / 660)) < 0.02);
  CHECK(std::abs(decay->fundamental_Hz - 660) < 5 * decay->fundamental_sd + 1e-3);
  CHECK(decay->inharmonicity == test::approx(stiffness_of(string)).epsilon(0.002));
  for (const int n : {1, 2, 5, 10, 20, 27}) {
    CHECK(decay->quality(n) == test::approx(1000).epsilon(0.01));
    CHECK(std::abs(1200 * std::log2(decay->frequency_Hz(n) / rosin::partial_frequency(660, stiffness_of(string), n))) < 0.1);
  }
  CHECK(std::abs(decay->loss.value[0] - 1e-3) < 6 * decay->loss.inverse_q_sd(3000) + 1e-5);
  CHECK(decay->partials[0].size() > 20);
}

TEST_CASE("loss that grows with frequency is told from loss that does not") {
  auto rig = e_rig();
  rig.string.loss = {.quality = 1500, .internal_s = 5e-8};
  const auto rod = [](double t) noexcept { return rosin::rod_state{0.15, 0.3 * std::clamp((0.03 - t) / 0.002, 0.0, 1.0)}; };
  const auto take = rosin::simulate_stroke(rig, rosin::velocity_curve<rosin::two_exponential_curve<>>{}, rod,
                                           {.duration_s = 0.17}, {.oversampling = 4, .mode_limit_Hz = 160e3});
  const auto decay = rosin::fit_free_decay({recorded(take->force_near_N, 1), recorded(take->force_far_N, 2)}, rate_Hz, 660, 0.032,
                                           expecting(rig.string));
  REQUIRE(decay);
  for (const int n : {1, 5, 15, 25})
    CHECK(decay->quality(n) == test::approx(1 / rig.string.loss.inverse_q(decay->frequency_Hz(n))).epsilon(0.01));
}

TEST_CASE("a bow that stays on ends nowhere, and no bow at all neither") {
  const auto saw = [](double t) { return std::fmod(660 * t, 1.0) - 0.3; };
  CHECK(!rosin::contact_ends(wave(20000, saw), rate_Hz, 660));
  CHECK(!rosin::contact_ends(samples(20000, 0.0), rate_Hz, 660));
  CHECK(!rosin::contact_ends(samples(10, 1.0), rate_Hz, 660));
  auto force = wave(20000, saw);
  std::fill(force.begin() + 9000, force.end(), 0.001);
  const auto end = rosin::contact_ends(force, rate_Hz, 660);
  REQUIRE(end);
  CHECK(*end >= 9000);
  CHECK(*end < 9000 + 194);
  for (std::size_t n = 0; n < force.size(); ++n) force[n] -= 0.2 * std::exp(-static_cast<double>(n) / 15000);  // AC coupled
  CHECK(!rosin::contact_ends(force, rate_Hz, 660));
  CHECK(rosin::contact_ends(force, rate_Hz, 660, false) == end);
}

TEST_CASE("what does not ring freely, or not for long enough, is refused") {
  const auto steady = wave(20000, [](double t) { return std::fmod(660 * t, 1.0) - 0.5; });
  CHECK(!rosin::fit_free_decay({steady, steady}, rate_Hz, 660, 0.01));
  const auto noise = rosin::convert(samples(20000, 0.0), rate_Hz, {.noise_N = 1e-3}, 3).newtons();
  const auto none = rosin::fit_free_decay({noise, noise}, rate_Hz, 660, 0.01);
  CHECK(none.error() == "free decay: fewer than three partials are damped lines");
  CHECK(rosin::fit_free_decay({steady, steady}, rate_Hz, 660, 0.12).error() == "free decay: it lasts for less than 40 periods");
  CHECK(!rosin::fit_free_decay({steady, steady}, rate_Hz, 40e3, 0));
}
