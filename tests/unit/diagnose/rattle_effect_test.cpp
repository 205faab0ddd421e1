// SPDX-License-Identifier: MIT
// On a stepped modal string with a stiff spring in its way, which shares nothing with the closed forms that are propagated back.
#include <rosin/diagnose/rattle_effect.hpp>

#include <rosin/diagnose/odd_pluck.hpp>
#include <rosin/simulate/burdened_signals.hpp>

#include "plucked.hpp"

#include <doctest/doctest.h>

namespace {

rosin::pluck_take pluck(double force_N, std::uint64_t seed, const rosin::obstacle& stop, double position = 0.3) {
  rosin::rig_burden burden;
  burden.string.stop = stop;
  const auto made = rosin::simulate_pluck(test::plucked_rig, burden,
                                          {.position = position, .force_N = force_N, .release_s = 0.004, .duration_s = 0.05});
  rosin::pluck_take take;
  take.name = "pluck-" + std::to_string(seed);
  take.rate_Hz = made->sample_rate_Hz, take.strength_N = force_N, take.position = position;
  const rosin::converter sensor{.gain = 1, .newtons_per_full_scale = 3, .noise_N = 0.3e-3, .bits = 16};
  take.force_N = {rosin::convert(made->force_near_N, take.rate_Hz, sensor, 2 * seed).newtons(),
                  rosin::convert(made->force_far_N, take.rate_Hz, sensor, 2 * seed + 1).newtons()};
  return take;
}

}  // namespace

TEST_CASE("rattle: an obstacle that only the strongest pluck meets is found, with its place and gap" *
          doctest::test_suite("long")) {
  // Held at 0.3 by 2 N the string stands 1.8 mm aside there; half a period later it is as far on the other side at 0.7.
  for (const auto& [position, gap_m] : {std::pair{0.62, -1.0e-3}, std::pair{0.45, -0.9e-3}}) {
    const rosin::obstacle stop{position, gap_m, 3e5};
    const auto odd = rosin::find_odd_pluck({pluck(0.5, 1, stop), pluck(2, 2, stop)}, {pluck(0.75, 3, stop)},
                                           {.fundamental_Hz = 660}, {.internal_loss = false},
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
  const std::vector<rosin::pluck_take> takes{pluck(0.5, 1, stop), pluck(2, 2, stop)}, held{pluck(1.6, 3, stop)};
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
    auto take = pluck(force_N, seed, {});
    for (auto& channel : take.force_N)
      for (double& x : channel) x = std::clamp(x, -0.9, 0.9);
    return take;
  };
  CHECK_FALSE(rosin::find_rattling_plucks({takes[0], clipped(2, 2)}, {clipped(1.6, 3)}, {.fundamental_Hz = 660},
                                          {.internal_loss = false}, none, Z));
}

TEST_CASE("rattle: a pluck that is odd for another reason met no obstacle" * doctest::test_suite("long")) {
  const rosin::obstacle none{};
  std::vector<rosin::pluck_take> takes{pluck(0.5, 1, none), pluck(2, 2, none)};
  const auto odd_of = [&] {
    return rosin::find_odd_pluck(takes, {pluck(0.75, 3, none)}, {.fundamental_Hz = 660}, {.internal_loss = false},
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
