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
