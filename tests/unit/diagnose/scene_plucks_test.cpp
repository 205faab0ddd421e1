// SPDX-License-Identifier: MIT
#include <rosin/diagnose/scene_plucks.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <rosin/diagnose/pluck_effects.hpp>

#include <doctest/doctest.h>

TEST_CASE("without effects a scene is the plain string of the calibration") {
  const auto layout = test::two_plucks({});
  const Eigen::VectorXd v = test::values_of(layout);
  const rosin::scene_plucks scene(layout, {0, 0}, {});
  const rosin::plain_plucks plain(layout, {0, 0});
  for (std::size_t part = 0; part < 2; ++part) {
    const auto a = scene.lines(v, 1, part, 0.005, {40e3, 50e3}, 200), b = plain.lines(v, 1, part, 0.005, {40e3, 50e3}, 200);
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t c = 0; c < 2; ++c) {
        CHECK(std::abs(a[i].pole - b[i].pole) < 1e-9);
        CHECK(std::abs(a[i].residue[c] - b[i].residue[c]) < 1e-9);
      }
  }
}

TEST_CASE("parameters of effects stand behind those of the plucks, in their units, and can be held") {
  const rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const auto layout = test::two_plucks({});
  const std::vector<rosin::pluck_effect> effects{rosin::sensor_resonance_effect(facts, 1), rosin::point_mass_effect(facts),
                                                 rosin::hum_effect(facts, 50)};
  const rosin::scene_plucks model(layout, {0, 0}, effects);
  CHECK(model.first_of(1) == layout.size() + 2);
  CHECK(model.name(layout.size()) == "frequency_Hz");
  CHECK(model.concerns(layout.size(), 0));
  CHECK(model.concerns(layout.size() + 7, 0));  // the first take's hum
  CHECK_FALSE(model.concerns(layout.size() + 7, 1));
  CHECK(model.is_free(layout.size() + 4));  // the bond of the mass
  CHECK_FALSE(rosin::scene_plucks(layout, {0, 0}, effects, rosin::freedom::no_corrections).is_free(layout.size() + 4));
  const rosin::scene_plucks held(layout, {0, 0}, effects, rosin::freedom::release_only);
  CHECK(held.is_free(layout.at(1, rosin::pluck_layout::release)));
  CHECK_FALSE(held.is_free(0));
  CHECK(held.is_free(layout.at(1, rosin::pluck_layout::offset_far)));
  Eigen::VectorXd v = test::values_of(layout, std::vector<double>(6 + effects[2].parameters.size(), 0.0));
  v[layout.size()] = std::log(18e3), v[layout.size() + 1] = std::log(9), v[layout.size() + 2] = 0.4,
  v[layout.size() + 3] = 1.75e-6;
  const auto scene = model.scene(v, 0);
  CHECK(scene.sensors[1].resonance_Hz == test::approx(18e3));
  CHECK(scene.scatterers[0].mass_s == test::approx(1e-5));
}

TEST_CASE("declared ends are in the scene, off by as much as the parameters say, and free once everything has settled") {
  std::vector<rosin::pluck_take> takes(2);
  for (auto& t : takes) t.position = 0.3;
  std::array<rosin::modal_termination, 2> ends;
  ends[1].modes = {{2400, 12, 40}};
  const rosin::pluck_layout layout(takes, {}, ends);
  Eigen::VectorXd v = test::values_of(layout);
  const Eigen::Index first = layout.first_of_ends();
  v[first + 2] = 0.02;
  const rosin::scene_plucks model(layout, {0, 0}, {});
  CHECK(model.scene(v, 0).ends[1].modes.at(0).per_mass_per_s == test::approx(40 * std::exp(0.02)));
  CHECK(model.scene(v, 0).ends[0].rigid());
  CHECK(model.is_free(first));
  CHECK_FALSE(rosin::scene_plucks(layout, {0, 0}, {}, rosin::freedom::no_corrections).is_free(first));
  // where a strength would stand
  CHECK_FALSE(rosin::scene_plucks(layout, {0, 0}, {}, rosin::freedom::release_only).is_free(first + 1));
}

TEST_CASE("behind a high-pass what was held is gone until the first wave comes, whatever the ends do") {
  const rosin::string_facts facts{
      .fundamental_Hz = 660, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const auto layout = test::two_plucks({});
  const double Z = facts.impedance_Ns_m, way_s = 0.3 / (2 * 660);
  for (const auto& which : {std::array{2.0, 0.0, 0.0}, std::array{60.0, 0.0, 0.0}, std::array{8.0, 0.003, 40.0},
                            std::array{0.5, 0.01, 5.0}, std::array{7.0, 0.01, 5.0}}) {
    const double cutoff = which[0], conductance = which[1], corner = which[2];
    CAPTURE(cutoff);
    CAPTURE(conductance);
    std::vector<rosin::pluck_effect> effects;
    std::vector<double> more;
    if (conductance > 0)
      effects.push_back(rosin::resistive_end_effect(facts, 1)), more = {std::log(conductance / Z), std::log(corner), 0.0};
    const rosin::scene_plucks direct(layout, {0, 0}, effects), coupled(layout, {cutoff, cutoff}, effects);
    Eigen::VectorXd v = test::values_of(layout, more);
    v[rosin::pluck_layout::inverse_quality] = 1e-5, v[rosin::pluck_layout::inharmonicity] = 1e-9;  // no wave comes early
    for (int c = 0; c < 2; ++c) v[layout.at(0, rosin::pluck_layout::offset_near + c)] = 0;
    const double released = layout.release_s(v, 0), newtons = std::exp(v[layout.at(0, rosin::pluck_layout::strength)]);
    const auto held = rosin::held_forces(direct.scene(v, 0), v[layout.position(0)]);
    for (std::size_t c = 0; c < 2; ++c)
      for (const double t : {0.3 * way_s, 0.6 * way_s}) {
        const auto at = [&](const rosin::scene_plucks& model) {
          double sum = 0;
          for (const auto& line : model.lines(v, 0, 1, released, {40e3, 50e3}, 200))
            sum += (line.residue[c] * std::exp(line.pole * t)).real();
          return sum;
        };
        CHECK(std::abs(at(coupled) - (at(direct) - newtons * held[c])) < 2e-4 * newtons);
      }
  }
}

TEST_CASE("poles of a string that carries something follow all of its loss, whatever was asked before") {
  const rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const auto layout = test::two_plucks({.causality = true, .uneven_loss = true});
  const std::vector<rosin::pluck_effect> effects{rosin::point_mass_effect(facts)};
  const rosin::scene_plucks model(layout, {0, 0}, effects);
  Eigen::VectorXd v = test::values_of(layout, std::vector<double>(effects[0].parameters.size(), 0.0));
  v[layout.size()] = 0.4, v[layout.size() + 1] = 1e-6;
  const auto lines_of = [&](const rosin::scene_plucks& m) { return m.lines(v, 0, 1, 0.005, {40e3, 50e3}, 40); };
  const auto before = lines_of(model);
  for (const Eigen::Index p :
       {Eigen::Index{rosin::pluck_layout::causality}, Eigen::Index{rosin::pluck_layout::loss_drag}, layout.first_of_uneven()}) {
    CAPTURE(p);
    v[p] += p == rosin::pluck_layout::causality ? 1.0 : 0.05;
    const auto now = lines_of(model), fresh = lines_of(rosin::scene_plucks(layout, {0, 0}, effects));
    REQUIRE(now.size() == fresh.size());
    for (std::size_t i = 0; i < now.size(); ++i) CHECK(std::abs(now[i].pole - fresh[i].pole) < 1e-6);
    CHECK(std::abs(now[10].pole - before[10].pole) > 1e-3);
  }
}
