// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_poles.hpp>
#include <rosin/diagnose/string_poles.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

using namespace rosin;

constexpr double pi = 3.14159265358979323846;

TEST_CASE("pickup_pole: a stiff string with the loss law") {
  const pickup_law l{.fundamental_Hz = 200, .inharmonicity = 1e-4, .inverse_q = 1e-3, .internal_s = 1e-7, .air_sqrt_Hz = 0.01};
  const auto s = pickup_pole(l, 7);
  const double f = 7 * 200 * std::sqrt(1 + 1e-4 * 49);
  CHECK(s.imag() == test::approx(2 * pi * f).epsilon(1e-12));
  CHECK(s.real() == test::approx(-pi * f * (1e-3 + 1e-7 * f + 0.01 / std::sqrt(f))).epsilon(1e-12));
}

TEST_CASE("pickup_pole: a heavy bead in the middle of a flexible string is known in closed form") {
  // Odd modes of a string of mass M with m in its middle: cot(k L / 2) = (m / M) k L / 2.
  const double ratio = 0.3;
  const auto s = pickup_pole({.fundamental_Hz = 100, .bead_position = 0.5, .bead_mass = ratio}, 1);
  const double half = pi * s.imag() / (2 * pi * 100) / 2;
  CHECK(1 / std::tan(half) == test::approx(ratio * half).epsilon(1e-9));
  CHECK(pickup_pole({.fundamental_Hz = 100, .bead_position = 0.5, .bead_mass = ratio}, 2).imag() == test::approx(2 * pi * 200));
}

TEST_CASE("pickup_pole: little loads shift as Rayleigh has it, stiff or not") {
  for (const double b : {0.0, 1e-3}) {
    const pickup_law plain{.fundamental_Hz = 100, .inharmonicity = b};
    pickup_law bead = plain, finger = plain;
    bead.bead_position = finger.finger_position = 0.2;
    bead.bead_mass = finger.finger_resistance = 1e-5;
    for (const int n : {1, 3, 8}) {
      const double w = pickup_pole(plain, n).imag(), shape = std::pow(std::sin(n * pi * 0.2), 2);
      CHECK(pickup_pole(bead, n).imag() / w - 1 == test::approx(-1e-5 * shape).epsilon(1e-3));
      CHECK(-pickup_pole(finger, n).real() == test::approx(2 * 100 * 1e-5 * shape).epsilon(1e-3));
    }
  }
}

TEST_CASE("pickup_pole: an end on a resonance pulls partials towards it from both sides and damps them") {
  const pickup_law l{.fundamental_Hz = 100, .inverse_q = 1e-3, .support_Hz = 350, .support_q = 30, .support_lightness = 0.05};
  CHECK(pickup_pole(l, 3).imag() < 2 * pi * 300);  // above it the end is stiffness in reverse
  CHECK(pickup_pole(l, 4).imag() > 2 * pi * 400);
  CHECK(-pickup_pole(l, 3).real() > 1.2 * pi * 300e-3);
}

TEST_CASE("pickup_pole: heavy loads on a stiff string, as its determinant has them") {
  pickup_law l{.fundamental_Hz = 437, .inharmonicity = 1.2e-4, .inverse_q = 1e-3};
  const auto check = [&](const pluck_scene& scene) {
    const auto poles = string_poles(scene, 14000, 40, {});
    for (const int n : {1, 2, 9, 20, 26}) {
      const auto s = pickup_pole(l, n);
      double off = 1e300;
      for (const auto& p : poles) off = std::min(off, std::abs(p - s));
      CHECK(off < 1e-5 * 2 * pi * 437);
    }
  };
  pluck_scene plain;
  plain.string.fundamental_Hz = 437, plain.string.inharmonicity = 1.2e-4, plain.string.loss.quality = 1e3;
  SUBCASE("a bead") {
    l.bead_position = 0.43, l.bead_mass = 0.016;
    plain.scatterers.push_back({.position = 0.43, .mass_s = 0.016 / (2 * 437)});
    check(plain);
  }
  SUBCASE("a finger close to an end") {
    l.finger_position = 0.02, l.finger_resistance = 0.05;
    plain.scatterers.push_back({.position = 0.02, .resistance = 0.05});
    check(plain);
  }
  SUBCASE("an end that gives way") {
    l.support_Hz = 3100, l.support_q = 20, l.support_lightness = 0.05;
    plain.ends[0].modes.push_back({3100, 20, 2 * 437 * 0.05});
    check(plain);
  }
}

TEST_CASE("pickup_pole: modes that lose with all loads on them ring as their frequency alone has it") {
  const pickup_law l{
      .fundamental_Hz = 437, .inharmonicity = 1e-4, .inverse_q = 1e-3, .loaded_loss = 1, .bead_position = 0.3, .bead_mass = 0.02};
  for (const int n : {1, 4, 9}) {
    const auto s = pickup_pole(l, n);
    CHECK(-2 * s.real() / s.imag() == test::approx(1e-3).epsilon(1e-4));
  }
  pickup_law bare = l;
  bare.loaded_loss = 0;
  CHECK(-2 * pickup_pole(bare, 1).real() / pickup_pole(bare, 1).imag() < 0.99e-3);
}
