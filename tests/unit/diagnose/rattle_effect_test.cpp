// SPDX-License-Identifier: MIT
// On a stepped modal string with a stiff spring in its way, which shares nothing with the closed forms that are propagated back.
#include <rosin/diagnose/rattle_effect.hpp>

#include <rosin/diagnose/odd_pluck.hpp>

#include "stopped_pluck.hpp"

#include <doctest/doctest.h>

using test::stopped_pluck;

TEST_CASE("rattle: an obstacle that only the strongest pluck meets is found, with its place and gap" *
          doctest::test_suite("long")) {
  // Held at 0.3 by 2 N the string stands 1.8 mm aside there; half a period later it is as far on the other side at 0.7.
  for (const auto& [position, gap_m] : {std::pair{0.62, -1.0e-3}, std::pair{0.45, -0.9e-3}}) {
    const rosin::obstacle stop{position, gap_m, 3e5};
    const auto odd = rosin::find_odd_pluck({stopped_pluck(0.5, 1, stop), stopped_pluck(2, 2, stop)},
                                           {stopped_pluck(0.75, 3, stop)}, {.fundamental_Hz = 660}, {.internal_loss = false},
                                           [](const rosin::pluck_fit_result&) { return std::vector<rosin::pluck_effect>{}; });
    REQUIRE(odd);
    CHECK(odd->take.name == "pluck-2");
    const auto found = rosin::find_rattle(*odd, test::plucked_rig.string.impedance_Ns_m());
    REQUIRE(found);
    MESSAGE(position, " ", gap_m, ": ", found->place.position, " +- ", found->place.sd, " left ", found->place.left, " gap ",
            found->gap_m, " +- ", found->gap_sd_m, " one-sided ", found->one_sided, " at ", found->first_s, " before ",
            found->before, " after ", found->after, " odd floor ", odd->floor);
    CHECK(std::abs(found->place.position - position) < 0.002);
    CHECK(std::abs(found->gap_m / gap_m - 1) < 0.02);
    CHECK(found->after < 0.02 * found->before);
    CHECK(found->gap_sd_m < 0.05e-3);
  }
}

TEST_CASE("rattle: one that two of three plucks meet is told by both, against the softest by itself" *
          doctest::test_suite("long")) {
  const rosin::obstacle stop{0.62, -1.0e-3, 3e5};
  const auto none = [](const rosin::pluck_fit_result&) { return std::vector<rosin::pluck_effect>{}; };
  const std::vector<rosin::pluck_take> takes{stopped_pluck(0.5, 1, stop), stopped_pluck(2, 2, stop)},
      held{stopped_pluck(1.6, 3, stop)};
  const double Z = test::plucked_rig.string.impedance_Ns_m();
  const auto odd = rosin::find_rattling_plucks(takes, held, {.fundamental_Hz = 660}, {.internal_loss = false}, none, Z);
  REQUIRE(odd);
  CHECK(odd->take.name == "pluck-2");
  REQUIRE(odd->also.size() == 1);
  CHECK(odd->also[0].name == "pluck-3");
  const auto found = rosin::find_rattle(*odd, Z);
  REQUIRE(found);
  CHECK(std::abs(found->place.position - stop.position) < 0.002);
  CHECK(std::abs(found->gap_m / stop.gap_m - 1) < 0.02);
  const auto clipped = [&](double force_N, std::uint64_t seed) {
    auto take = stopped_pluck(force_N, seed, {});
    for (auto& channel : take.force_N)
      for (double& x : channel) x = std::clamp(x, -0.9, 0.9);
    return take;
  };
  CHECK_FALSE(rosin::find_rattling_plucks({takes[0], clipped(2, 2)}, {clipped(1.6, 3)}, {.fundamental_Hz = 660},
                                          {.internal_loss = false}, none, Z));
}

TEST_CASE("rattle: a pluck that is odd for another reason met no obstacle" * doctest::test_suite("long")) {
  const rosin::obstacle none{};
  std::vector<rosin::pluck_take> takes{stopped_pluck(0.5, 1, none), stopped_pluck(2, 2, none)};
  const auto odd_of = [&] {
    return rosin::find_odd_pluck(takes, {stopped_pluck(0.75, 3, none)}, {.fundamental_Hz = 660}, {.internal_loss = false},
                                 [](const rosin::pluck_fit_result&) { return std::vector<rosin::pluck_effect>{}; });
  };
  SUBCASE("it is tuned higher") {
    for (auto& channel : takes[1].force_N) channel = rosin::resampled(channel, 1e-3);
  }
  SUBCASE("both sensors clip what is strong") {
    for (auto& channel : takes[1].force_N)
      for (double& x : channel) x = std::clamp(x, -0.9, 0.9);
  }
  const auto odd = odd_of();
  REQUIRE(odd);
  CHECK_FALSE(rosin::find_rattle(*odd, test::plucked_rig.string.impedance_Ns_m()));
}
