// SPDX-License-Identifier: MIT
// On a modal string, which shares nothing with the model that is fitted.
#include <rosin/diagnose/odd_pluck.hpp>

#include "plucked.hpp"

#include <doctest/doctest.h>

namespace {

std::optional<rosin::odd_pluck> odd_of(const std::vector<rosin::pluck_take>& takes, const std::vector<rosin::pluck_take>& held) {
  return rosin::find_odd_pluck(takes, held, {.fundamental_Hz = 660}, {.internal_loss = false}, [](const rosin::pluck_fit_result&) { return std::vector<rosin::pluck_effect>{}; });
}

/// Three plucks, two to fit and one held out.
struct three {
  std::vector<rosin::pluck_take> takes, held;
};
three sound_plucks(double slow_s = 0) {
  three out{{test::modal_pluck(1, 1, slow_s), test::modal_pluck(0.5, 2, slow_s)}, {test::modal_pluck(0.75, 3, slow_s)}};
  out.takes[0].name = "hard", out.takes[1].name = "soft", out.held[0].name = "kept";
  return out;
}

}  // namespace

TEST_CASE("odd pluck: three plucks of one string contradict nothing, nor do three that the model lacks something of") {
  const three sound = sound_plucks(), slow = sound_plucks(40e-6);
  CHECK_FALSE(odd_of(sound.takes, sound.held));
  CHECK_FALSE(odd_of(slow.takes, slow.held));
  CHECK_FALSE(odd_of(sound.takes, {}));  // two cannot tell which
}

TEST_CASE("odd pluck: samples that a recorder lost are found, with their number and where") {
  three p = sound_plucks();
  constexpr std::size_t at = 6000, count = 7;
  for (auto& channel : p.takes[1].force_N) channel.erase(channel.begin() + at, channel.begin() + at + count);
  const auto odd = odd_of(p.takes, p.held);
  REQUIRE(odd);
  CHECK(odd->take.name == "soft");
  CHECK_FALSE(odd->strongest);
  CHECK(odd->before > 20 * odd->floor);
  REQUIRE(odd->lost);
  CHECK(odd->lost->count == count);
  CHECK(odd->lost->time_s * odd->take.rate_Hz == doctest::Approx(at).epsilon(0.02));
  CHECK(odd->after < 1.1 * odd->floor);
  CHECK(odd->others.best.effects.empty());
}

TEST_CASE("odd pluck: the one that was held out may be it, tuned a thousandth higher") {
  three p = sound_plucks();
  for (auto& channel : p.held[0].force_N) channel = rosin::resampled(channel, 1e-3);
  const auto odd = odd_of(p.takes, p.held);
  REQUIRE(odd);
  CHECK(odd->take.name == "kept");
  CHECK_FALSE(odd->lost);
  CHECK(odd->own_fundamental_Hz / odd->others.best.value[0] - 1 == doctest::Approx(1e-3).epsilon(0.01));
}

TEST_CASE("odd pluck: something that only the strongest meets shows from then on") {
  three p = sound_plucks();
  auto& hard = p.takes[0];
  constexpr std::size_t hit = 5000;
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t i = hit; i < hard.force_N[c].size(); ++i)
      hard.force_N[c][i] += 0.02 * std::exp(-static_cast<double>(i - hit) / 2000) * std::sin(0.21 * static_cast<double>(i - hit));
  const auto odd = odd_of(p.takes, p.held);
  REQUIRE(odd);
  CHECK(odd->take.name == "hard");
  CHECK(odd->strongest);
  CHECK_FALSE(odd->lost);
  CHECK(odd->time_s[0] * hard.rate_Hz == doctest::Approx(hit).epsilon(0.04));
}
