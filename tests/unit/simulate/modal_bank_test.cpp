// SPDX-License-Identifier: MIT
#include <rosin/simulate/modal_bank.hpp>

#include <random>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_modal_bank {

namespace {

using complex = std::complex<double>;

std::vector<rosin::string_mode> three_modes() {
  return {{1, 4000, 0.02, 6e-5, 900}, {2, 8100, 0.1, 6e-5, 1800}, {3, 50000, 0.3, 6e-5, 2700}};
}

/// Displacement and velocity of each mode by the classical Runge-Kutta method under forces that run straight between steps.
struct integrated {
  std::vector<rosin::string_mode> modes = three_modes();
  std::vector<double> q = std::vector<double>(3, 0.0), v = std::vector<double>(3, 0.0);

  void step(double position, double from, double to, double h) {
    const int parts = 40;
    for (std::size_t m = 0; m < 3; ++m) {
      const auto slope = [&](double x, double u, double t) {
        const double force = (from + (to - from) * t) * modes[m].shape(position) / modes[m].mass_kg, w = modes[m].omega_rad_s;
        return std::pair{u, force - w * modes[m].inverse_quality * u - w * w * x};
      };
      for (int i = 0; i < parts; ++i) {
        const double d = h / parts, t = static_cast<double>(i) / parts, e = 1.0 / parts;
        const auto [a, b] = slope(q[m], v[m], t);
        const auto [a2, b2] = slope(q[m] + d / 2 * a, v[m] + d / 2 * b, t + e / 2);
        const auto [a3, b3] = slope(q[m] + d / 2 * a2, v[m] + d / 2 * b2, t + e / 2);
        const auto [a4, b4] = slope(q[m] + d * a3, v[m] + d * b3, t + e);
        q[m] += d / 6 * (a + 2 * a2 + 2 * a3 + a4);
        v[m] += d / 6 * (b + 2 * b2 + 2 * b3 + b4);
      }
    }
  }
};

}  // namespace

TEST_CASE("steps are exact for a force that runs straight between them") {
  for (const bool in_stress : {false, true}) {
    const double position = 0.3, h = 2e-5;
    rosin::modal_bank<1> bank{
        three_modes(), in_stress ? rosin::damping_convention::kelvin_voigt : rosin::damping_convention::viscous, {position}, h};
    integrated reference;
    std::mt19937_64 twister{3};
    double last = 0;
    for (int i = 0; i < 60; ++i) {
      const double force = static_cast<double>(twister() >> 11) * 0x1p-53 - 0.5;
      reference.step(position, last, force, h);
      double velocity = 0, near = 0, far = 0;
      for (std::size_t m = 0; m < 3; ++m) {
        const auto& mode = reference.modes[m];
        const double stress = reference.q[m] + (in_stress ? reference.v[m] * mode.inverse_quality / mode.omega_rad_s : 0.0);
        velocity += mode.shape(position) * reference.v[m];
        near += mode.end_stiffness_N_m * stress;
        far += mode.end_stiffness_N_m * stress * mode.parity();
      }
      CHECK(bank.free().velocity[0] + bank.mobility(0, 0) * force == test::approx(velocity).epsilon(1e-7));
      CHECK(std::abs(bank.free().near + bank.near_gain(0) * force - near) < 1e-7);
      CHECK(std::abs(bank.free().far + bank.far_gain(0) * force - far) < 1e-7);
      bank.advance({force});
      last = force;
    }
  }
}

TEST_CASE("work done on a lossless string is the energy found in it") {
  const rosin::string_parameters string{
      .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5};
  const double h = 1e-6;
  rosin::modal_bank<1> bank{rosin::transverse_modes(string, 60e3), rosin::damping_convention::viscous, {0.27}, h};
  double work = 0, last_force = 0, last_velocity = 0;
  for (int i = 0; i <= 2000; ++i) {
    const double force = i <= 1000 ? 0.3 * std::pow(std::sin(3.14159265358979 * i / 1000), 2) * std::cos(0.03 * i) : 0.0;
    const double velocity = bank.free().velocity[0] + bank.mobility(0, 0) * force;
    work += (force + last_force) / 2 * (velocity + last_velocity) / 2 * h;
    bank.advance({force});
    last_force = force, last_velocity = velocity;
  }
  CHECK(work > 1e-6);
  CHECK(bank.energy_J() == test::approx(work).epsilon(2e-3));
}

TEST_CASE("no sequence of forces gets energy out of it") {
  const rosin::string_parameters string{
      .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 500}};
  std::mt19937_64 twister{9};
  for (int run = 0; run < 4; ++run) {
    rosin::modal_bank<1> bank{rosin::transverse_modes(string, 250e3), rosin::damping_convention::viscous, {0.3}, 1 / (4 * 128e3)};
    double work = 0, least = 0, force = 0;
    for (int i = 0; i < 2000; ++i) {
      const double velocity = bank.free().velocity[0];
      // tries to brake: against the velocity it sees, with random strength
      force = run == 0 ? static_cast<double>(twister() >> 11) * 0x1p-53 - 0.5 : (i < 300 ? 0.1 : -0.1 * run * velocity);
      work += force * (velocity + bank.mobility(0, 0) * force);
      least = std::min(least, work);
      bank.advance({force});
    }
    CHECK(least > -1e-12);
  }
}

TEST_CASE("two ports: superposition and reciprocity, in the step and after it") {
  using bank = rosin::modal_bank<2>;
  const rosin::string_parameters string{
      .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 500}};
  const auto modes = rosin::transverse_modes(string, 100e3);
  bank first{modes, rosin::damping_convention::viscous, {0.2, 0.6}, 1e-6}, second = first, both = first;
  CHECK(first.mobility(0, 1) == test::approx(first.mobility(1, 0)));
  for (int i = 0; i < 700; ++i) {
    const double a = i < 50 ? 1.0 : 0.0, b = i < 50 ? -0.7 : 0.0;
    first.advance({a, 0});
    second.advance({0, a});
    both.advance({a, b});
    CHECK(std::abs(first.free().velocity[1] - second.free().velocity[0]) < 1e-12);
    CHECK(std::abs(both.free().near - first.free().near + 0.7 * second.free().near) < 1e-12);
  }
}

TEST_CASE("under a lasting force it comes to rest with the static shares it states") {
  auto modes = three_modes();
  for (auto& m : modes) m.inverse_quality = 0.5;
  rosin::modal_bank<1> bank{modes, rosin::damping_convention::viscous, {0.3}, 1e-5};
  for (int i = 0; i < 4000; ++i) bank.advance({2.0});
  CHECK(bank.free().near + bank.near_gain(0) * 2 == test::approx(2 * bank.near_share(0)));
  CHECK(bank.free().far + bank.far_gain(0) * 2 == test::approx(2 * bank.far_share(0)));
  double share = 0;
  for (const auto& m : modes) share += m.shape(0.3) * m.end_stiffness_N_m / (m.mass_kg * m.omega_rad_s * m.omega_rad_s);
  CHECK(bank.near_share(0) == test::approx(share));
}

TEST_CASE(
    "a port that has moved is one that was there from the start, for all that is read, and of the modes' state nothing is lost") {
  const rosin::string_parameters string{
      .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 500}};
  const auto modes = rosin::transverse_modes(string, 200e3);
  using bank = rosin::modal_bank<2>;
  bank both{modes, rosin::damping_convention::viscous, {0.2, 0.617}, 1e-6},
      moved{modes, rosin::damping_convention::viscous, {0.2, 0.9}, 1e-6};
  for (int i = 0; i < 50; ++i) both.advance({std::sin(0.4 * i), 0}), moved.advance({std::sin(0.4 * i), 0});
  moved.move_to({0.2, 0.617});
  for (std::size_t j = 0; j < 2; ++j) {
    CHECK(moved.free().velocity[j] == test::approx(both.free().velocity[j]).epsilon(1e-10));
    CHECK(moved.mobility(0, j) == test::approx(both.mobility(0, j)).epsilon(1e-10));
    CHECK(moved.near_gain(j) == test::approx(both.near_gain(j)).epsilon(1e-10));
    CHECK(moved.far_gain(j) == test::approx(both.far_gain(j)).epsilon(1e-10));
    CHECK(moved.compliance(j) == test::approx(both.compliance(j)).epsilon(1e-10));
    CHECK(moved.near_share(j) == test::approx(both.near_share(j)).epsilon(1e-10));
    CHECK(moved.far_share(j) == test::approx(both.far_share(j)).epsilon(1e-10));
  }
  both.advance({0.1, -0.7}), moved.advance({0.1, -0.7});
  CHECK(moved.free().velocity[1] == test::approx(both.free().velocity[1]).epsilon(1e-10));
  CHECK(moved.free().far == test::approx(both.free().far).epsilon(1e-10));
}

}  // namespace simulate_modal_bank
