// SPDX-License-Identifier: MIT
#include <rosin/calibrate/uneven_string.hpp>
#include <rosin/propagate/transmission.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("A string whose modes keep to the law is one with that loss") {
  rosin::uneven_string s{300, 1e-13, {.quality = 800, .internal_s = 3e-8}, {}};
  for (const double f : {100.0, 301.0, 5000.0, 20000.0}) {
    const auto expected = rosin::propagation_rate(f, s.stiffness_s2, s.loss);
    CHECK(std::abs(s.propagation_rate(f) - expected) < 1e-12 * std::abs(expected));
    s.ln_own_q = {0, 0, 0};
    CHECK(std::abs(s.propagation_rate(f) - expected) < 1e-12 * std::abs(expected));
    s.ln_own_q.clear();
  }
}

TEST_CASE("At a mode the loss is that mode's, between two of them between theirs, and the last one's goes on") {
  const rosin::uneven_string s{300, 2e-13, {.quality = 800}, {0.1, -0.2, 0.3}};
  for (int n = 1; n <= 3; ++n)
    CHECK(1 / s.inverse_q(s.partial_Hz(n)) == test::approx(800 * std::exp(s.ln_own_q[static_cast<std::size_t>(n - 1)])));
  CHECK(1 / s.inverse_q((s.partial_Hz(1) + s.partial_Hz(2)) / 2) == test::approx(800 * std::exp(-0.05)).epsilon(1e-3));
  CHECK(1 / s.inverse_q(20e3) == test::approx(800 * std::exp(0.3)));
  CHECK(1 / s.inverse_q(10) == test::approx(800 * std::exp(0.1)));
}

TEST_CASE("Its partials are those of a stiff string") {
  // f_n = n f0 sqrt(1 + b n^2), b = epsilon (2 pi f0)^2
  const rosin::uneven_string s{300, 1e-12, {}, {}};
  const double b = 1e-12 * std::pow(2 * std::numbers::pi * 300, 2);
  CHECK(s.partial_Hz(20) == test::approx(20 * 300 * std::sqrt(1 + 400 * b)));
}
