// SPDX-License-Identifier: MIT
// On a modal string, which shares nothing with the model that is fitted.
#include <rosin/diagnose/pluck_diagnosis.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"
#include "support/causal_string.hpp"

#include <rosin/simulate/burdened_signals.hpp>

#include <doctest/doctest.h>

#include <random>

namespace {

rosin::outcome<rosin::pluck_diagnosis> look(const std::vector<rosin::pluck_take>& takes, const rosin::pluck_take& held,
                                            const std::array<rosin::modal_termination, 2>& ends = {}, int own_losses = 0) {
  return rosin::diagnose_plucks(takes, {held}, {.fundamental_Hz = 660, .ends = ends},
                                {.internal_loss = false, .own_losses = own_losses}, [&](const rosin::pluck_fit_result& fit) {
                                  const rosin::string_facts facts{fit.value[0], takes[0].rate_Hz, fit.limits.stop_Hz, 0.175,
                                                                  0.314,        takes.size()};
                                  auto all = rosin::catalogue_without({"bending-stiffness"}, facts, fit.limits);
                                  // Scans over frequency and place, and searches for poles, are what takes long; here they are not what is tested.
                                  std::erase_if(all, [](const rosin::pluck_effect& e) {
                                    return e.starts.size() > 20 || (e.at_end && e.name != "clamped-end") || e.strength < -1;
                                  });
                                  return all;
                                });
}

}  // namespace

TEST_CASE("a string as declared is left alone, and predicted to the noise") {
  const auto d = look({test::modal_pluck(1, 1), test::modal_pluck(0.5, 2)}, test::modal_pluck(0.75, 3));
  REQUIRE_MESSAGE(d, d.error());
  CHECK_FALSE(d->mismatched);
  CHECK(d->best.effects.empty());
  CHECK(d->before < 1.2 * d->floor);
  CHECK(d->before > 0.8 * d->floor);
}

TEST_CASE("a string whose loss is causal is no mismatch, and what is hidden beside it is found" * doctest::test_suite("long")) {
  for (const double leaks : {0.0, 0.004}) {
    CAPTURE(leaks);
    std::mt19937_64 random{5};
    std::normal_distribution<double> noise{0, 3e-4};
    std::vector<rosin::pluck_take> takes;
    for (const double force_N : {1.0, 0.5, 0.75}) {
      rosin::pluck_take take{
          .name = "causal " + std::to_string(takes.size()), .rate_Hz = 96e3, .strength_N = force_N, .position = 0.3};
      take.force_N = test::causal_string{.fundamental_Hz = 660, .quality = 500}.pluck(0.3, 0.004, 96e3, 12000, {44e3, 47e3});
      for (std::size_t i = 0; i < 12000; ++i) {
        const double near = force_N * take.force_N[0][i], far = force_N * take.force_N[1][i];
        take.force_N[0][i] = near + leaks * far + noise(random), take.force_N[1][i] = far + leaks * near + noise(random);
      }
      takes.push_back(take);
    }
    const auto d = look({takes[0], takes[1]}, takes[2]);
    REQUIRE_MESSAGE(d, d.error());
    CHECK(d->data.options.causality);
    CHECK(d->explained);
    CHECK(d->mismatched == (leaks > 0));
    CHECK(d->after < 1.2 * d->floor);
    CHECK(d->best.value[rosin::pluck_layout::causality] == test::approx(1).epsilon(0.01));
    REQUIRE(d->best.effects.size() == (leaks > 0 ? 1 : 0));
    if (leaks == 0) continue;
    CHECK(d->best.effects[0].id() == "channel-crosstalk");
    CHECK(d->best.value[d->data.layout.size()] == test::approx(leaks).epsilon(0.05));
  }
}

TEST_CASE("modes that lose each in its own way are no mismatch, and what is hidden beside them is found" *
          doctest::test_suite("long")) {
  auto rig = test::plucked_rig;
  rig.uneven = {0.15, 5};
  for (const double leaks : {0.0, 0.01}) {
    CAPTURE(leaks);
    auto takes = test::recorded_plucks({1, 0.5, 0.75}, [&](double force_N) {
      auto made = rosin::simulate_pluck(rig, {.position = 0.3, .force_N = force_N, .release_s = 0.004, .duration_s = 0.1});
      for (std::size_t i = 0; made && i < made->force_near_N.size(); ++i) {
        const double near = made->force_near_N[i], far = made->force_far_N[i];
        made->force_near_N[i] = near + leaks * far, made->force_far_N[i] = far + leaks * near;
      }
      return made;
    });
    const auto held = test::last_of(takes);
    const auto d = look(takes, held.front(), {}, 70);
    REQUIRE_MESSAGE(d, d.error());
    CHECK(d->explained);
    CHECK(d->mismatched == (leaks > 0));
    CHECK(d->after < 1.2 * d->floor);
    CHECK(d->best.value[d->data.layout.loss_scatter()] == test::approx(0.15).epsilon(0.3));
    REQUIRE(d->best.effects.size() == (leaks > 0 ? 1 : 0));
    if (leaks == 0) continue;
    CHECK(d->best.effects[0].id() == "channel-crosstalk");
    CHECK(d->best.values_of(0)[0] == test::approx(leaks).epsilon(0.02));
  }
}

TEST_CASE("a wire that lets go slowly is named, with its duration, and the pluck that was kept aside is predicted" *
          doctest::test_suite("long")) {
  constexpr double slow = 40e-6;
  const auto d = look({test::modal_pluck(1, 1, slow), test::modal_pluck(0.5, 2, slow)}, test::modal_pluck(0.75, 3, slow));
  REQUIRE_MESSAGE(d, d.error());
  REQUIRE(d->best.effects.size() == 1);
  CHECK(d->explained);
  CHECK(d->best.effects[0].id() == "slow-release");
  CHECK(d->best.values_of(0)[0] == test::approx(slow).epsilon(0.02));
  CHECK(d->before > 3 * d->floor);
  CHECK(d->after < 1.2 * d->floor);
  CHECK(d->mismatch.residual_over_noise > 2);
}

TEST_CASE("wires that let go over some microseconds, one longer than another, are in the model and have no name") {
  const auto d = look({test::modal_pluck(1, 1, 3.5e-6), test::modal_pluck(1, 2, 2.5e-6)}, test::modal_pluck(1, 3, 3e-6));
  REQUIRE_MESSAGE(d, d.error());
  REQUIRE(d->best.effects.size() == 1);
  CHECK((d->best.effects[0].name == "slow-release" || d->best.effects[0].name == "finite-pluck-width"));
  CHECK(d->is_ordinary(0));
  CHECK_FALSE(d->mismatched);
  CHECK(d->explained);
  CHECK(d->after < 1.05 * d->floor);
}

TEST_CASE("a loss that grows with frequency is none to the air of less than nothing" * doctest::test_suite("long")) {
  auto rig = test::plucked_rig;
  rig.string.loss.internal_s = 3e-8;
  auto takes = test::recorded_plucks({1, 0.5, 0.75}, [&](double force_N) {
    return rosin::simulate_pluck(rig, {.position = 0.3, .force_N = force_N, .release_s = 0.004, .duration_s = 0.1});
  });
  const auto held = test::last_of(takes);
  const auto d = rosin::diagnose_plucks(
      takes, held, {.fundamental_Hz = 660}, {.internal_loss = false}, [&](const rosin::pluck_fit_result& fit) {
        const rosin::string_facts facts{fit.value[0], takes[0].rate_Hz, fit.limits.stop_Hz, 0.175, 0.314, takes.size()};
        return std::vector<rosin::pluck_effect>{rosin::air_loss_effect(facts)};
      });
  REQUIRE_MESSAGE(d, d.error());
  CHECK(d->best.effects.empty());
  CHECK(d->mismatched);
  CHECK_FALSE(d->explained);
}

TEST_CASE(
    "an end that swallows what comes, and one that is heavy and softly held: each is found, and what the wire held comes out "
    "right" *
    doctest::test_suite("long")) {
  const auto& rig = test::plucked_rig;
  for (const bool heavy : {false, true}) {
    CAPTURE(heavy);
    rosin::rig_burden burden;
    if (heavy) burden.string.supports[1] = {0.05, 60, 20};
    else burden.string.ends[1].modes = {rosin::overdamped_mode(0.003, 40, 1e6)};
    auto takes = test::recorded_plucks({1, 0.5, 0.75}, [&](double force_N) {
      return rosin::simulate_pluck(rig, burden, {.position = 0.3, .force_N = force_N, .release_s = 0.004, .duration_s = 0.15});
    });
    const auto held = test::last_of(takes);
    const auto d = rosin::diagnose_plucks(
        takes, held, {.fundamental_Hz = 660}, {.internal_loss = false}, [&](const rosin::pluck_fit_result& fit) {
          const rosin::string_facts facts{fit.value[0],        takes[0].rate_Hz, fit.limits.stop_Hz, rig.string.impedance_Ns_m(),
                                          rig.string.length_m, takes.size()};
          std::vector<rosin::pluck_effect> all{rosin::air_loss_effect(facts), rosin::crosstalk_effect(facts)};
          for (const int end : {0, 1}) {
            all.push_back(rosin::resistive_end_effect(facts, end));
            all.push_back(rosin::support_resonance_effect(facts, end));
            std::erase_if(all.back().starts, [](const auto& start) { return !(start[1] == 25 && start[0] < 200); });
          }
          return all;
        });
    REQUIRE_MESSAGE(d, d.error());
    REQUIRE(d->best.effects.size() == 1);
    CHECK(d->best.effects[0].id() == (heavy ? "support-resonance@far" : "resistive-end@far"));
    CHECK(d->explained);
    CHECK(d->before > 10 * d->floor);
    CHECK(d->after < 1.05 * d->floor);
    const Eigen::VectorXd found = d->best.value.tail(d->best.value.size() - d->data.layout.size()).array().exp();
    CHECK((heavy ? found[0] / 60 : found[0] * rig.string.impedance_Ns_m() / 0.003) == test::approx(1).epsilon(0.003));
    CHECK(found[1] == test::approx(heavy ? 20 : 40).epsilon(0.02));
  }
}

TEST_CASE("a stiffness that was not declared is found behind a sensor that rings, and then the sensor" *
          doctest::test_suite("long")) {
  const auto layout = test::two_plucks({});
  const rosin::string_facts facts{659.69, 128e3, 60e3, 0.175, 0.314, 2};
  auto ringing = rosin::sensor_resonance_effect(facts, 1);
  std::erase_if(ringing.starts, [](const auto& start) { return start[1] != 12; });
  const Eigen::VectorXd v = test::values_of(layout, {std::log(20966.0), std::log(10.2)});
  std::vector<rosin::pluck_take> takes{test::scene_pluck(layout, {ringing}, v, 0, 3e-4, 1),
                                       test::scene_pluck(layout, {ringing}, v, 1, 3e-4, 2)};
  takes[1].strength_N = 0.5;
  const auto d = rosin::diagnose_plucks(
      takes, {}, {.fundamental_Hz = 660}, {.stiffness = false, .internal_loss = false}, [&](const rosin::pluck_fit_result&) {
        return std::vector<rosin::pluck_effect>{rosin::bending_stiffness_effect(facts), ringing};
      });
  REQUIRE_MESSAGE(d, d.error());
  REQUIRE(d->best.effects.size() == 2);
  CHECK(d->explained);
  for (const rosin::pluck_effect& e : d->best.effects) CHECK((e.id() == "bending-stiffness" || e.id() == "sensor-resonance@far"));
  CHECK(d->after < 1.05 * d->floor);
}

TEST_CASE("a channel that comes a little late is found beside a bead that leaves a hundred thousand times as much" *
          doctest::test_suite("long")) {
  const auto layout = test::two_plucks({});
  const rosin::string_facts facts{659.69, 128e3, 60e3, 0.175, 0.314, 2};
  auto bead = rosin::point_mass_effect(facts);
  const std::vector<rosin::pluck_effect> both{bead, rosin::skew_effect(facts)};
  constexpr double place = 0.526, mass_kg = 8e-6, late_s = 0.7e-6;
  std::erase_if(bead.starts, [](const auto& start) { return std::abs(start[0] - place) > 0.06; });
  std::vector<double> values{place, bead.parameters[1].logarithmic ? std::log(mass_kg) : mass_kg};
  for (std::size_t k = values.size(); k < bead.parameters.size(); ++k) values.push_back(0);
  values.push_back(late_s);
  const Eigen::VectorXd v = test::values_of(layout, values);
  std::vector<rosin::pluck_take> takes{test::scene_pluck(layout, both, v, 0, 3e-4, 1),
                                       test::scene_pluck(layout, both, v, 1, 3e-4, 2)};
  takes[1].strength_N = 0.5;
  const auto d =
      rosin::diagnose_plucks(takes, {}, {.fundamental_Hz = 660}, {.internal_loss = false}, [&](const rosin::pluck_fit_result&) {
        return std::vector<rosin::pluck_effect>{bead, rosin::skew_effect(facts), rosin::crosstalk_effect(facts)};
      });
  REQUIRE_MESSAGE(d, d.error());
  REQUIRE(d->best.effects.size() == 2);
  CHECK(d->explained);
  for (const rosin::pluck_effect& e : d->best.effects) CHECK((e.id() == "point-mass" || e.id() == "channel-skew"));
  CHECK(d->after < 1.05 * d->floor);
}

TEST_CASE("a clock that wavers is a mismatch, though nothing of it shows at the partials, and nothing in the catalogue is it") {
  const auto wavering = [](double force_N, std::uint64_t seed) {
    auto take = test::modal_pluck(force_N, seed);
    for (auto& channel : take.force_N) {
      const std::vector<double> steady = channel;
      for (std::size_t i = 1; i + 1 < steady.size(); ++i) {
        const double late = 0.3 * std::sin(2 * std::numbers::pi * 97 * static_cast<double>(i) / take.rate_Hz);  // of a sample
        channel[i] += late * (steady[i + 1] - steady[i - 1]) / 2;
      }
    }
    return take;
  };
  const auto d = look({wavering(1, 1), wavering(0.5, 2)}, wavering(0.75, 3));
  REQUIRE_MESSAGE(d, d.error());
  CHECK(d->mismatched);
  CHECK_FALSE(d->explained);
  CHECK(d->before > 3 * d->floor);
  CHECK(d->mismatch.residual_over_noise > 3);
}

TEST_CASE("ends that are known to move are part of the declared model: nothing is missing, or what is besides" *
          doctest::test_suite("long")) {
  const double impedance = test::plucked_rig.string.impedance_Ns_m();
  rosin::rig_burden burden;
  burden.string.ends[1].modes = {{2400, 12, impedance / 0.01}, {470, 30, impedance / 0.1}};
  auto roughly = burden.string.ends;  // as a measurement may have it
  roughly[1].modes[0].frequency_Hz *= 1.005, roughly[1].modes[0].q *= 0.9, roughly[1].modes[1].per_mass_per_s *= 1.05;
  const auto pluck = [&](double force_N, std::uint64_t seed, double release_duration_s) {
    const auto made = rosin::simulate_pluck(
        test::plucked_rig, burden,
        {.position = 0.3, .force_N = force_N, .release_s = 0.004, .release_duration_s = release_duration_s, .duration_s = 0.06});
    REQUIRE_MESSAGE(made, made.error());
    return test::recorded(*made, force_N, seed);
  };
  for (const double slow : {0.0, 40e-6}) {
    CAPTURE(slow);
    const auto d = look({pluck(1, 1, slow), pluck(0.5, 2, slow)}, pluck(0.75, 3, slow), slow > 0 ? burden.string.ends : roughly);
    REQUIRE_MESSAGE(d, d.error());
    CHECK(d->explained);
    CHECK(d->mismatched == (slow > 0));
    REQUIRE(d->best.effects.size() == (slow > 0 ? 1 : 0));
    CHECK(d->after < 1.2 * d->floor);
    if (slow > 0) CHECK(d->best.effects[0].id() == "slow-release");
    CHECK(d->data.layout.ends(d->best.value)[1].modes[0].frequency_Hz == test::approx(2400).epsilon(3e-4));
  }
}

TEST_CASE(
    "ends that hold the string against turning are told from a shorter or stiffer string: one of them, both, and how firmly" *
    doctest::test_suite("long")) {
  struct clamped {
    std::array<double, 2> clamping;
    std::string id;
  };
  for (const clamped& c : {clamped{{1, 1}, "clamped-end both"}, {{0, 0.5}, "clamped-end@far"}}) {
    CAPTURE(c.id);
    auto rig = test::plucked_rig;
    rig.string.bending_stiffness_Nm2 *= 3;
    rosin::rig_burden burden;
    burden.string.clamping = c.clamping;
    const auto pluck = [&](double force_N, std::uint64_t seed) {
      const auto made =
          rosin::simulate_pluck(rig, burden, {.position = 0.3, .force_N = force_N, .release_s = 0.004, .duration_s = 0.06});
      REQUIRE_MESSAGE(made, made.error());
      return test::recorded(*made, force_N, seed);
    };
    const auto d = look({pluck(1, 1), pluck(0.5, 2)}, pluck(0.75, 3));
    REQUIRE_MESSAGE(d, d.error());
    CHECK(d->explained);
    CHECK(d->before > 1.5 * d->floor);
    CHECK(d->after < 1.2 * d->floor);
    REQUIRE(d->best.effects.size() == 1);
    CHECK(d->best.effects[0].id() == c.id);
    const auto at = d->data.layout.size();
    CHECK(std::abs(d->best.value[at] - c.clamping[1]) < 3 * d->best.sd[at] + 1e-6);
    CHECK(d->best.sd[at] < 0.25);
  }
}

TEST_CASE("three that hide each other: neither of the last two takes away enough, both together do; and they come first" *
          doctest::test_suite("long")) {
  rosin::modal_rig rig;
  rig.string = {.length_m = 0.479,
                .tension_N = 83.92,
                .fundamental_Hz = 440.9,
                .bending_stiffness_Nm2 = 2.15e-5,
                .loss = {.quality = 1200, .air_sqrt_Hz = 4.4e-3}};
  rosin::rig_burden burden;
  burden.detuning = -1.167e-3, burden.coupling = -0.0523;
  burden.sensors.quadratic_per_N[1] = 0.055;
  std::vector<rosin::pluck_take> takes;
  for (const auto& [force_N, position] : {std::pair{1.0, 0.206}, std::pair{0.5, 0.277}, std::pair{0.75, 0.133}}) {
    takes.push_back(test::recorded(
        *rosin::simulate_pluck(rig, burden, {.position = position, .force_N = force_N, .release_s = 0.004, .duration_s = 0.11}),
        force_N, takes.size()));
    takes.back().position = position + 0.001;
  }
  const std::vector held{takes.back()};
  takes.pop_back();
  const auto d = rosin::diagnose_plucks(
      takes, held, {.fundamental_Hz = 441}, {.internal_loss = false}, [&](const rosin::pluck_fit_result& fit) {
        const rosin::string_facts facts{fit.value[0], takes[0].rate_Hz, fit.limits.stop_Hz, 0.1987, 0.479, takes.size()};
        auto all = rosin::catalogue_without({}, facts, fit.limits);
        std::erase_if(all, [](const rosin::pluck_effect& e) {
          return e.name != "second-polarization" && e.name != "air-loss" && e.id() != "sensor-nonlinearity@far";
        });
        for (auto& e : all)  // a scan over detunings is what takes long
          if (e.name == "second-polarization")
            std::erase_if(e.starts, [](const auto& start) { return std::abs(start[0] + 1.2e-3) > 2e-4; });
        return all;
      });
  REQUIRE_MESSAGE(d, d.error());
  CHECK(d->explained);
  std::vector<std::string> names;
  for (const auto& e : d->best.effects) names.push_back(e.name);
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"air-loss", "second-polarization", "sensor-nonlinearity"});
  CHECK(d->after < 1.1 * d->floor);
  CHECK(d->ranking.front().ids.size() == 3);
  CHECK(d->ranking[1].log_evidence < -1000);
}
