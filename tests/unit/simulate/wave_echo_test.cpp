// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_echo.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_wave_echo {

namespace {

const rosin::string_parameters e_string{.length_m = 0.314,
                                        .tension_N = 72.5,
                                        .fundamental_Hz = 660,
                                        .bending_stiffness_Nm2 = 4.7e-5,
                                        .loss = {.quality = 1000, .internal_s = 2e-8}};

rosin::outcome<rosin::wave_loop> design(double position, double quality) {
  auto string = e_string;
  string.loss.quality = quality;
  const std::array<double, 2> delay{position / 660, (1 - position) / 660};
  const rosin::echo_plan plan{
      delay, string.stiffness_s2(), {50e3, 110e3}, 256e3, 1, rosin::poles_of(rosin::transverse_modes(string, 50e3))};
  return rosin::design_loop(plan, [&](std::size_t j) {
    return rosin::pinned_echo{{delay[j], string.stiffness_s2(), string.loss}, 660};
  });
}

}  // namespace

TEST_CASE("pitch within a hundredth of a cent and Q within one in a thousand of what is asked for, over the whole band") {
  for (const double position : {0.3, 0.1, 0.62})
    for (const double quality : {300.0, 1000.0, 5000.0}) {
      CAPTURE(position);
      CAPTURE(quality);
      const auto loop = design(position, quality);
      REQUIRE(loop);
      auto string = e_string;
      string.loss.quality = quality;
      for (const auto& mode : rosin::transverse_modes(string, 50e3)) {
        const auto wanted = mode.pole(), found = rosin::pole_near(*loop, wanted, 1 / 256e3);
        CHECK(std::abs(1200 * std::log2(std::abs(found) / std::abs(wanted))) < 0.01);
        CHECK(-std::abs(found) / (2 * found.real()) == test::approx(1 / mode.inverse_quality).epsilon(1e-3));
      }
    }
}

TEST_CASE("each echo alone is that of a passage there and back") {
  const auto loop = design(0.3, 1000);
  REQUIRE(loop);
  for (std::size_t j = 0; j < 2; ++j) {
    const rosin::transmission pass{(j == 0 ? 0.3 : 0.7) / 660, e_string.stiffness_s2(), e_string.loss};
    for (const double f : {2e3, 10e3, 20e3, 40e3}) CHECK(std::abs(loop->echo[j].response(f, 256e3) + pass(f)) < 1.5e-3);
  }
}

TEST_CASE("an end that is too near is refused") {
  const std::array<double, 2> delay{0.001 / 660, 0.999 / 660};
  const rosin::echo_plan plan{delay, e_string.stiffness_s2(), {50e3, 110e3}, 256e3, 40, {}};
  const auto loop = rosin::design_loop(plan, [&](std::size_t j) {
    return rosin::pinned_echo{{delay[j], e_string.stiffness_s2(), {}}, 660};
  });
  CHECK_FALSE(loop);
}

}  // namespace simulate_wave_echo
