// SPDX-License-Identifier: MIT
#include <rosin/simulate/mode_step.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_mode_step {

namespace {

using complex = std::complex<double>;

const rosin::string_mode body{1, 3000, 0.08, 0.02, 0};

}  // namespace

TEST_CASE("responses over a step, small and large, against their integrals") {
  for (const complex p : {complex{-1e-4, 1e-3}, complex{-0.02, 0.29}, complex{-0.02, 0.31}, complex{-0.5, 4.0}}) {
    const auto r = rosin::respond_over_step(p / 1e-6, 1e-6);
    complex begin = 0, end = 0;
    const int parts = 20000;
    for (int i = 0; i < parts; ++i) {
      const double u = (i + 0.5) / parts;
      begin += std::exp(p * (1 - u)) * (1 - u) / static_cast<double>(parts);
      end += std::exp(p * (1 - u)) * u / static_cast<double>(parts);
    }
    CHECK(std::abs(r.begin / 1e-6 - begin) < 2e-8);
    CHECK(std::abs(r.end / 1e-6 - end) < 2e-8);
    CHECK(std::abs(r.decay - std::exp(p)) < 1e-14);
  }
}

TEST_CASE("a mode rings with its frequency and decay, and its displacement is the integral of its velocity") {
  const double h = 2e-5;
  rosin::driven_mode mode{body, h};
  mode.advance(1);  // half a triangle
  mode.advance(0);
  const double damping = body.omega_rad_s * body.inverse_quality / 2,
               ringing = std::sqrt(body.omega_rad_s * body.omega_rad_s - damping * damping);
  auto before = mode.advance(0);
  const auto first = before;
  double worst_ring = 0, worst_sum = 0, largest = 0, sum = first.displacement;
  for (int n = 1; n < 500; ++n) {
    const auto now = mode.advance(0);
    const double t = n * h, decay = std::exp(-damping * t);
    // From displacement and velocity at one time, the textbook's free motion.
    const double expected = decay * (first.displacement * std::cos(ringing * t) +
                                     (first.velocity + damping * first.displacement) / ringing * std::sin(ringing * t));
    worst_ring = std::max(worst_ring, std::abs(now.displacement - expected));
    sum += 0.5 * h * (before.velocity + now.velocity);
    worst_sum = std::max(worst_sum, std::abs(sum - now.displacement));
    largest = std::max(largest, std::abs(now.displacement));
    before = now;
  }
  CHECK(largest > 1e-9);
  CHECK(worst_ring < 1e-11 * largest);
  CHECK(worst_sum < 1e-3 * largest);  // the trapezoidal rule: (omega h)^2 / 12 a step
}

TEST_CASE("held at rest it stays, and the force that holds it is the stiffness times the displacement") {
  const double x = 1e-4, force = x * body.omega_rad_s * body.omega_rad_s * body.mass_kg;
  rosin::driven_mode mode{body, 1e-5};
  mode.rest_at(x, force);
  for (int n = 0; n < 100; ++n) {
    const auto s = mode.advance(force);
    CHECK(std::abs(s.velocity) < 1e-12);
    CHECK(s.displacement == test::approx(x).epsilon(1e-10));
  }
}

TEST_CASE("mobility is the velocity per force at the step's end, and a mode that does not move has none") {
  rosin::driven_mode mode{body, 1e-5};
  const double without = mode.free();
  CHECK(mode.advance(2).velocity - without == test::approx(2 * mode.mobility()).epsilon(1e-12));
  rosin::driven_mode still;
  CHECK(still.mobility() == 0);
  CHECK(still.advance(3).velocity == 0);
  CHECK(still.advance(3).displacement == 0);
}

}  // namespace simulate_mode_step
