// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_stick.hpp>

#include <doctest/doctest.h>

#include <random>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

namespace {

rosin::stick_rows line(std::mt19937& source, double slope) {
  std::normal_distribution<double> normal;
  rosin::stick_rows r;
  r.target.resize(500);
  r.shared.resize(500, 1);
  r.own = Eigen::MatrixXd::Ones(500, 1);
  for (Eigen::Index i = 0; i < 500; ++i) {
    r.shared(i, 0) = normal(source);
    r.target[i] = slope * r.shared(i, 0) + 1 + 0.1 * normal(source);
    r.sample.push_back(static_cast<std::size_t>(i));
  }
  return r;
}

}  // namespace

TEST_CASE("contact stick: coefficients are held at their bounds, and prediction tells what takes share") {
  std::mt19937 source(1);
  rosin::stick_design same{{line(source, 2), line(source, 2)}, {{-9, 9}}}, other{{line(source, 2), line(source, 3)}, {{-9, 9}}};
  const auto good = rosin::fit_design(same, 0), bad = rosin::fit_design(other, 0);
  CHECK(good.solution.shared[0] == test::approx(2).epsilon(0.01));
  CHECK(good.density - good.held_out < 30);
  CHECK(bad.density - bad.held_out > 100);
  same.bounds = {{-1, 1.5}};
  CHECK(rosin::fit_design(same, 0).solution.shared[0] == test::approx(1.5).epsilon(1e-4));
  rosin::stick_design one{{same.rows[0]}, {{-9, 9}}};  // a single take is predicted half from half
  CHECK(std::abs(rosin::fit_design(one, 0).density - rosin::fit_design(one, 0).held_out) < 30);
}

TEST_CASE("contact stick: as declared, the surface moves with the rod to within noise") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 1);
  rosin::stick_bench bench({a.take()}, contact_rigs::declared());
  REQUIRE(bench.usable());
  CHECK(bench.damping() == rosin::torsion_damping::viscous_modes);  // of the simulation
  CHECK(bench.fit().solution.scale < 0.012 * bench.speed_m_s());
  CHECK(bench.independent() > 100);
  // a string that does not turn would leave many times more
  const auto rigid = rosin::fit_design(bench.equation(std::nullopt, bench.damping(), false), bench.floor_m_s());
  CHECK(rigid.solution.scale > 5 * bench.fit().solution.scale);
  CHECK(bench.gains(rigid)[0] < -200);
}

TEST_CASE("contact stick: of a string that is damped mode by mode waves tell too high a velocity, by f / (2 pi Z Q)") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 1);
  const rosin::contact_take t = a.take();
  rosin::stick_bench bench({t}, contact_rigs::declared());
  REQUIRE(bench.usable());
  const double expected = 1e-3 / (2 * std::numbers::pi * t.impedance_Ns_m);
  const auto& found = bench.fit().solution.shared;  // torsion's three, its trend, the force
  CHECK(found[4] == test::approx(-expected).epsilon(0.35));
}

TEST_CASE("contact stick: nothing to work on") {
  const rosin::stick_bench none({}, {});
  CHECK_FALSE(none.usable());
}
