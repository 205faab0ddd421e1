// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pluck_candidates.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

TEST_CASE("of several effects the one that is there comes first" * doctest::test_suite("long")) {
  const rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const rosin::pluck_options options{.internal_loss = false};
  const auto layout = test::two_plucks(options);
  const Eigen::VectorXd truth = test::values_of(layout, {std::log(21e3), std::log(14.0)});
  rosin::scene_data data{{}, {.fundamental_Hz = 659.69}, options, layout};
  for (std::size_t t = 0; t < 2; ++t)
    data.takes.push_back(test::scene_pluck(layout, {rosin::sensor_resonance_effect(facts, 0)}, truth, t, 3e-4, 3 + t));
  rosin::scene_fit plain;
  plain.value = test::values_of(layout);
  rosin::pluck_effect resonance = rosin::sensor_resonance_effect(facts, 0);
  std::erase_if(resonance.starts, [](const auto& s) { return s[1] != 12; });
  const auto fits = rosin::one_more_effect(
      data, plain, {rosin::skew_effect(facts), rosin::crosstalk_effect(facts), resonance, rosin::slow_release_effect(facts)},
      false, {1e-3, 1e-3});
  REQUIRE(fits.size() > 1);
  CHECK(fits[0].effects[0].id() == "sensor-resonance@near");
  CHECK(std::exp(fits[0].value[layout.size()]) == test::approx(21e3).epsilon(1e-4));
  CHECK(std::exp(fits[0].value[layout.size() + 1]) == test::approx(14).epsilon(1e-3));
  data.options.threads = 3;
  const auto same = rosin::one_more_effect(
      data, plain, {rosin::skew_effect(facts), rosin::crosstalk_effect(facts), resonance, rosin::slow_release_effect(facts)},
      false, {1e-3, 1e-3});
  REQUIRE(same.size() == fits.size());
  for (std::size_t i = 0; i < fits.size(); ++i) CHECK(same[i].value == fits[i].value);
}

TEST_CASE(
    "which effect comes first does not depend on the unit that what is left is counted in: parameters cost a share of that") {
  const rosin::pluck_options options{.internal_loss = false};
  const auto layout = test::two_plucks(options);
  const rosin::string_facts facts{.fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .takes = 2};
  const rosin::pluck_effect hum = rosin::hum_effect(facts, 50);
  std::vector<double> lines(hum.parameters.size(), 0.0);
  lines[0] = std::log(50.0), lines[1] = 4e-3, lines[3] = 2e-3, lines[2 + hum.parameters.size() / 2] = 4e-3;
  rosin::scene_data data{{}, {.fundamental_Hz = 659.69}, options, layout};
  for (std::size_t t = 0; t < 2; ++t)
    data.takes.push_back(test::scene_pluck(layout, {hum}, test::values_of(layout, lines), t, 3e-4, 3 + t));
  rosin::scene_fit plain;
  plain.value = test::values_of(layout);
  for (const double unit_N : {3e-4, 3e-2}) {
    CAPTURE(unit_N);
    const auto fits = rosin::one_more_effect(data, plain, {rosin::crosstalk_effect(facts), hum}, false, {unit_N, unit_N});
    REQUIRE(!fits.empty());
    CHECK(fits[0].effects[0].name == "mains-hum");
  }
}

TEST_CASE("what no parameter scales is sought from little on: an effect that hardly shows is found all the same" *
          doctest::test_suite("long")) {
  const rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const rosin::pluck_options options{.internal_loss = false};
  const auto layout = test::two_plucks(options);
  constexpr std::array<double, 2> noise{1e-4, 1e-4};
  const auto found = [&](const rosin::pluck_effect& effect, double there) {
    rosin::scene_data data{{}, {.fundamental_Hz = 659.69}, options, layout};
    const double fitted = rosin::to_fitted(effect.parameters[0], there);
    for (std::size_t t = 0; t < 2; ++t)
      data.takes.push_back(test::scene_pluck(layout, {effect}, test::values_of(layout, {fitted}), t, noise[0], 3 + t));
    rosin::scene_fit plain;
    plain.value = test::values_of(layout);
    const auto fits = rosin::one_more_effect(data, plain, {effect}, false, noise);
    REQUIRE(fits.size() == 1);
    return fits[0].values_of(0)[0] / there;
  };
  CHECK(found(rosin::slow_release_effect(facts), 1.2e-6) == test::approx(1).epsilon(0.2));
  CHECK(found(rosin::pluck_width_effect(facts), 2e-4) == test::approx(1).epsilon(0.2));
  CHECK(found(rosin::ac_coupling_effect(facts), 0.05) == test::approx(1).epsilon(0.2));
}

TEST_CASE("a channel that comes late is no sensor that rings above the band, though that delays it as much") {
  const rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const rosin::pluck_options options{.internal_loss = false};
  const auto layout = test::two_plucks(options);
  rosin::scene_data data{{}, {.fundamental_Hz = 659.69}, options, layout};
  const auto tried = [&](const rosin::pluck_effect& hidden, const std::vector<double>& values) {
    data.takes.clear();
    for (std::size_t t = 0; t < 2; ++t)
      data.takes.push_back(test::scene_pluck(layout, {hidden}, test::values_of(layout, values), t, 3e-4, 3 + t));
    rosin::scene_fit plain;
    plain.value = test::values_of(layout);
    return rosin::one_more_effect(data, plain, {rosin::sensor_resonance_effect(facts, 1)}, false, {3e-4, 3e-4});
  };
  CHECK(tried(rosin::skew_effect(facts), {3.8e-6}).empty());
  const auto seen = tried(rosin::sensor_resonance_effect(facts, 1), {std::log(54e3), std::log(9.0)});
  REQUIRE(seen.size() == 1);
  CHECK(std::exp(seen[0].value[layout.size()]) == test::approx(54e3).epsilon(0.01));
}

TEST_CASE("a bead whose mirror image was taken for it is found where it is, once more than noise is left") {
  const rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  const rosin::pluck_options options{.internal_loss = false};
  const auto layout = test::two_plucks(options);
  const rosin::pluck_effect bead = rosin::point_mass_effect(facts);
  constexpr std::array<double, 2> noise{3e-4, 3e-4};
  rosin::scene_data data{{}, {.fundamental_Hz = 659.69}, options, layout};
  for (std::size_t t = 0; t < 2; ++t)
    data.takes.push_back(test::scene_pluck(layout, {bead}, test::values_of(layout, {0.285, 9e-6, 0, 0}), t, noise[0], 3 + t));
  const auto there = rosin::fit_scene(data, {bead}, test::values_of(layout, {0.714, 9e-6, 0, 0}), {{1000, 12, true}, {}}, noise);
  REQUIRE(there.value[layout.size()] > 0.5);
  const auto found = rosin::detail::rewound(data, there, noise);
  CHECK(found.value[layout.size()] == test::approx(0.285).epsilon(1e-4));
  CHECK(found.quality.inflation() < 1.5);
}
