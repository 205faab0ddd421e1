// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pickup_fit.hpp>

#include "support/approx.hpp"
#include "support/single_pickup.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace {

constexpr double pickup_rate_Hz = test::pickup_rate_Hz;

using test::plucked;

}  // namespace

TEST_CASE("pitch, inharmonicity and loss from one channel, from 2 % beside the pitch") {
  int inside = 0, of = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const double f0 = 180 + 17.3 * seed, b = 3e-5 * seed;
    const auto fit = rosin::fit_pickup(plucked(f0, b, 1e-3, seed), pickup_rate_Hz, f0 * (seed % 2 ? 0.98 : 1.02));
    REQUIRE_MESSAGE(fit, fit.error());
    CHECK(fit->fundamental_Hz == test::approx(f0).epsilon(1e-4));
    CHECK(fit->inharmonicity == test::approx(b).epsilon(0.05));
    CHECK(fit->loss.law.inverse_q(1000) == test::approx(1 / 1200.0 + 2e-4).epsilon(0.1));
    CHECK(fit->partials.size() >= 8);
    inside += std::abs(fit->fundamental_Hz - f0) < 2 * fit->fundamental_sd ? 1 : 0;
    inside += std::abs(fit->inharmonicity - b) < 2 * fit->inharmonicity_sd ? 1 : 0;
    of += 2;
  }
  CHECK(inside >= of - 5);
}

TEST_CASE("a tone that does not die away is no string that was let go") {
  std::vector<double> x(66150);
  for (std::size_t i = 0; i < x.size(); ++i)
    for (int n = 1; n <= 20; ++n)
      x[i] += std::cos(2 * std::numbers::pi * 220.0 * n * static_cast<double>(i) / pickup_rate_Hz + n) / n;
  const auto fit = rosin::fit_pickup(x, pickup_rate_Hz, 220);
  REQUIRE_FALSE(fit);
  CHECK(fit.error().find("do not clearly decay") != std::string::npos);
}

TEST_CASE("a glide of half a per cent is taken out, and pitch and inharmonicity keep their error bars") {
  const auto fit = rosin::fit_pickup(plucked(196, 1e-4, 1e-4, 5, 5e-3), pickup_rate_Hz, 197);
  REQUIRE_MESSAGE(fit, fit.error());
  CHECK(fit->glide.relative > 1e-3);
  CHECK(std::abs(fit->fundamental_Hz - 196) < 3 * fit->fundamental_sd);
  CHECK(fit->fundamental_sd < 0.2);
  CHECK(std::abs(fit->inharmonicity - 1e-4) < 3 * fit->inharmonicity_sd);
}

TEST_CASE("noise, silence and what is too short are refused in words") {
  std::mt19937_64 random{1};
  std::normal_distribution<double> gauss;
  std::vector<double> x(44100), zero(44100, 0.0);
  for (double& v : x) v = gauss(random);
  CHECK_FALSE(rosin::fit_pickup(x, pickup_rate_Hz, 220));
  CHECK_FALSE(rosin::fit_pickup(zero, pickup_rate_Hz, 220));
  const std::vector<double> brief(500, 0.1);
  CHECK_FALSE(rosin::fit_pickup(brief, pickup_rate_Hz, 220));
  CHECK_FALSE(rosin::fit_pickup(brief, pickup_rate_Hz, 220).error().empty());
}
