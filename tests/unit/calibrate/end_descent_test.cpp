// SPDX-License-Identifier: MIT
#include <rosin/calibrate/end_descent.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"
#include "support/plucked_ends.hpp"

TEST_CASE("from a mode that is somewhat off to the one that is there; the noise is found between the partials") {
  const test::moving_end_rig rig{test::steel_e, {std::vector<test::end_mode>{{1200, 25, 0.01}}, std::vector<test::end_mode>{}}};
  const auto takes = test::pluck_at(rig, {0.3}, 0.1);
  rosin::end_descent d(takes, test::about_steel_e, {}, {}, *rosin::find_start(takes, test::about_steel_e));
  d.look(1.5, 6e3, 20);
  d.look(1.5, d.limits().pass_Hz, 20);
  const double rigid = d.now().cost, before = d.misfit();
  d.insert({0, {1300, 15, 10}, 0});
  d.settle(30);
  d.look(5, d.limits().pass_Hz, 20);
  CHECK(d.now().cost < rigid);
  CHECK(d.misfit() < 1.5);
  CHECK(before > d.misfit());
  const rosin::admittance_mode m = d.model().mode(d.value(), 0);
  CHECK(m.frequency_Hz == test::approx(1200).epsilon(0.003));
  CHECK(test::steel_e.impedance_Ns_m() / m.per_mass_per_s == test::approx(0.01).epsilon(0.03));
  CHECK(d.noise()[0] == test::approx(3e-4).epsilon(0.15));
  const auto kept = d.keep();
  d.erase(0);
  CHECK(d.model().size() == d.model().layout.size());
  d.restore(kept);
  CHECK(d.value() == kept.v);
}
