// SPDX-License-Identifier: MIT
#include <rosin/calibrate/partial_line.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/approx.hpp"

namespace {

using complex = std::complex<double>;
constexpr double line_rate_Hz = 200;

std::vector<complex> line(double decay, double detuning, complex amplitude, std::size_t n = 200) {
  std::vector<complex> z;
  for (std::size_t j = 0; j < n; ++j)
    z.push_back(amplitude * std::exp(complex(-decay, detuning) * (static_cast<double>(j) / line_rate_Hz)));
  return z;
}

}  // namespace

TEST_CASE("a damped line is found from near it, amplitude and all") {
  const auto z = line(1.7, 12, {0.3, -0.4});
  const rosin::line_fit fit = rosin::fit_line(z, line_rate_Hz, {{{1.0, 1.0, 11.0}}, 440});
  CHECK(fit.model.parts[0].decay_per_s == test::approx(1.7).epsilon(1e-6));
  CHECK(fit.model.parts[0].detuning_rad_s == test::approx(12).epsilon(1e-6));
  CHECK(std::abs(fit.model.parts[0].amplitude - complex(0.3, -0.4)) < 1e-6);
  CHECK(fit.residual < 1e-9);
}

TEST_CASE("least-squares amplitudes leave what is orthogonal") {
  const auto z = line(1, 5, {2, 1});
  rosin::line_model m{{{1.0, 1.0, 5.0}}, 0};
  CHECK(rosin::solve_amplitudes(z, line_rate_Hz, m) < 1e-9);
  CHECK(std::abs(m.parts[0].amplitude - complex(2, 1)) < 1e-9);
}

TEST_CASE("energy of a part, and the path of a glide, are their integrals") {
  const rosin::damped_part p{{3, 4}, 0.7, 0};
  CHECK(p.energy(2) == test::approx(25 * (1 - std::exp(-2.8)) / 1.4));
  CHECK(rosin::damped_part{{3, 4}, 0, 0}.energy(2) == test::approx(50));
  CHECK(rosin::pitch_glide{1e-3, 4}.path_s(0.5) == test::approx((1 - std::exp(-2.0)) / 4));
}
