// SPDX-License-Identifier: MIT
// On a modal string, which shares nothing with the model that is fitted.
#include <rosin/diagnose/pluck_diagnosis.hpp>

#include "plucked.hpp"

#include <doctest/doctest.h>

namespace {

rosin::outcome<rosin::pluck_diagnosis> look(const std::vector<rosin::pluck_take>& takes, const rosin::pluck_take& held) {
  return rosin::diagnose_plucks(takes, {held}, {.fundamental_Hz = 660}, {.internal_loss = false}, [&](const rosin::pluck_fit_result& fit) {
    const rosin::string_facts facts{fit.value[0], takes[0].rate_Hz, fit.limits.stop_Hz, 0.175, 0.314, takes.size()};
    auto all = rosin::catalogue_without({"bending-stiffness"}, facts, fit.limits);
    // Scans over frequency and place, and searches for poles, are what takes long; here they are not what is tested.
    std::erase_if(all, [](const rosin::pluck_effect& e) { return e.starts.size() > 20 || e.at_end || e.strength < -1; });
    return all;
  });
}

}  // namespace

TEST_CASE("a string as declared is left alone, and predicted to the noise") {
  const auto d = look({test::modal_pluck(1, 1), test::modal_pluck(0.5, 2)}, test::modal_pluck(0.75, 3));
  REQUIRE_MESSAGE(d, d.error());
  CHECK_FALSE(d->mismatched);
  CHECK(d->best.effects.empty());
  CHECK(d->before < 1.2 * d->floor);
  CHECK(d->before > 0.8 * d->floor);
}

TEST_CASE("a wire that lets go slowly is named, with its duration, and the pluck that was kept aside is predicted") {
  constexpr double slow = 40e-6;
  const auto d = look({test::modal_pluck(1, 1, slow), test::modal_pluck(0.5, 2, slow)}, test::modal_pluck(0.75, 3, slow));
  REQUIRE_MESSAGE(d, d.error());
  REQUIRE(d->best.effects.size() == 1);
  CHECK(d->explained);
  CHECK(d->best.effects[0].id() == "slow-release");
  CHECK(std::exp(d->best.value[d->data.layout.size()]) == doctest::Approx(slow).epsilon(0.02));
  CHECK(d->before > 3 * d->floor);
  CHECK(d->after < 1.2 * d->floor);
  CHECK(d->mismatch.residual_over_noise > 2);
}
