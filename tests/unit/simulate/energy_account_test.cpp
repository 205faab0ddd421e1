// SPDX-License-Identifier: MIT
#include <rosin/simulate/energy_account.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_energy_account {

namespace {

constexpr double pi = 3.14159265358979323846;

std::vector<rosin::string_mode> modes() { return {{1, 4000, 0.02, 6e-5, 0}, {2, 8100, 0.1, 6e-5, 0}, {3, 50000, 0.3, 6e-5, 0}}; }

/// By the classical Runge-Kutta method: received, lost and stored.
rosin::motion_energy integrated(const std::vector<double>& force, const std::vector<double>& at, double h) {
  rosin::motion_energy sum;
  for (const auto& m : modes()) {
    std::array<double, 4> y{};  // q, q', received, lost
    for (std::size_t n = 0; n < force.size(); ++n) {
      const double last = n == 0 ? 0 : force[n - 1] * m.shape(at[n - 1]), now = force[n] * m.shape(at[n]);
      const auto slope = [&](const std::array<double, 4>& s, double u) {
        const double g = last + (now - last) * u, drag = m.mass_kg * m.omega_rad_s * m.inverse_quality;
        return std::array{s[1], (g - drag * s[1]) / m.mass_kg - m.omega_rad_s * m.omega_rad_s * s[0], g * s[1],
                          drag * s[1] * s[1]};
      };
      const auto plus = [](std::array<double, 4> a, double by, const std::array<double, 4>& b) {
        for (std::size_t i = 0; i < 4; ++i) a[i] += by * b[i];
        return a;
      };
      constexpr int parts = 30;
      for (int i = 0; i < parts; ++i) {
        const double d = h / parts, u = static_cast<double>(i) / parts;
        const auto k1 = slope(y, u), k2 = slope(plus(y, d / 2, k1), u + 0.5 / parts),
                   k3 = slope(plus(y, d / 2, k2), u + 0.5 / parts), k4 = slope(plus(y, d, k3), u + 1.0 / parts);
        y = plus(plus(plus(plus(y, d / 6, k1), d / 3, k2), d / 3, k3), d / 6, k4);
      }
    }
    sum.stored_J += m.mass_kg / 2 * (y[1] * y[1] + std::pow(m.omega_rad_s * y[0], 2));
    sum.received_J += y[2], sum.lost_J += y[3];
  }
  return sum;
}

}  // namespace

TEST_CASE("work received, stored and lost are those of the equation of motion, at rest and travelling") {
  const double h = 2e-5;
  for (const bool travels : {false, true}) {
    std::vector<double> force, at;
    for (int n = 0; n < 200; ++n)
      force.push_back(std::sin(0.3 * n) + 0.4 * std::sin(1.7 * n * n)), at.push_back(travels ? 0.2 + 0.001 * n : 0.2);
    const auto wanted = integrated(force, at, h);
    rosin::energy_account account{modes(), h};
    const std::span<const double> all{force}, way{at};
    account.follow(all.first(71), travels ? way.first(71) : way.first(1));  // in two parts
    account.follow(all.subspan(71), travels ? way.subspan(71) : way.first(1));
    const auto found = account.total();
    CHECK(found.received_J == test::approx(wanted.received_J).epsilon(1e-7));
    CHECK(found.stored_J == test::approx(wanted.stored_J).epsilon(1e-7));
    CHECK(found.lost_J == test::approx(wanted.lost_J).epsilon(1e-7));
    CHECK(std::abs(found.received_J - found.stored_J - found.lost_J) < 1e-13 * found.received_J);
  }
}

TEST_CASE("a force that lasts gives the string the energy of its deflection") {
  rosin::string_parameters string{
      .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 2}};
  rosin::energy_account account{rosin::transverse_modes(string, 50e3), 1e-5};
  account.follow(std::vector<double>(4000, 0.7), std::array{0.3});
  const auto found = account.total();
  double compliance = rosin::static_compliance_m_N(string, 0.3) - rosin::residual_compliance_m_N(string, 0.3, 50e3);
  CHECK(found.stored_J == test::approx(0.7 * 0.7 * compliance / 2).epsilon(1e-9));
  CHECK(found.lost_J > 0.3 * found.stored_J);
}

TEST_CASE("more modes than fit into a lane keep their shapes") {
  std::vector<rosin::string_mode> many;
  for (int n = 1; n <= 43; ++n) many.push_back({n, 3000.0 * n, 1e-9, 1e-4, 0});
  rosin::energy_account account{many, 1e-6};
  account.follow(std::array{1.0}, std::array{0.237});
  double wanted = 0;
  for (const auto& m : many)
    wanted += std::pow(std::sin(pi * m.number * 0.237) * std::abs(rosin::respond_over_step(m, 1e-6).end), 2) * m.mass_kg / 2;
  CHECK(account.total().stored_J == test::approx(wanted).epsilon(1e-6));
}

}  // namespace simulate_energy_account
