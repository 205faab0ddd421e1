// SPDX-License-Identifier: MIT
// On a modal string, which shares nothing with the model that is fitted.
#include <rosin/diagnose/pluck_search.hpp>

#include "plucked.hpp"

#include <rosin/diagnose/pluck_diagnosis.hpp>
#include <rosin/simulate/burdened_signals.hpp>

#include <doctest/doctest.h>

namespace {

/// Three plucks of a rig at one place, through a high-pass if there is one, the third set aside; asked for these effects only.
rosin::outcome<rosin::pluck_diagnosis> look_for(const std::vector<std::string>& names, const rosin::modal_rig& rig,
                                                const rosin::rig_burden& burden, double position, double ac_coupled_Hz,
                                                bool stiffness_declared) {
  std::vector<rosin::pluck_take> takes;
  for (const double force_N : {1.0, 0.5, 0.75}) {
    takes.push_back(test::recorded(
        *rosin::simulate_pluck(rig, burden, {.position = position, .force_N = force_N, .release_s = 0.004, .duration_s = 0.14}),
        force_N, takes.size(), ac_coupled_Hz));
    takes.back().position = position + 0.001;
  }
  const std::vector held{takes.back()};
  takes.pop_back();
  return rosin::diagnose_plucks(
      takes, held, {.fundamental_Hz = rig.string.fundamental_Hz + 0.05},
      {.stiffness = stiffness_declared, .internal_loss = false}, [&](const rosin::pluck_fit_result& fit) {
        const rosin::string_facts facts{fit.value[0],        takes[0].rate_Hz, fit.limits.stop_Hz, rig.string.impedance_Ns_m(),
                                        rig.string.length_m, takes.size()};
        auto all = rosin::catalogue_without({}, facts, fit.limits);
        std::erase_if(all, [&](const auto& e) { return std::find(names.begin(), names.end(), e.name) == names.end(); });
        return all;
      });
}

/// An explanation by two effects, both of these names.
void check_explained_by(const rosin::pluck_diagnosis& d, const std::string& one, const std::string& other) {
  REQUIRE(d.best.effects.size() == 2);
  CHECK(d.explained);
  for (const rosin::pluck_effect& e : d.best.effects) CHECK((e.name == one || e.name == other));
}

/// A string that is stretched, behind a leak from channel to channel: both are found, whatever else is asked for.
void check_stretching_and_leakage(const rosin::string_parameters& string, double axial_stiffness_N, double crosstalk,
                                  double position, std::vector<std::string> names) {
  rosin::rig_burden burden;
  burden.string.axial_stiffness_N = axial_stiffness_N;
  burden.sensors.crosstalk = crosstalk;
  names.insert(names.end(), {"channel-crosstalk", "tension-modulation"});
  const auto d = look_for(names, {.string = string}, burden, position, 0, true);
  REQUIRE_MESSAGE(d, d.error());
  check_explained_by(*d, "channel-crosstalk", "tension-modulation");
  CHECK(d->after < 1.2 * d->floor);
}

}  // namespace

TEST_CASE("an effect whose model holds for the first periods only, and that nothing speaks for, leaves a string as declared" *
          doctest::test_suite("long")) {
  const auto d = look_for({"tension-modulation"}, test::plucked_rig, {}, 0.3, 0, true);
  REQUIRE_MESSAGE(d, d.error());
  CHECK_FALSE(d->mismatched);
  CHECK(d->explained);
  CHECK(d->best.effects.empty());
  CHECK_FALSE(d->best.falls_short());
}

TEST_CASE("a string that its own motion stretches is found behind a high-pass, which hides how much of the mismatch is left" *
          doctest::test_suite("long")) {
  const rosin::modal_rig rig{.string = {.length_m = 0.3073,
                                        .tension_N = 52.93,
                                        .fundamental_Hz = 362.67,
                                        .bending_stiffness_Nm2 = 6.31e-5,
                                        .loss = {.quality = 1250}}};
  rosin::rig_burden burden;
  burden.string.axial_stiffness_N = 10.8e3;
  const auto d = look_for({"ac-coupling", "tension-modulation", "massive-end"}, rig, burden, 0.3, 5.33, true);
  REQUIRE_MESSAGE(d, d.error());
  check_explained_by(*d, "ac-coupling", "tension-modulation");
  CHECK(d->after < 1.2 * d->floor);
}

TEST_CASE("stretching and leakage hide each other, and what was found first is neither: the search begins anew without it" *
          doctest::test_suite("long")) {
  check_stretching_and_leakage({.length_m = 0.3266,
                                .tension_N = 85.13,
                                .fundamental_Hz = 721.54,
                                .bending_stiffness_Nm2 = 4.59e-5,
                                .loss = {.quality = 1413}},
                               9394, -0.0213, 0.3506, {"support-resonance"});
}

TEST_CASE("stretching hidden by a leak, which is clear in the first periods only: the search begins anew in them" *
          doctest::test_suite("long")) {
  check_stretching_and_leakage({.length_m = 0.3234,
                                .tension_N = 90.87,
                                .fundamental_Hz = 839.43,
                                .bending_stiffness_Nm2 = 5.03e-5,
                                .loss = {.quality = 974}},
                               11800, 0.013, 0.3385, {"support-resonance", "massive-end", "second-polarization"});
}

TEST_CASE("what a bead's model is off by is no loss, though the noise turns out to be little once the stiffness is found" *
          doctest::test_suite("long")) {
  const rosin::modal_rig rig{.string = {.length_m = 0.3307,
                                        .tension_N = 54.18,
                                        .fundamental_Hz = 498.34,
                                        .bending_stiffness_Nm2 = 6.06e-5,
                                        .loss = {.quality = 1057}}};
  rosin::rig_burden burden;
  burden.string.loads = {{0.5826, 8e-6, 0, 0}};
  const auto d = look_for({"point-mass", "bending-stiffness", "frequency-dependent-loss"}, rig, burden, 0.1503, 0, false);
  REQUIRE_MESSAGE(d, d.error());
  check_explained_by(*d, "point-mass", "bending-stiffness");
}

TEST_CASE(
    "searches in the same recordings remember what each effect does alone, and give up after a first one that leaves too much" *
    doctest::test_suite("long")) {
  rosin::rig_burden burden;
  burden.sensors.crosstalk = 0.02, burden.sensors.skew_s = 3e-6;
  const auto takes = test::recorded_plucks({1, 0.6}, [&](double force_N) {
    return rosin::simulate_pluck(test::plucked_rig, burden,
                                 {.position = 0.3, .force_N = force_N, .release_s = 0.004, .duration_s = 0.04});
  });
  const rosin::pluck_guess guess{.fundamental_Hz = 660};
  const rosin::pluck_options options{.internal_loss = false};
  const auto declared = rosin::fit_plucks(takes, guess, options, 0.95);
  REQUIRE_MESSAGE(declared, declared.error());
  const rosin::string_facts facts{declared->value[0], takes[0].rate_Hz, declared->limits.stop_Hz, 0.175, 0.314, takes.size()};
  const std::vector all{rosin::crosstalk_effect(facts), rosin::skew_effect(facts)};
  const rosin::pluck_diagnosis plain{
      {takes, guess, options, declared->layout}, *declared, {}, {}, {}, {}, {}, {}, false, true, 0, 0, 0, {}};

  rosin::detail::search_memory memory;
  const auto both = rosin::detail::searched(plain, all, 3, memory).first;
  REQUIRE(both.best.effects.size() == 2);
  REQUIRE(memory.first.size() == 2);
  CHECK(memory.first_leaves() > 10);
  CHECK(memory.first.front().effects.back().name == both.best.effects.front().name);

  // Without the better one: what the other does alone is remembered, or tried where it is not.
  const auto other = memory.first.back().effects.back();
  rosin::detail::search_memory of_better{.first = {memory.first.front()}};
  const double left = memory.first.back().quality.inflation();
  for (auto* known : {&memory, &of_better}) {
    const auto less = rosin::detail::searched(plain, {other}, 3, *known).first;
    REQUIRE(less.best.effects.size() == 1);
    CHECK(less.best.effects[0].name == other.name);
    CHECK(less.best.quality.inflation() < 1.01 * left);
  }
  CHECK(memory.first.size() == 2);

  rosin::detail::search_memory brief{.stop_above = 0.9 * memory.first_leaves()};
  CHECK(rosin::detail::searched(plain, all, 3, brief).first.best.effects.size() == 1);
  rosin::detail::search_memory patient{.stop_above = 1.1 * memory.first_leaves()};
  CHECK(rosin::detail::searched(plain, all, 3, patient).first.best.effects.size() == 2);
}
