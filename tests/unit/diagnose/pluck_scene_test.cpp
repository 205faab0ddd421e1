// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pluck_scene.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

using complex = std::complex<double>;

TEST_CASE("a sensor's pole is where its response has no bound, and at rest it passes everything") {
  const rosin::sensor_response sensor{.resonance_Hz = 18e3, .q = 11};
  const complex s = sensor.pole();
  CHECK(s.imag() > 0);
  CHECK(s.real() < 0);
  CHECK(std::abs(sensor(s * (1.0 + 1e-9))) > 1e6);
  CHECK(std::abs(sensor(0.0) - 1.0) < 1e-12);
  const double w = 2 * std::numbers::pi * 18e3;
  CHECK(std::abs(sensor({0, w})) == test::approx(11));
}

TEST_CASE("a high-pass and a delay act as they are written") {
  const rosin::sensor_response sensor{.corner_Hz = 2, .delay_s = 1e-6};
  const double w = 2 * std::numbers::pi * 2;
  CHECK(std::abs(sensor({0, w})) == test::approx(std::sqrt(0.5)));
  const double high = 2 * std::numbers::pi * 5000;
  CHECK(std::arg(sensor({0, high})) == test::approx(-high * 1e-6 + std::atan(w / high)));
}

TEST_CASE("ends that give way take power and never return it") {
  rosin::yielding_end end{
      .modes = {{.frequency_Hz = 900, .q = 12, .per_mass_per_s = 50}, {.frequency_Hz = 4000, .q = 30, .per_mass_per_s = 9}}};
  CHECK_FALSE(end.rigid());
  for (double f = 10; f < 60e3; f *= 1.1) CHECK(end.admittance({0, 2 * std::numbers::pi * f}).real() > 0);
  const double w = 2 * std::numbers::pi * 900;
  CHECK(rosin::yielding_end{.modes = {{.frequency_Hz = 900, .q = 12, .per_mass_per_s = 50}}}.admittance({0, w}).real() ==
        test::approx(50 * 12 / w));
}

TEST_CASE("a load on a bond is softer than the load, and hard as the bond when the load is heavy") {
  const rosin::scatterer held{.mass_s = 1e-4, .bond_s = 1e-6};
  const complex s{0, 2 * std::numbers::pi * 1e6};
  CHECK(std::abs(held.impedance(s)) == test::approx(1 / std::abs(s * 1e-6)).epsilon(1e-2));
  CHECK(rosin::pluck_scene{}.plain_string());
}

TEST_CASE("a damper that answers early has mass, an end that answers late gives energy back above its mode") {
  const rosin::scatterer damper{.resistance = 0.02, .lag_s = -1e-6}, massive{.mass_s = 0.02e-6, .resistance = 0.02};
  const complex s{0, 2 * std::numbers::pi * 5e3};
  CHECK(std::abs(damper.impedance(s) - massive.impedance(s)) < 1e-3 * std::abs(damper.impedance(s)));
  const rosin::yielding_end late{.modes = {{.frequency_Hz = 900, .q = 1000, .per_mass_per_s = 50}}, .lag_s = 1e-6};
  CHECK(late.admittance({0, 2 * std::numbers::pi * 20e3}).real() == test::approx(-50 * 1e-6).epsilon(0.02));
}
