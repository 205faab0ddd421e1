// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_take.hpp>

#include <random>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("contact take: what was found becomes part of the model") {
  rosin::contact_hypothesis rod{.effect = "rod-resonance",
                                .parameters = {{"frequency_Hz", 1500, 1}, {"q", 17, 1}, {"mass_kg", 0.002, 1e-4}}};
  const auto with_rod = rosin::include({}, rod);
  REQUIRE(with_rod.rod);
  CHECK((*with_rod.rod)[0] == 1500);
  CHECK((*with_rod.rod)[2] == 0.002);
  CHECK(with_rod.included == std::vector<std::string>{"rod-resonance"});
  rosin::contact_hypothesis torsion{.effect = "torsion",
                                    .parameters = {{"speed_ratio", 6.7, 0.01}, {"impedance_ratio", 4.1, 0.1}, {"q", 43, 1}}};
  const auto both = rosin::include(with_rod, torsion);
  REQUIRE(both.torsion);
  CHECK(both.torsion->q == 43);
  CHECK(both.included.size() == 2);
  CHECK(both.rod);
}

TEST_CASE("contact take: creep that was found stays in the model") {
  const rosin::contact_hypothesis creep{.effect = "creep", .parameters = {{"speed_m_s", 0.003, 1e-4}, {"sharpness", 0.2, 0.01}}};
  REQUIRE(rosin::include({}, creep).creep_sharpness);
  CHECK(*rosin::include({}, creep).creep_sharpness == 0.2);
}

TEST_CASE("contact take: what sticks is the surface, whatever the centre does meanwhile") {
  constexpr double rate = 96e3, speed = 0.2;
  const rosin::torsion_values rolls{6, 3, 20};
  rosin::contact_take t{.rate_Hz = rate, .rod_speed_m_s = speed, .delay_s = {0.2e-3, 0.9e-3}, .impedance_Ns_m = 0.2};
  std::vector<double> force(20000), centre(20000, speed);
  for (std::size_t i = 0; i < force.size(); ++i) {  // a force that jumps once a period and settles slowly
    const double at = static_cast<double>(i) / rate;
    force[i] = 0.3 + 0.2 * std::exp(-at / 0.06) * std::fmod(at / 2.2e-3, 1.0);
  }
  const auto guide = rosin::torsion_of(t.delay_s, t.impedance_Ns_m, rolls.speed_ratio, rolls.impedance_ratio, rolls.q);
  const auto rolling = rosin::torsion_velocity(guide, force, rate);
  for (std::size_t i = 0; i < force.size(); ++i) centre[i] -= rolling[i];
  force.front() = force.back() = std::nan("");  // unknown, as at both ends of a reconstruction
  t.force_N = force, t.velocity_m_s = centre;
  const auto surface = rosin::surface_m_s(t, rolls), as_it_was = rosin::surface_m_s(t, std::nullopt);
  double off = 0;
  for (std::size_t i = 200; i + 200 < surface.size(); ++i) off = std::max(off, std::abs(surface[i] - speed));
  CHECK(off < 2e-3 * speed);
  CHECK(std::equal(as_it_was.begin(), as_it_was.end(), centre.begin()));
}

TEST_CASE("contact take: a bow that is set on late and taken off early is examined in between") {
  constexpr double rate = 96e3;
  const auto take_with = [&](std::size_t on, std::size_t off, std::vector<double>& force, double noise_N = 1e-3) {
    std::mt19937 random(1);
    std::normal_distribution<> noise(0, noise_N);
    force.assign(30000, 0.0);
    for (std::size_t i = 0; i < force.size(); ++i) {
      force[i] = noise(random);
      if (i >= on && i < off) force[i] += 0.3 + 0.1 * std::fmod(static_cast<double>(i) / 200, 1.0);
    }
    force.front() = force.back() = std::nan("");
    rosin::contact_take t{.force_N = force, .velocity_m_s = force, .rate_Hz = rate, .delay_s = {0.2e-3, 0.8e-3}};
    t.force_sd_N = noise_N;
    rosin::leave_out_silence(t);
    return t;
  };
  std::vector<double> force;
  const auto whole = take_with(1, 29999, force);
  CHECK(whole.start_s == rosin::stick_take::usual_start_s);
  CHECK(whole.force_N.size() == 30000);
  const auto late = take_with(4800, 29999, force);
  CHECK(late.start_s == test::approx(rosin::stick_take::usual_start_s + 0.05).epsilon(1e-3));
  CHECK(late.force_N.size() == 30000);
  const auto brief = take_with(100, 20000, force);
  CHECK(brief.start_s == rosin::stick_take::usual_start_s);
  CHECK(brief.force_N.size() == 20000);
  CHECK(brief.velocity_m_s.size() == 20000);
  CHECK(brief.near_N.empty());
  const auto noisy = take_with(4800, 20000, force, 0.015);
  CHECK(noisy.start_s == test::approx(rosin::stick_take::usual_start_s + 0.05).epsilon(1e-3));
  CHECK(noisy.force_N.size() == 20000);
  auto silent = late;
  silent.start_s = rosin::stick_take::usual_start_s, silent.force_sd_N = 1;
  rosin::leave_out_silence(silent);  // all noise: nothing is told
  CHECK(silent.start_s == rosin::stick_take::usual_start_s);
}

TEST_CASE("contact take: torsion is declared relatively to the string at rest, whatever stretches it") {
  rosin::contact_take t{.delay_s = {0.2e-3, 0.8e-3}, .impedance_Ns_m = 0.2};
  CHECK(t.rest_delay_s()[1] == 0.8e-3);
  t.stretch = 0.02;
  CHECK(t.rest_delay_s()[1] / t.rest_delay_s()[0] == test::approx(4));
  CHECK(t.rest_delay_s()[0] == test::approx(0.2e-3 * std::sqrt(1.02)));
  CHECK(t.rest_impedance_Ns_m() * t.rest_delay_s()[0] == test::approx(0.2 * 0.2e-3));
}

TEST_CASE("contact take: intervals, and evidence that counts parameters") {
  const rosin::contact_parameter p{"q", 10, 2};
  CHECK(p.ci95()[0] == test::approx(10 - 3.92));
  CHECK(p.ci95()[1] == test::approx(10 + 3.92));
  rosin::contact_hypothesis h{.effect = "creep"};
  h.gain = 50, h.free_parameters = 2;
  CHECK(h.evidence(1000) == test::approx(50 - std::log(1000.0)));
}
