// SPDX-License-Identifier: MIT
#include <rosin/acquire/ringing.hpp>

#include <doctest/doctest.h>

#include <support/synthetic_take.hpp>

#include "support/approx.hpp"

namespace acquire_ringing {

namespace {

std::vector<double> ringing(const test::pluck& p) {
  auto x = test::pluck_forces(p)[0];
  x.erase(x.begin(), x.begin() + static_cast<std::ptrdiff_t>((p.release_s + 1.5 / p.fundamental_Hz) * p.rate_Hz));
  return x;
}

}  // namespace

TEST_CASE("the pitch is found to a thousandth where it is the declared one, or near it") {
  test::pluck p;
  for (const double declared : {330.0, 333.0, 326.0}) {
    const auto found = rosin::find_ringing(ringing(p), p.rate_Hz, declared, p.inharmonicity);
    REQUIRE(found);
    CHECK(found->pitch_Hz == test::approx(330).epsilon(1e-3));
    CHECK(found->score > 0.9);
  }
}

TEST_CASE("another pitch is found for what it is: wrong sample rates, octaves") {
  test::pluck p;
  p.quality = 1500;
  const auto x = ringing(p);
  for (const double wrong : {44100.0 / 48000, 48000.0 / 44100, 0.5, 2.0, 0.75, 96.0 / 44.1, 1.06, 0.94}) {
    CAPTURE(wrong);
    const auto found = rosin::find_ringing(x, p.rate_Hz * wrong, p.fundamental_Hz, p.inharmonicity);
    REQUIRE(found);
    CHECK(found->pitch_Hz == test::approx(330 * wrong).epsilon(3e-3));
  }
}

TEST_CASE("missing partials do not mislead: plucked at a node") {
  for (const double position : {0.5, 1.0 / 3, 0.25}) {
    CAPTURE(position);
    test::pluck p;
    p.position = position;
    const auto found = rosin::find_ringing(ringing(p), p.rate_Hz, p.fundamental_Hz, p.inharmonicity);
    REQUIRE(found);
    CHECK(found->pitch_Hz == test::approx(330).epsilon(1e-3));
  }
}

TEST_CASE("Q of the ringing as a whole") {
  for (const double quality : {10.0, 60.0, 400.0, 3000.0}) {
    CAPTURE(quality);
    test::pluck p;
    p.noise_N = 1e-5;
    p.quality = quality;
    const auto q = rosin::find_quality(ringing(p), p.rate_Hz, p.fundamental_Hz);
    REQUIRE(q);
    // high partials die sooner, so the power falls faster than the fundamental's
    CHECK(*q < 1.05 * quality);
    CHECK(*q > 0.35 * quality);
  }
}

TEST_CASE("nothing is said of what is too short or silent") {
  test::pluck p;
  const auto x = ringing(p);
  CHECK_FALSE(rosin::find_ringing({x.data(), 500}, p.rate_Hz, p.fundamental_Hz, 0));
  CHECK_FALSE(rosin::find_ringing(std::vector<double>(20000, 0.0), p.rate_Hz, p.fundamental_Hz, 0));
  CHECK_FALSE(rosin::find_quality({x.data(), 100}, p.rate_Hz, p.fundamental_Hz));
}

}  // namespace acquire_ringing
