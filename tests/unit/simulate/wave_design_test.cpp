// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_design.hpp>

#include "support/approx.hpp"
#include "support/middle_of.hpp"
#include "support/violin_e_string.hpp"

#include <doctest/doctest.h>

#include <rosin/simulate/wave_string.hpp>

namespace simulate_wave_design {

namespace {

const rosin::modal_rig& rig = test::violin_e_string;

}  // namespace

TEST_CASE("kernels fit together: nothing is asked for before it is known") {
  for (const double position : {0.05, 0.3, 0.8})
    for (const int oversampling : {1, 4}) {
      CAPTURE(position);
      CAPTURE(oversampling);
      const auto design = rosin::design_wave(rig, position, {.oversampling = oversampling, .band_Hz = 40e3});
      REQUIRE_MESSAGE(design, design.error());
      const auto& k = design->kernels;
      CHECK(k.block >= 1);
      CHECK(k.block % k.stride == 0);
      CHECK(k.fill.size() == static_cast<std::size_t>(k.stride));
      const auto soonest = std::min(k.echo[0].first, k.echo[1].first);
      if (k.stride == 1) CHECK(k.block <= std::min(soonest, k.direct.first));
      else CHECK(k.block / k.stride + k.fill_ahead() + (k.look_ahead() + k.stride) / k.stride - 1 <= soonest);
    }
}

TEST_CASE("a force that stays moves the string nowhere in the end") {
  for (const int oversampling : {1, 2}) {
    const auto design = rosin::design_wave(rig, 0.3, {.oversampling = oversampling, .band_Hz = 60e3});
    REQUIRE(design);
    rosin::wave_string<double> string{design->kernels};
    std::vector<double> place(static_cast<std::size_t>(0.4 / design->kernels.step_s));
    double now = 0;
    for (double& p : place) p = now += string.apply(1).centre_m_s * design->kernels.step_s;
    const auto all = std::span(place);  // it swings about where it will come to rest
    CHECK(test::middle_of(all.last(all.size() / 4)) == test::approx(rosin::static_compliance_m_N(rig.string, 0.3)).epsilon(0.01));
    CHECK(test::middle_of(all.first(all.size() / 4)) == test::approx(test::middle_of(all.last(all.size() / 4))).epsilon(0.01));
  }
}

TEST_CASE("impossible rigs and places are refused with the reason") {
  CHECK(rosin::design_wave(rig, 1.2).error().find("position") != std::string::npos);
  CHECK(rosin::design_wave(rig, 0.003).error().find("end") != std::string::npos);
  auto bad = rig;
  bad.torsion.quality = -3;
  CHECK(rosin::design_wave(bad, 0.3).error().find("torsion") != std::string::npos);
  bad = rig;
  bad.string.loss.quality = -100;
  CHECK(rosin::design_wave(bad, 0.3).error().find("Q") != std::string::npos);
  bad = rig;
  bad.string.tension_N = std::nan("");
  CHECK_FALSE(rosin::design_wave(bad, 0.3));
}

}  // namespace simulate_wave_design
