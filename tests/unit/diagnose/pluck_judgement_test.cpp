// SPDX-License-Identifier: MIT
// By a modal string whose wire lets go slowly: two models of as many parameters, the right one and another.
#include <rosin/diagnose/pluck_judgement.hpp>

#include <rosin/diagnose/pluck_diagnosis.hpp>
#include <rosin/simulate/burdened_signals.hpp>

#include "plucked.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

TEST_CASE(
    "pluck judgement: a pluck set aside is left at the noise by the right model, not by a wrong one of as many parameters") {
  constexpr double slow = 40e-6;
  const std::vector takes{test::modal_pluck(1, 1, slow), test::modal_pluck(0.5, 2, slow)}, held{test::modal_pluck(0.75, 3, slow)};
  const auto d = rosin::diagnose_plucks(
      takes, held, {.fundamental_Hz = 660}, {.internal_loss = false}, [&](const rosin::pluck_fit_result& fit) {
        const rosin::string_facts facts{fit.value[0], takes[0].rate_Hz, fit.limits.stop_Hz, 0.175, 0.314, takes.size()};
        auto all = rosin::catalogue_without({}, facts, fit.limits);
        std::erase_if(all, [](const auto& e) { return e.name != "slow-release" && e.name != "channel-skew"; });
        return all;
      });
  REQUIRE_MESSAGE(d, d.error());
  REQUIRE(d->best.effects.size() == 1);
  CHECK(d->best.effects[0].name == "slow-release");
  REQUIRE(d->ranking.size() >= 2);
  for (const auto& h : d->ranking) {
    REQUIRE(h.left);
    CHECK(h.fit.effects.size() == h.ids.size());
    if (h.ids == std::vector<std::string>{"slow-release"}) CHECK(*h.left == test::approx(d->after).epsilon(0.02));
    else CHECK(*h.left > 3 * d->floor);
  }
}

TEST_CASE(
    "pluck judgement: what leaves mere noise of the plucks that were fitted, and much of the one set aside, is no explanation" *
    doctest::test_suite("long")) {
  constexpr double slow = 40e-6;
  const std::vector takes{test::modal_pluck(1, 1, slow), test::modal_pluck(0.5, 2, slow)};
  std::vector held{test::modal_pluck(0.75, 3, slow)};
  for (double& x : held[0].force_N[1]) x *= 1.03;  // a sensor that was touched
  const auto d = rosin::diagnose_plucks(
      takes, held, {.fundamental_Hz = 660}, {.internal_loss = false}, [&](const rosin::pluck_fit_result& fit) {
        return std::vector{
            rosin::slow_release_effect({fit.value[0], takes[0].rate_Hz, fit.limits.stop_Hz, 0.175, 0.314, takes.size()})};
      });
  REQUIRE_MESSAGE(d, d.error());
  CHECK(d->ranking.front().ids == std::vector<std::string>{"slow-release"});
  CHECK(d->ranking.front().fit.quality.inflation() == 1.0);
  CHECK(d->after > 7 * d->floor);
  CHECK_FALSE(d->explained);
}

TEST_CASE("pluck judgement: two effects that together come near what is neither are no part of the answer" *
          doctest::test_suite("long")) {
  rosin::rig_burden burden;
  burden.string.loads = {{0.58, 6e-6, 0, 0}};
  auto takes = test::recorded_plucks({1, 0.5, 0.75}, [&](double force_N) {
    return rosin::simulate_pluck(test::plucked_rig, burden,
                                 {.position = 0.3, .force_N = force_N, .release_s = 0.004, .duration_s = 0.06});
  });
  const auto held = test::last_of(takes);
  const auto d = rosin::diagnose_plucks(
      takes, held, {.fundamental_Hz = 660}, {.internal_loss = false}, [&](const rosin::pluck_fit_result& fit) {
        const rosin::string_facts facts{fit.value[0], takes[0].rate_Hz, fit.limits.stop_Hz, 0.175, 0.314, takes.size()};
        auto all = rosin::catalogue_without({}, facts, fit.limits);
        std::erase_if(all, [](const auto& e) { return e.name != "support-resonance"; });
        return all;
      });
  REQUIRE_MESSAGE(d, d.error());
  CHECK(d->mismatched);
  CHECK_FALSE(d->explained);
  CHECK(d->best.effects.empty());
  CHECK(d->after == d->before);
  CHECK(d->ranking.front().ids.size() == 2);
  REQUIRE(d->ranking.front().left);
  CHECK(*d->ranking.front().left < 0.5 * d->before);
}
