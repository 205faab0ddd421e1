// SPDX-License-Identifier: MIT
#include <rosin/diagnose/stick_columns.hpp>

#include <doctest/doctest.h>

#include <complex>

#include "support/approx.hpp"

TEST_CASE("stick columns: bristles are a spring with a delay") {
  const double f = 500, w = 2 * std::numbers::pi * f;
  CHECK(std::abs(rosin::bristle_bending(f, 0) - std::complex<double>(0, -1e-6 * w)) < 1e-12);
  CHECK(std::abs(rosin::bristle_bending(1e7, 1e-4) + 1e-6 / 1e-4) < 1e-4);  // dampers at last
}

TEST_CASE("stick columns: creep is against the force, and grows e-fold for each share of the normal force") {
  const auto v = rosin::creep_column({0.5, -0.5, 0.4, 0}, 0.5, 0.2);
  CHECK(v[0] == test::approx(-1));
  CHECK(v[1] == test::approx(1));
  CHECK(v[2] == test::approx(-std::exp(-1.0)));
  CHECK(std::abs(v[3]) == test::approx(std::exp(-5.0)));
  CHECK(rosin::creep_column({50}, 0.5, 0.2)[0] == test::approx(-std::exp(4.0)));  // no further
}

TEST_CASE("stick columns: a rod moves by its spring below its resonance, by its mass above, and by its loss there") {
  const rosin::rod_mobility rod{800, 40, 0.003};
  const double w0 = 2 * std::numbers::pi * 800;
  CHECK(std::abs(rod(800) + 40 / (w0 * 0.003)) < 1e-9 * std::abs(rod(800)));
  const double slow = 2 * std::numbers::pi * 8, fast = 2 * std::numbers::pi * 80000;
  CHECK(std::abs(rod(8) - std::complex<double>(0, -slow / (0.003 * w0 * w0))) < 1e-3 * std::abs(rod(8)));
  CHECK(std::abs(rod(80000) - std::complex<double>(0, 1 / (fast * 0.003))) < 1e-3 * std::abs(rod(80000)));
  CHECK(std::exp(-std::numbers::pi * 800 / 40 * rod.memory_s()) == test::approx(1e-3));
}

TEST_CASE("stick columns: a ripple is a share of the rod's speed; noise passes the window by three eighths of its power") {
  const std::vector<double> force(4000, 0.2), velocity(4000, 0.2);
  const rosin::stick_record record({force, velocity, 128e3, 0.2, {2e-4, 5e-4}, 0.17, 1e-3, 57600, 0.005});
  const auto wave = rosin::rod_wave(record, 320, 0.5 * std::numbers::pi);
  CHECK(wave.size() == record.size());
  CHECK(wave[0] == test::approx(0.2));
  CHECK(wave[200] == test::approx(-0.2));
  const auto one = [](double) { return std::array<std::complex<double>, 2>{1, 0}; };
  CHECK(rosin::detail::noise_of_ends(one, {3e-4, 1}, 128e3, record.window()) ==
        test::approx(3e-4 * std::sqrt(0.375 * 2 * 57600 / 128e3)).epsilon(1e-3));
}
