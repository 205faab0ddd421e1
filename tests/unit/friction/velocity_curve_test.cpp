// SPDX-License-Identifier: MIT
#include <rosin/friction/velocity_curve.hpp>

#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace friction_velocity_curve {

namespace {

/// All roots of u - D + w mu(u) on (0, D], by scanning for changes of sign.
template <class Curve>
std::vector<double> roots_by_scanning(const Curve& curve, double distance, double weight) {
  std::vector<double> roots;
  const int points = 20000;
  const auto value = [&](int i) {
    const double u = distance * std::pow(static_cast<double>(i) / points, 2.0);  // finer towards zero
    return u - distance + weight * curve(u).value;
  };
  for (int i = 0; i < points; ++i)
    if ((value(i) < 0) != (value(i + 1) < 0)) roots.push_back(distance * std::pow((i + 0.5) / points, 2.0));
  return roots;
}

rosin::load_line<double> line_for(double distance, double normal = 0.3) {
  return {.free_velocity_m_s = 0.2 - distance,
          .mobility_m_Ns = 3.67,
          .rod_velocity_m_s = 0.2,
          .normal_force_N = normal,
          .step_s = 1e-6};
}

}  // namespace

TEST_CASE_TEMPLATE("Newton's method finds the largest root, and none where there is none", Curve, rosin::two_exponential_curve<>,
                   rosin::hyperbolic_curve<>, rosin::stribeck_curve<>, rosin::power_law_curve<>) {
  const Curve curve;
  std::mt19937_64 twister{5};
  std::uniform_real_distribution<double> uniform{0, 1};
  int found = 0, missing = 0;
  for (int i = 0; i < 60; ++i) {
    const double weight = 2 * uniform(twister), distance = weight * curve(0).value * 1.3 * uniform(twister);
    const auto expected = roots_by_scanning(curve, distance, weight);
    const auto root = rosin::largest_slip(curve, distance, weight);
    CAPTURE(distance);
    CAPTURE(weight);
    CHECK(root.converged);
    CHECK(root.exists == !expected.empty());
    if (root.exists && !expected.empty()) CHECK(root.speed == test::approx(expected.back()).epsilon(2e-4));
    ++(root.exists ? found : missing);
  }
  CHECK(found > 5);
  CHECK(missing > 5);
}

TEST_CASE_TEMPLATE("it settles to working precision up to the very edge where two roots merge", T, float, double) {
  const rosin::two_exponential_curve<T> curve;
  const T weight = T(1.1);
  T without = 0, with = 2;
  for (int i = 0; i < 100; ++i) {
    const T middle = (without + with) / 2;
    (rosin::largest_slip(curve, middle, weight).exists ? with : without) = middle;
  }
  for (int i = -300; i <= 300; ++i) {
    const T distance = with * (1 + static_cast<T>(i) * std::numeric_limits<T>::epsilon() / 2);
    const auto root = rosin::largest_slip(curve, distance, weight);
    CHECK(root.converged);
    if (root.exists)
      CHECK(std::abs(root.speed - distance + weight * curve(root.speed).value) < 32 * std::numeric_limits<T>::epsilon());
  }
}

TEST_CASE("a branch is kept until it is gone: release at mu(0) N, capture where the slip's root ends") {
  const rosin::two_exponential_curve<> curve;
  const double weight = 3.67 * 0.3, release = weight * curve(0).value;
  double capture = release;  // where the line first misses the curve: found independently, by scanning
  while (!roots_by_scanning(curve, capture, weight).empty()) capture -= 1e-3;
  CHECK(capture < 0.8 * release);

  rosin::velocity_curve law{curve};
  double released = 0, captured = 0;
  for (double d = 0; d < 1.3 * release; d += 1e-4)
    if (law(line_for(d)).slipping && released == 0) released = d;
  for (double d = 1.3 * release; d > 0; d -= 1e-4)
    if (!law(line_for(d)).slipping && captured == 0) captured = d;
  CHECK(released == test::approx(release).epsilon(1e-3));
  CHECK(captured == test::approx(capture).epsilon(3e-3));
}

TEST_CASE("on both branches and in both directions: on the line, on the curve, and against the slip") {
  const rosin::two_exponential_curve<> curve;
  rosin::velocity_curve law{curve};
  int stuck = 0, slipped = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto line = line_for(2.2 * std::sin(0.01 * i) + 0.3 * std::sin(0.37 * i));
    const auto contact = law(line);
    const double slip = line.slip(contact.force_N);
    CHECK(contact.force_N * slip <= 1e-15);
    if (contact.slipping) CHECK(std::abs(contact.force_N) == test::approx(0.3 * curve(std::abs(slip)).value).epsilon(1e-10));
    else CHECK(slip == test::approx(0.0).scale(1));
    CHECK(std::abs(contact.force_N) <= 0.3 * curve(0).value + 1e-12);
    ++(contact.slipping ? slipped : stuck);
  }
  CHECK(stuck > 500);
  CHECK(slipped > 500);
}

TEST_CASE("off the string there is no force, and the first touch finds its branch; reset is as new") {
  rosin::velocity_curve law{rosin::two_exponential_curve<>{}};
  CHECK(law(line_for(1.0, 0.0)).force_N == 0.0);
  CHECK(law(line_for(1.0, -0.1)).slipping);
  CHECK(!law(line_for(0.1)).slipping);
  CHECK(law(line_for(2.0)).slipping);
  CHECK(law(line_for(1.0)).slipping);  // between capture and release
  law.reset();
  CHECK(!law(line_for(1.0)).slipping);
}

}  // namespace friction_velocity_curve
