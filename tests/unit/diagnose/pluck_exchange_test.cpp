// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pluck_exchange.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

namespace {

/// Two plucks of which the far channel comes late, and some of each leaks into the other; and both effects fitted to them.
struct leaky_and_late {
  rosin::string_facts facts{
      .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};
  rosin::pluck_options options{.internal_loss = false};
  rosin::pluck_layout layout = test::two_plucks(options);
  rosin::pluck_effect late = rosin::skew_effect(facts), cross = rosin::crosstalk_effect(facts);
  std::array<double, 2> noise{3e-4, 3e-4};
  rosin::scene_data data{{}, {.fundamental_Hz = 659.69}, options, layout};
  rosin::scene_fit both;

  explicit leaky_and_late(double leak) {
    for (std::size_t t = 0; t < 2; ++t)
      data.takes.push_back(test::scene_pluck(layout, {cross, late}, test::values_of(layout, {leak, 2e-6}), t, noise[0], 3 + t));
    both = rosin::fit_scene(data, {cross, late}, test::values_of(layout, {std::max(leak, 1e-5), 2e-6}), {{}}, noise);
  }
};

}  // namespace

TEST_CASE("an effect that a later one has made needless is given up") {
  const leaky_and_late plucks(0);
  const auto any = [](const rosin::scene_fit&, const rosin::scene_fit&, std::size_t) { return true; };
  const auto kept = rosin::exchanged(plucks.data, plucks.both, {plucks.late, plucks.cross}, 1, plucks.noise, any);
  REQUIRE(kept.effects.size() == 1);
  CHECK(kept.effects[0].id() == "channel-skew");
  CHECK(kept.value[plucks.layout.size()] == test::approx(2e-6).epsilon(0.01));
}

TEST_CASE("an effect that is there, but not worth a name beside a later one, is given up") {
  const leaky_and_late plucks(1e-3);
  double share_of_cross = 0;
  const auto worth = [&](const rosin::scene_fit& rest, const rosin::scene_fit& fit, std::size_t which) {
    if (fit.effects[which].id() != "channel-crosstalk") return true;
    share_of_cross = rest.quality.power[0] / fit.quality.power[0] - 1;
    return false;
  };
  const auto kept = rosin::exchanged(plucks.data, plucks.both, {plucks.late}, 1, plucks.noise, worth);
  CHECK(share_of_cross > 0.05);
  REQUIRE(kept.effects.size() == 1);
  CHECK(kept.effects[0].id() == "channel-skew");
}
