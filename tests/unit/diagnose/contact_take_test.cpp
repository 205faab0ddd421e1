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

TEST_CASE("contact take: intervals, and evidence that counts parameters") {
  const rosin::contact_parameter p{"q", 10, 2};
  CHECK(p.ci95()[0] == test::approx(10 - 3.92));
  CHECK(p.ci95()[1] == test::approx(10 + 3.92));
  rosin::contact_hypothesis h{.effect = "creep"};
  h.gain = 50, h.free_parameters = 2;
  CHECK(h.evidence(1000) == test::approx(50 - std::log(1000.0)));
}
