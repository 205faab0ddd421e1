// SPDX-License-Identifier: MIT
#include <rosin/simulate/moving_support.hpp>

#include <rosin/simulate/mode_step.hpp>

#include <doctest/doctest.h>

#include <cmath>

#include "support/approx.hpp"

namespace simulate_moving_support {

namespace {

constexpr double step_s = 1 / 1024e3, pi = 3.14159265358979323846;
const rosin::yielding_support low{0.004, 700, 20}, high{0.0015, 5200, 8};

rosin::driven_mode exact(const rosin::yielding_support& s) {
  return {{1, 2 * pi * s.frequency_Hz, 1 / s.quality, s.mass_kg, 0}, step_s};
}

}  // namespace

TEST_CASE("modes of an end under one force move as each would by itself, exactly stepped") {
  rosin::moving_support end{0, {{low}, {high}}};
  auto first = exact(low), second = exact(high);
  double off = 0, all = 0;
  for (int n = 1; n < 40000; ++n) {
    const double force = 0.5 * std::sin(2 * pi * 660 * n * step_s) + 0.2 * std::sin(2 * pi * 9000 * n * step_s);
    const auto [inertia, held] = end.inertia_and_force(step_s);
    const double before = end.sum(&rosin::moving_mode::v), g0 = end.sum(&rosin::moving_mode::g);
    end.move(step_s, force);
    const double g = end.sum(&rosin::moving_mode::g), v = end.sum(&rosin::moving_mode::v);
    CHECK(std::abs(inertia * g + force - held) < 1e-9);  // the equation that the string solves
    CHECK(std::abs(v - (before - step_s * (g0 + g) / 2)) < 1e-15);
    const double truth = first.advance(force).velocity + second.advance(force).velocity;
    off += std::pow(v - truth, 2), all += truth * truth;
  }
  CHECK(std::sqrt(off / all) < 1e-4);
}

TEST_CASE("at rest every mode holds the same force, and stays") {
  rosin::moving_support end{1, {{low}, {high}}};
  end.rest_at(1e-5);
  const double force = end.stiffness() * 1e-5;
  CHECK(end.sum(&rosin::moving_mode::u) == test::approx(1e-5));
  CHECK(end.modes[0].u * end.modes[0].stiffness() == test::approx(end.modes[1].u * end.modes[1].stiffness()));
  for (int n = 0; n < 1000; ++n) end.move(step_s, force);
  CHECK(end.sum(&rosin::moving_mode::u) == test::approx(1e-5));
}

}  // namespace simulate_moving_support
