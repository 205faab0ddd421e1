// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pickup_glide.hpp>

#include "support/approx.hpp"
#include "support/single_pickup.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace {

constexpr double glide_rate_Hz = test::pickup_rate_Hz;

using test::plucked;

}  // namespace

TEST_CASE("a glide of pitch is found, and none is found where there is none") {
  for (const double glide : {0.0, 4e-3}) {
    const auto x = plucked(247.1, 6e-5, 1e-4, 3, glide);
    const rosin::baseband_bank bank{x, glide_rate_Hz, 40};
    std::vector<rosin::partial_track> tracks;
    for (int n = 1; n <= 6; ++n)
      if (auto t = rosin::track_partial(bank, n, n * 247.1 * std::sqrt(1 + 6e-5 * n * n), 5, 0.2, 1.4))
        tracks.push_back(*std::move(t));
    REQUIRE(tracks.size() >= 5);
    const rosin::glide_estimate found = rosin::estimate_glide(tracks);
    if (glide == 0) CHECK(std::abs(found.glide.relative) < 2e-4);
    else CHECK(found.glide.relative == test::approx(glide * std::exp(-5 * 0.1)).epsilon(0.25));
  }
}
