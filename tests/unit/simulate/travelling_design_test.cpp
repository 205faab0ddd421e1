// SPDX-License-Identifier: MIT
#include <rosin/simulate/travelling_design.hpp>

#include "support/approx.hpp"
#include "support/violin_e_string.hpp"

#include <doctest/doctest.h>

namespace simulate_travelling_design {

namespace {

const rosin::modal_rig& rig = test::violin_e_string;

}  // namespace

TEST_CASE("a round of the whole string has the poles of all partials, wherever the contact is") {
  const auto design = rosin::design_travelling_wave(rig, {0.1, 0.2}, {.oversampling = 2, .band_Hz = 40e3});
  REQUIRE_MESSAGE(design, design.error());
  const auto& k = design->kernels;
  rosin::wave_loop loop;
  for (std::size_t j = 0; j < 2; ++j) loop.echo[j] = {static_cast<int>(k.loop[j].first), k.loop[j].taps};
  for (const auto& mode : rosin::transverse_modes(rig.string, 30e3)) {
    const auto p = rosin::pole_near(loop, mode.pole(), k.step_s);
    CHECK(p.imag() == test::approx(mode.pole().imag()).epsilon(1e-6));
    CHECK(p.real() == test::approx(mode.pole().real()).epsilon(3e-3));
  }
}

TEST_CASE("nothing is asked for before it is known") {
  for (const auto& range : {rosin::contact_range{0.05, 0.06}, {0.3, 0.5}, {0.2, 0.9}}) {
    CAPTURE(range.least);
    const auto design = rosin::design_travelling_wave(rig, range, {.oversampling = 2, .band_Hz = 40e3});
    REQUIRE_MESSAGE(design, design.error());
    const auto& k = design->kernels;
    CHECK(k.ahead() >= 1);
    CHECK(k.block() <= k.way[0].first() + k.way[1].first());
    CHECK(k.loop_block() % k.block() == 0);
    CHECK(k.loop_block() <= std::min(k.loop[0].first, k.loop[1].first));
  }
}

TEST_CASE("where a contact that sticks would make the string grow the kernels are refused; at a finer rate it does not") {
  auto string = rig;
  string.torsion = {};
  string.string.loss.quality = 3000;
  CHECK(rosin::design_travelling_wave(string, {0.03, 0.05}, {.oversampling = 4}).error().find("stable") != std::string::npos);
  const auto design = rosin::design_travelling_wave(string, {0.03, 0.05}, {.oversampling = 8});
  REQUIRE_MESSAGE(design, design.error());
  const double period = 1 / (660 * design->kernels.step_s);
  for (const double position : {0.03, 0.0417, 0.05})
    CHECK(rosin::detail::largest_stuck_gain(design->kernels, position, period) < 1);
}

TEST_CASE("ways off the string, too near an end, and ends that a rate cannot hold are refused with the reason") {
  CHECK(rosin::design_travelling_wave(rig, {0.1, 1.2}).error().find("position") != std::string::npos);
  CHECK(rosin::design_travelling_wave(rig, {0.003, 0.2}).error().find("end") != std::string::npos);
  CHECK(rosin::design_travelling_wave(rig, {0.3, 0.2}).error().find("beyond") != std::string::npos);
  auto low = rig;
  low.string.fundamental_Hz = 41;
  CHECK(rosin::design_travelling_wave(low, {0.1, 0.9}).error().find("too long") != std::string::npos);
  std::array<rosin::modal_termination, 2> ends{};
  ends[1].modes = {{.frequency_Hz = 480e3, .q = 10, .per_mass_per_s = 1}};
  CHECK(rosin::design_travelling_wave(rig, {0.1, 0.2}, {.oversampling = 2}, ends).error().find("termination") !=
        std::string::npos);
}

}  // namespace simulate_travelling_design
