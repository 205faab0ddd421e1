// SPDX-License-Identifier: MIT
#include <rosin/diagnose/stick_design.hpp>

#include <doctest/doctest.h>

#include <random>

#include "support/approx.hpp"

namespace {

/// Two takes of 2 a - 3 b + a level of their own, with noise of a hundredth.
rosin::stick_design two_takes() {
  std::mt19937 source(3);
  std::normal_distribution<double> normal;
  rosin::stick_design d;
  for (const double level : {0.5, -1.0}) {
    rosin::stick_rows r;
    r.target.resize(400);
    r.shared.resize(400, 0);
    r.own = Eigen::MatrixXd::Ones(400, 1);
    std::vector<double> a, b;
    for (int i = 0; i < 400; ++i) {
      a.push_back(normal(source)), b.push_back(normal(source));
      r.target[i] = 2 * a.back() - 3 * b.back() + level + 0.01 * normal(source);
      r.sample.push_back(static_cast<std::size_t>(i));
    }
    d.rows.push_back(std::move(r));
    d.add_shared(d.rows.size() - 1, a);
    d.add_shared(d.rows.size() - 1, b);
  }
  d.add_bound(-10, 10);
  d.add_bound(-10, 10);
  return d;
}

}  // namespace

TEST_CASE("stick design: coefficients inside their bounds are found, those outside are held at the nearest") {
  auto d = two_takes();
  const auto free = rosin::fit_design(d, 1e-6);
  CHECK(free.solution.shared[0] == test::approx(2).epsilon(1e-3));
  CHECK(free.solution.shared[1] == test::approx(-3).epsilon(1e-3));
  CHECK(free.solution.own[1][0] == test::approx(-1).epsilon(2e-3));
  CHECK(free.solution.scale < 0.012);
  d.bounds[1] = {-1, 1};
  const auto held = rosin::fit_design(d, 1e-6);
  CHECK(held.solution.shared[1] == test::approx(-1).epsilon(1e-6));
  CHECK(held.density < free.density - 1000);
  CHECK(held.held_out < free.held_out - 1000);  // each take as the other predicts it
}

TEST_CASE("stick design: what one take has by itself does not predict the other") {
  auto d = two_takes();
  const auto before = rosin::fit_design(d, 1e-6);
  std::vector<double> chance(400, 0.0);
  for (std::size_t i = 0; i < 400; ++i) chance[i] = i % 7 == 0 ? 1 : 0;
  d.rows[0].target += 0.05 * Eigen::Map<const Eigen::VectorXd>(chance.data(), 400);
  const auto spoilt = rosin::fit_design(d, 1e-6);
  for (const std::size_t t : {0U, 1U}) d.add_shared(t, chance);
  d.add_bound(-10, 10);
  const auto with = rosin::fit_design(d, 1e-6);
  CHECK(with.density > spoilt.density);
  CHECK(spoilt.density < before.density);
  CHECK(with.held_out < spoilt.held_out);  // the second take has none of it
}
