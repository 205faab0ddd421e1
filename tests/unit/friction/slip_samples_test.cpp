// SPDX-License-Identifier: MIT
#include <rosin/friction/slip_samples.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace friction_slip_samples {

TEST_CASE("slip samples: speed and coefficient of friction inside the slips, in either direction of the stroke") {
  std::vector<double> force(400, 0.1), relative(400, 0.0);
  for (std::size_t i = 100; i < 140; ++i) force[i] = 0.15, relative[i] = -0.6;
  for (const double way : {1.0, -1.0}) {
    std::vector<double> f = force, v = relative;
    for (std::size_t i = 0; i < f.size(); ++i) f[i] *= way, v[i] *= way;
    const auto phases = rosin::find_phases(v, way * 0.2);
    const auto s = rosin::slips_of(f, v, phases, way * 0.2, 0.3, 0, 3);
    REQUIRE(s.sample.size() == 34);
    CHECK(s.sample.front() == 103);
    CHECK(s.sample.back() == 136);
    CHECK(s.speed_m_s[5] == test::approx(0.6));
    CHECK(s.friction[5] == test::approx(0.5));
  }
}

TEST_CASE("slip samples: the contact warms while it slips and cools while it sticks") {
  std::vector<double> force(2000, 0.15), relative(2000, 0.0);
  for (std::size_t i = 500; i < 700; ++i) relative[i] = -0.6;
  const auto phases = rosin::find_phases(relative, 0.2);
  const auto rise = rosin::temperature_along(force, relative, phases, 0.3, 128e3, {});
  CHECK(rise[499] == 0);
  CHECK(rise[699] > 5);
  CHECK(rise[699] > rise[550]);
  CHECK(rise[1500] < 0.5 * rise[699]);
  // the energy of the slip cannot warm the layer by more than all of it
  const rosin::contact_heat_parameters<double> heat;
  const double energy = 0.15 * 0.6 * 200 / 128e3, capacity = heat.layer_capacity_J_m2K() * heat.area_per_newton_m2 * 0.3;
  CHECK(rise[699] < energy / capacity);
}

TEST_CASE("slip samples: the contact grows with its load") {
  std::vector<double> force(2000, 0.15), relative(2000, 0.0), load(2000, 1.0);
  for (std::size_t i = 500; i < 700; ++i) relative[i] = -0.6;
  const auto phases = rosin::find_phases(relative, 0.2);
  const auto steady = rosin::temperature_along(force, relative, phases, 0.3, 128e3, {});
  CHECK(rosin::temperature_along(force, relative, phases, 0.3, 128e3, {}, load) == steady);
  const std::vector<double> half(2000, 0.5);
  CHECK(rosin::temperature_along(force, relative, phases, 0.6, 128e3, {}, half) == steady);
  std::fill(load.begin() + 600, load.end(), 1.5);
  const auto pressed = rosin::temperature_along(force, relative, phases, 0.3, 128e3, {}, load);
  CHECK(pressed[699] < 0.9 * steady[699]);
}

TEST_CASE("smooth functions: a partition of one that follows curves of friction") {
  std::vector<double> x;
  for (int i = 0; i < 3000; ++i) x.push_back(1.5 * std::pow(i / 3000.0, 2));
  const rosin::smooth_functions functions(x);
  const Eigen::VectorXd at = Eigen::Map<const Eigen::VectorXd>(x.data(), 3000);
  const Eigen::MatrixXd B = functions(at);
  CHECK(B.cols() == 11);
  for (Eigen::Index i = 0; i < B.rows(); ++i) {
    CHECK(B.row(i).sum() == test::approx(1));
    CHECK(B.row(i).minCoeff() > -1e-12);
  }
  const Eigen::VectorXd mu = (0.45 * (-at.array() / 0.1).exp() + 0.35).matrix();
  const Eigen::VectorXd fitted = B * B.colPivHouseholderQr().solve(mu);
  CHECK((fitted - mu).cwiseAbs().maxCoeff() < 0.01);
  // what lies outside is taken at the ends
  const Eigen::MatrixXd outside = functions(Eigen::Vector2d(-1, 99));
  CHECK(outside(0, 0) == test::approx(1));
  CHECK(outside(1, 10) == test::approx(1));
}

}  // namespace friction_slip_samples
