// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pluck_effects.hpp>
#include <rosin/diagnose/scene_lines.hpp>
#include <rosin/diagnose/scene_plucks.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

#include <set>

namespace {

const rosin::string_facts guitar_facts{
    .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};

}  // namespace

TEST_CASE("every effect of the catalogue has a name of its own, starts inside its bounds, and changes what is recorded") {
  rosin::pluck_scene bare;
  bare.string = {659.69, 6.49e-5, {900, 0, 0}, 0};
  const auto plain = rosin::scene_lines(bare, 0.3, {40e3, 60e3}, 80, {});
  std::set<std::string> ids;
  for (const auto& e : rosin::pluck_effects(guitar_facts)) {
    CAPTURE(e.id());
    if (e.name != "mains-hum") CHECK(ids.insert(e.id()).second);
    REQUIRE_FALSE(e.starts.empty());
    for (const auto& start : e.starts) {
      REQUIRE(start.size() == e.parameters.size());
      for (std::size_t i = 0; i < start.size(); ++i) {
        CHECK(start[i] >= e.parameters[i].low);
        CHECK(start[i] <= e.parameters[i].high);
      }
    }
    rosin::pluck_scene with = bare;
    std::vector<double> strong = e.starts.front();
    if (e.name == "mains-hum") strong[1] = 0.1;
    e.apply(with, strong.data(), 0);
    if (e.name == "mains-hum") {
      CHECK(with.hum.front().amplitude_N[0].real() == 0.1);
      continue;
    }
    const auto poles = with.plain_string() ? std::vector<std::complex<double>>{} : rosin::string_poles(with, 60e3, 80);
    const auto lines = rosin::scene_lines(with, 0.3, {40e3, 60e3}, 80, poles);
    double change = lines.size() != plain.size() ? 1.0 : 0.0;
    for (std::size_t i = 0; i < std::min(lines.size(), plain.size()); ++i)
      for (std::size_t c = 0; c < 2; ++c)
        change += std::abs(lines[i].residue[c] - plain[i].residue[c]) +
                  std::abs(lines[i].pole - plain[i].pole) / std::abs(plain[i].pole);
    CHECK(change > 1e-9);
  }
  CHECK(ids.size() >= 18);
}

TEST_CASE("a high-pass that is hardly one changes nothing, once what the held string gave has left the offset") {
  const rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const auto layout = test::two_plucks({});
  const rosin::pluck_effect coupling = rosin::ac_coupling_effect(facts);
  const Eigen::VectorXd plain = test::values_of(layout);
  Eigen::VectorXd coupled = test::values_of(layout, {std::log(1e-4)});
  coupling.rebase(layout, coupled);
  const rosin::scene_plucks without(layout, {0, 0}, {}), with(layout, {0, 0}, {coupling});
  for (const std::size_t part : {0U, 1U})
    for (const double later : {0.0, 0.02})
      for (std::size_t c = 0; c < 2; ++c) {
        const double begin = part == 0 ? 0.0 : 0.006;
        const auto level = [&](const rosin::scene_plucks& model, const Eigen::VectorXd& v) {
          double sum = 0;
          for (const auto& line : model.lines(v, 1, part, begin, {50e3, 53e3}, 60))
            sum += (line.residue[c] * std::exp(line.pole * later)).real();
          return sum;
        };
        CHECK(level(with, coupled) == test::approx(level(without, plain)).epsilon(1e-3).scale(1));
      }
}

TEST_CASE("a support that lags still moves in phase with the force at its frequency, with the mass and quality that it says") {
  const auto support = rosin::support_resonance_effect(guitar_facts, 0);
  const auto admittance = [&](double lag_s, double f) {
    rosin::pluck_scene scene;
    const std::vector<double> v{2500, 10, 300, lag_s};
    support.apply(scene, v.data(), 0);
    return scene.ends[0].admittance({0, 2 * std::numbers::pi * f});
  };
  CHECK(std::abs(std::arg(admittance(1e-6, 2500))) < 1e-4);
  CHECK(std::abs(admittance(1e-6, 2500)) == test::approx(std::abs(admittance(0, 2500))).epsilon(2e-4));
  const auto reactance = [&](double lag_s) {
    return (1.0 / admittance(lag_s, 2500 * 1.01) - 1.0 / admittance(lag_s, 2500 * 0.99)).imag();
  };
  CHECK(reactance(1e-6) == test::approx(reactance(0)).epsilon(1e-3));
  const double fast_and_dull[]{50e3, 0.6, 300, 1e-5};
  rosin::pluck_scene scene;
  support.apply(scene, fast_and_dull, 0);
  CHECK(std::isfinite(std::abs(scene.ends[0].admittance({0, 3e5}))));
}

TEST_CASE("air takes in its boundary layer, and by its drag as well") {
  const auto e = rosin::air_loss_effect({.fundamental_Hz = 400});
  REQUIRE(e.parameters.size() == 2);
  CHECK(e.parameters[1].late);
  rosin::pluck_scene s;
  s.string.loss = {.quality = 1000};
  const std::array values{0.02, 0.04};
  e.apply(s, values.data(), 0);
  CHECK(s.string.loss.inverse_q(400) == test::approx(1e-3 + 0.02 / 20 + 0.04 / 400));
}
