// SPDX-License-Identifier: MIT
#include <rosin/calibrate/end_fit.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"
#include "support/plucked_ends.hpp"

namespace {

double mass_kg(const rosin::fitted_mode& m) { return test::steel_e.impedance_Ns_m() / m.mode.per_mass_per_s; }

}  // namespace

TEST_CASE("a mode at either end, found from two plucks with its mass, and the string beside it") {
  const test::moving_end_rig rig{test::steel_e,
                                 {std::vector<test::end_mode>{{900, 30, 0.004}}, std::vector<test::end_mode>{{2700, 15, 0.012}}}};
  const auto found = rosin::fit_ends(test::pluck_at(rig, {0.3, 0.2}, 0.12), test::about_steel_e);
  REQUIRE(found);
  CHECK(found->plucks.value[0] == test::approx(659.69).epsilon(1e-5));
  CHECK(found->plucks.misfit < 2);
  int heavy = 0;
  for (const auto& m : found->modes)
    for (const test::end_mode& t : rig.ends[m.end])
      if (std::abs(m.mode.frequency_Hz / t.frequency_Hz - 1) < 0.05) {
        ++heavy;
        CHECK(std::abs(m.mode.frequency_Hz - t.frequency_Hz) < 4 * m.frequency_sd_Hz);
        CHECK(std::abs(m.mode.q - t.q) < 4 * m.q_sd);
        CHECK(std::abs(std::log(mass_kg(m) / t.mass_kg)) < 4 * m.per_mass_relative_sd);
        CHECK_FALSE(m.end_uncertain);
      }
  CHECK(heavy == 2);
}

TEST_CASE("ends that do not move are found rigid, or all but") {
  const auto found = rosin::fit_ends(test::pluck_at({test::steel_e, {}}, {0.3}, 0.1), test::about_steel_e);
  REQUIRE(found);
  for (const auto& m : found->modes) CHECK(mass_kg(m) > 1);
  CHECK(found->modes.size() < 2);
}

TEST_CASE("what is declared of an end is taken as it stands") {
  const test::moving_end_rig rig{test::steel_e, {std::vector<test::end_mode>{{900, 30, 0.004}}, std::vector<test::end_mode>{}}};
  const double Z = test::steel_e.impedance_Ns_m();
  rosin::end_options how;
  how.free_ends = {false, false};
  how.known[0] = rosin::admittance_mode{900, 30, Z / 0.004};
  const auto takes = test::pluck_at(rig, {0.3}, 0.1);
  const auto found = rosin::fit_ends(takes, test::about_steel_e, {}, how);
  REQUIRE(found);
  CHECK(found->modes.empty());
  CHECK(found->plucks.misfit < 2);
  CHECK(found->plucks.value[0] == test::approx(659.69).epsilon(1e-5));
  how.known[0] = {};
  const auto rigid = rosin::fit_ends(takes, test::about_steel_e, {}, how);
  CHECK((!rigid || rigid->plucks.misfit > 20));
}
