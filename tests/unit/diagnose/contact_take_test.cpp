// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_take.hpp>

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

TEST_CASE("contact take: intervals, and evidence that counts parameters") {
  const rosin::contact_parameter p{"q", 10, 2};
  CHECK(p.ci95()[0] == test::approx(10 - 3.92));
  CHECK(p.ci95()[1] == test::approx(10 + 3.92));
  rosin::contact_hypothesis h{.effect = "creep"};
  h.gain = 50, h.free_parameters = 2;
  CHECK(h.evidence(1000) == test::approx(50 - std::log(1000.0)));
}
