// SPDX-License-Identifier: MIT
// On a stepped modal string with a spring in its way, which shares nothing with the closed forms that are fitted.
#include <rosin/diagnose/rattling_string.hpp>

#include <rosin/diagnose/rattle_effect.hpp>

#include "stopped_pluck.hpp"

#include <doctest/doctest.h>

namespace {

/// Gains, strength and place are not quite what is declared.
rosin::pluck_take rattled(double force_N, std::uint64_t seed, const rosin::obstacle& stop) {
  rosin::pluck_take take = test::stopped_pluck(force_N, seed, stop);
  take.strength_N *= 0.99, take.position = 0.302;
  for (auto& channel : take.force_N)
    for (double& x : channel) x *= 1.02;
  return take;
}

const rosin::pluck_guess nominal{.fundamental_Hz = 660.9, .inharmonicity = 7e-5};
constexpr rosin::obstacle in_the_way{0.62, -0.3e-3, 1e5};

}  // namespace

TEST_CASE("rattling string: pitch, stiffness and place of a pluck that met an obstacle, in spite of it" *
          doctest::test_suite("long")) {
  const std::vector<rosin::pluck_take> takes{rattled(0.4, 1, in_the_way)};
  const rosin::scene_data data{takes, nominal, {}, rosin::pluck_layout(takes, {}, {})};
  const auto plain = rosin::fit_plucks(takes, nominal, {}, 1e9);  // what a fit that knows of none makes of it
  const auto fit = rosin::fit_past_a_force(data);
  REQUIRE(plain);
  REQUIRE(fit);
  const auto& string = test::plucked_rig.string;
  const double stiff = std::pow(std::numbers::pi / string.length_m, 2) * string.bending_stiffness_Nm2 / string.tension_N;
  MESSAGE("f0 ", fit->value[0], " +- ", fit->sd[0], " B ", fit->value[1], " of ", stiff, " p ",
          fit->value[data.layout.position(0)], " plain f0 ", plain->value[0]);
  CHECK(std::abs(fit->value[rosin::pluck_layout::fundamental] / string.fundamental_Hz - 1) < 2e-5);
  CHECK(std::abs(plain->value[rosin::pluck_layout::fundamental] / string.fundamental_Hz - 1) > 1e-4);
  CHECK(std::abs(fit->value[rosin::pluck_layout::inharmonicity] / stiff - 1) < 0.02);
  CHECK(std::abs(fit->value[data.layout.position(0)] - 0.3) < 1e-4);
  CHECK(std::abs(fit->value[rosin::pluck_layout::fundamental] - string.fundamental_Hz) <
        4 * fit->sd[rosin::pluck_layout::fundamental]);
}

TEST_CASE("rattling string: of two plucks that both met the same obstacle its place and gap are told" *
          doctest::test_suite("long")) {
  const std::vector<rosin::pluck_take> takes{rattled(0.6, 1, in_the_way), rattled(0.4, 2, in_the_way)};
  const double Z = test::plucked_rig.string.impedance_Ns_m();
  const auto odd = rosin::find_rattling_string(takes, {}, nominal, {}, Z);
  REQUIRE(odd);
  CHECK(odd->take.name == "pluck-1");
  REQUIRE(odd->also.size() == 1);
  CHECK(odd->others.declared.limits.stop_Hz > 1e4);
  const auto found = rosin::find_rattle(*odd, Z);
  REQUIRE(found);
  MESSAGE("place ", found->place.position, " gap ", found->gap_m, " +- ", found->gap_sd_m, " one-sided ", found->one_sided,
          " before ", found->before, " after ", found->after, " floor ", found->floor);
  CHECK(std::abs(found->place.position - in_the_way.position) < 0.002);
  CHECK(std::abs(found->gap_m / in_the_way.gap_m - 1) < 0.03);
  CHECK(found->after < 0.02 * found->before);
}

TEST_CASE("rattling string: plucks that nothing touched, or that sensors clip, met no obstacle" * doctest::test_suite("long")) {
  const double Z = test::plucked_rig.string.impedance_Ns_m();
  std::vector<rosin::pluck_take> takes{rattled(2, 1, {}), rattled(1.6, 2, {})};
  CHECK_FALSE(rosin::find_rattling_string(takes, {}, nominal, {}, Z));
  for (auto& take : takes)
    for (auto& channel : take.force_N)
      for (double& x : channel) x = std::clamp(x, -0.9, 0.9);
  CHECK_FALSE(rosin::find_rattling_string(takes, {}, nominal, {}, Z));
}
