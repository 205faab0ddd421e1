// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pluck_order.hpp>

#include <rosin/diagnose/pluck_effects.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

#include <limits>

namespace {

constexpr rosin::string_facts ordered_facts{
    .fundamental_Hz = 659.69, .rate_Hz = 128e3, .highest_Hz = 53e3, .impedance_Ns_m = 0.175, .length_m = 0.314, .takes = 2};

rosin::scene_fit leaving(double power, std::vector<rosin::pluck_effect> effects) {
  rosin::scene_fit f;
  f.effects = std::move(effects);
  f.quality.power = {power, power}, f.quality.samples = {500, 500};
  f.quality.noise = {1, 1};
  f.horizon_periods = 1e9;
  return f;
}

}  // namespace

TEST_CASE("a fit costs what it leaves over the noise, and for each parameter the logarithm of the samples") {
  const rosin::scene_fit plain = leaving(500, {}), skew = leaving(500, {rosin::skew_effect(ordered_facts)});
  CHECK(rosin::detail::cost_of(plain, {1, 2}) == test::approx(500 + 125));
  CHECK(rosin::detail::price_of(plain, {1, 1}) == test::approx(1000));
  CHECK(rosin::detail::price_of(skew, {1, 1}) - 1000 == test::approx(std::log(1001) * 1000 / 1001));
  CHECK(rosin::detail::cost_of(leaving(std::numeric_limits<double>::quiet_NaN(), {}), {1, 1}) == 1e300);
}

TEST_CASE("what sits on the string has a mirror image, what does not has none") {
  const rosin::pluck_options options{.internal_loss = false};
  const auto layout = test::two_plucks(options);
  rosin::scene_fit bead = leaving(500, {rosin::point_mass_effect(ordered_facts)});
  std::vector<double> here(bead.effects[0].parameters.size(), 0.0);
  here[0] = 0.3, here[1] = std::log(1e-6);
  bead.value = test::values_of(layout, here);
  REQUIRE(rosin::detail::mirrored(bead));
  CHECK((*rosin::detail::mirrored(bead))[layout.size()] == test::approx(0.7));
  CHECK((*rosin::detail::mirrored(bead))[layout.size() + 1] == bead.value[layout.size() + 1]);
  rosin::scene_fit skew = leaving(500, {rosin::skew_effect(ordered_facts)});
  skew.value = test::values_of(layout, {1e-6});
  CHECK(!rosin::detail::mirrored(skew));
}

TEST_CASE("the cheapest comes first") {
  const rosin::pluck_options options{.internal_loss = false};
  const auto layout = test::two_plucks(options);
  const rosin::scene_data data{{}, {.fundamental_Hz = 659.69}, options, layout};
  std::vector<rosin::scene_fit> fits{leaving(900, {rosin::skew_effect(ordered_facts)}),
                                     leaving(600, {rosin::crosstalk_effect(ordered_facts)}),
                                     leaving(600, {rosin::sensor_resonance_effect(ordered_facts, 0)})};
  rosin::detail::put_in_order(data, leaving(2000, {}), fits, {1, 1});
  REQUIRE(fits.size() == 3);
  CHECK(fits[0].effects[0].name == "channel-crosstalk");
  CHECK(fits[1].effects[0].name == "sensor-resonance");  // leaves as little by more parameters
  CHECK(fits[2].effects[0].name == "channel-skew");
}
