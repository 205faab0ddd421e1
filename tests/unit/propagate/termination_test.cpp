// SPDX-License-Identifier: MIT
#include <rosin/propagate/termination.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace propagate_termination {

namespace {

const rosin::modal_termination bridge{{{460, 35, 0.175 / 0.12}, {900, 30, 0.175 / 0.05}}};

}  // namespace

TEST_CASE("at its resonance a mode gives way by Q / (M w), in phase with the force") {
  const rosin::modal_termination one{{{3000, 20, 0.175 / 5e-3}}};
  const std::complex<double> z = one.relative_admittance(3000);
  CHECK(z.real() == test::approx(0.175 * 20 / (5e-3 * 2 * std::numbers::pi * 3000)));
  CHECK(std::abs(z.imag()) < 1e-12);
  CHECK(one.relative_admittance(0) == 0.0);
}

TEST_CASE("modes are passive, and a passive end reflects no more than arrives") {
  for (double f = 10; f < 20e3; f *= 1.01) {
    CHECK(bridge.relative_admittance(f).real() >= 0);
    CHECK(std::abs(rosin::reflection_of_end<rosin::modal_termination>{bridge}(f)) <= 1);
  }
  CHECK(rosin::reflection_of_end<rosin::rigid_termination>{}(1234) == -1.0);
}

TEST_CASE("poles are the zeros of the denominator; the memory is that of the slowest") {
  for (const double q : {0.3, 0.7, 25.0}) {
    const rosin::admittance_mode m{700, q, 1};
    const double w = 2 * std::numbers::pi * 700;
    const std::complex<double> p = m.pole();
    CHECK(std::abs(p * p + p * w / q + w * w) < 1e-9 * w * w);
    CHECK(p.real() < 0);
    CHECK(rosin::modal_termination{{m}}.memory_s() == test::approx(std::log(1e3) / -p.real()));
  }
}

TEST_CASE("a damper beside a spring: in phase with the force above its corner, springy below, and slower than it is massive") {
  const auto mode = rosin::overdamped_mode(0.01, 30);
  for (const double f : {3.0, 30.0, 300.0, 30e3}) {
    const std::complex<double> s(0, 2 * std::numbers::pi * f);
    CHECK(std::abs(mode(s) - 0.01 * s / (s + 2 * std::numbers::pi * 30)) < 0.01 * 0.012);
  }
  CHECK(mode.pole().imag() == 0);
  CHECK(mode.pole().real() == test::approx(-2 * std::numbers::pi * 30).epsilon(1e-4));
  CHECK(mode.compliance_s() == test::approx(0.01 / (2 * std::numbers::pi * 30)));
}

}  // namespace propagate_termination
