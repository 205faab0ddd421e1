// SPDX-License-Identifier: MIT
#include <rosin/simulate/modal_low_pass.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_modal_low_pass {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Frequency response by a plain sum over a fine grid, to test the kernel and response() alike.
double gain(const rosin::modal_low_pass& h, double f) {
  const int points = 40000;
  const double step = 2 * h.half_width_s() / points;
  double sum = 0;
  for (int i = 0; i <= points; ++i) {
    const double t = -h.half_width_s() + i * step;
    sum += step * h(t) * std::cos(2 * pi * f * t);
  }
  return sum;
}

}  // namespace

TEST_CASE("flat where it passes, nothing where it stops, unit gain at rest") {
  const rosin::modal_low_pass h{55e3, 64e3, 1e-5};
  CHECK(std::abs(gain(h, 0) - 1) < 2e-8);
  for (double f = 1e3; f <= 55e3; f += 3e3) CHECK(std::abs(gain(h, f) - 1) < 1.1e-5);
  for (double f = 64e3; f <= 200e3; f += 7.3e3) CHECK(std::abs(gain(h, f)) < 1.1e-5);
  CHECK(gain(h, 59.5e3) == test::approx(0.5).epsilon(0.01));
}

TEST_CASE("symmetric and of finite length: no delay") {
  const rosin::modal_low_pass h{20e3, 30e3, 1e-3};
  CHECK(h(0.3e-4) == test::approx(h(-0.3e-4)));
  CHECK(h(1.001 * h.half_width_s()) == 0.0);
  CHECK(h(0) > h(1e-5));
}

TEST_CASE("response() agrees with the plain sum, and holds off the axis") {
  const rosin::modal_low_pass h{55e3, 64e3, 1e-5};
  for (const double f : {0.0, 20e3, 59e3, 70e3}) {
    CHECK(std::abs(h.response({0, 2 * pi * f}).real() - gain(h, f)) < 2e-8);
    CHECK(std::abs(h.response({0, 2 * pi * f}).imag()) < 1e-12);
  }
  // a decaying mode passes as exp(p t): its gain is that of the complex frequency
  const std::complex<double> p{-2e3, 2 * pi * 10e3};
  std::complex<double> sum = 0;
  const double step = 1e-8;
  for (double t = -h.half_width_s(); t <= h.half_width_s(); t += step) sum += step * h(t) * std::exp(-p * t);
  CHECK(std::abs(h.response(p) - sum) < 1e-6);
}

TEST_CASE("the Gauss rule is exact to the seventh power") {
  double seventh = 0, eighth = 0;
  for (std::size_t j = 0; j < 4; ++j) {
    seventh += rosin::gauss4::weight[j] * std::pow(rosin::gauss4::node[j], 7);
    eighth += rosin::gauss4::weight[j] * std::pow(rosin::gauss4::node[j], 8);
  }
  CHECK(seventh == test::approx(1.0 / 8).epsilon(1e-13));
  CHECK(std::abs(eighth - 1.0 / 9) > 1e-6);
}

}  // namespace simulate_modal_low_pass
