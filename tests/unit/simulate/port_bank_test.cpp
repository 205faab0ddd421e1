// SPDX-License-Identifier: MIT
#include <rosin/simulate/port_bank.hpp>

#include <doctest/doctest.h>

#include <random>

#include "support/approx.hpp"

namespace simulate_port_bank {

namespace {

const rosin::modal_rig rig{
    {.length_m = 0.32, .tension_N = 70, .fundamental_Hz = 640, .bending_stiffness_Nm2 = 4e-5, .loss = {.quality = 1000}},
    {},
    rosin::damping_convention::kelvin_voigt};
constexpr double step_s = 1 / 512e3;

}  // namespace

TEST_CASE("with point ports alone it does what modal_bank does, step by step") {
  rosin::port_bank bank{rig, 0, 60e3, step_s};
  Eigen::MatrixXd shape(bank.size(), 2);
  shape << bank.at(0.3, false), bank.at(0.77, false);
  bank.set_ports(shape);
  rosin::modal_bank<2> peer{rosin::transverse_modes(rig.string, 60e3), rig.damping, {0.3, 0.77}, step_s};
  std::mt19937 random{1};
  std::normal_distribution<double> normal;
  Eigen::VectorXd velocity;
  Eigen::Vector2d end;
  for (int n = 0; n < 300; ++n) {
    const Eigen::Vector2d force(normal(random), normal(random));
    bank.read_free(velocity, end);
    for (Eigen::Index i = 0; i < 2; ++i)
      CHECK(velocity[i] == test::approx(peer.free().velocity[static_cast<std::size_t>(i)]).scale(0.1).epsilon(1e-9));
    CHECK(end[0] == test::approx(peer.free().near).scale(0.1).epsilon(1e-9));
    CHECK(end[1] == test::approx(peer.free().far).scale(0.1).epsilon(1e-9));
    bank.advance(force);
    peer.advance({force[0], force[1]});
  }
  CHECK(bank.mobility(0, 1) == test::approx(peer.mobility(0, 1)));
}

TEST_CASE("at rest under a force it stays at rest, and the tension that its deflection raises is Kirchhoff and Carrier's") {
  constexpr double force = 2, axial = 1e4;
  for (const double e_a : {0.0, axial}) {
    rosin::port_bank bank{rig, e_a, 250e3, step_s};
    bank.set_ports(bank.at(0.4, false));
    bank.rest_under(Eigen::VectorXd::Constant(1, force));
    Eigen::VectorXd velocity;
    Eigen::Vector2d end;
    double drift = 0;
    for (int n = 0; n < 200; ++n) {
      bank.read_free(velocity, end);
      drift = std::max(drift, std::abs((velocity + bank.mobility * Eigen::VectorXd::Constant(1, force))[0]));
      bank.advance(Eigen::VectorXd::Constant(1, force));
    }
    CHECK(drift < 1e-9);
    const double near = (end + bank.end_gain * force)[0];
    CHECK(near == test::approx(0.6 * force).epsilon(5e-3));  // with or without: two straight pieces
  }
}

TEST_CASE("strain of a string that is held in a triangle") {
  constexpr double force = 2, place = 0.4;
  auto soft = rig;
  soft.string.bending_stiffness_Nm2 = 0;
  rosin::port_bank bank{soft, 0, 250e3, step_s};
  bank.set_ports(bank.at(place, false));
  bank.rest_under(Eigen::VectorXd::Constant(1, force));
  bank.advance(Eigen::VectorXd::Constant(1, force));
  CHECK(bank.strain() == test::approx(std::pow(force / soft.string.tension_N, 2) * place * (1 - place) / 2).epsilon(5e-3));
}

TEST_CASE("a free string keeps to the pitch that its mean tension gives") {
  // Duffing: a mode of amplitude a sounds higher by (3/8) (E A / (4 T)) k^2 a^2.
  auto one = rig;
  one.string.loss.quality = 1e7, one.string.bending_stiffness_Nm2 = 0;
  const double axial = 1e4, k = 3.14159265358979323846 / one.string.length_m, amplitude = 1.5e-3;
  rosin::port_bank bank{one, axial, 700, step_s};  // the first mode alone
  REQUIRE(bank.size() == 1);
  bank.set_ports(bank.at(0.5, false));
  const double raised = axial / 4 * k * k * amplitude * amplitude / one.string.tension_N;
  bank.rest_under(Eigen::VectorXd::Constant(1, bank.mass[0] * bank.omega[0] * bank.omega[0] * amplitude * (1 + raised)));
  Eigen::VectorXd velocity;
  Eigen::Vector2d end;
  double before = 0, first = 0, last = 0;
  int crossings = 0;
  for (int n = 0; n < 80000; ++n) {
    bank.advance(Eigen::VectorXd::Zero(1));
    bank.read_free(velocity, end);
    if (before < 0 && velocity[0] >= 0) {
      last = n + before / (before - velocity[0]);
      if (crossings++ == 0) first = last;
    }
    before = velocity[0];
  }
  const double pitch = (crossings - 1) / ((last - first) * step_s);
  CHECK(pitch / one.string.fundamental_Hz - 1 == test::approx(3.0 / 8 * raised).epsilon(0.02));
}

}  // namespace simulate_port_bank
