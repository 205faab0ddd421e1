// SPDX-License-Identifier: MIT
#include <rosin/simulate/burdened_sensors.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_burdened_sensors {

namespace {

constexpr double step_s = 1 / 2048e3, pi = 3.14159265358979323846;

std::vector<double> tone(double f, std::size_t n = 40000) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = std::cos(2 * pi * f * static_cast<double>(i) * step_s);
  return x;
}

/// Complex amplitude over whole periods at the end of the record.
std::complex<double> amplitude(const std::vector<double>& x, double f, std::size_t periods = 20) {
  const auto n = static_cast<std::size_t>(std::lround(static_cast<double>(periods) / (f * step_s)));
  std::complex<double> sum = 0;
  for (std::size_t i = x.size() - n; i < x.size(); ++i)
    sum += x[i] * std::polar(1.0, -2 * pi * f * static_cast<double>(i) * step_s);
  return 2.0 * sum / static_cast<double>(n);
}

}  // namespace

TEST_CASE("a sensor's resonance answers a tone as the equation says, and leaves a steady force alone") {
  for (const double f : {5000.0, 16000.0, 25600.0}) {
    std::array<std::vector<double>, 2> x{tone(f), std::vector<double>(40000, 0.7)};
    rosin::disturb(x, {.resonance_Hz = {20000, 18000}, .resonance_q = {8, 15}}, step_s);
    const std::complex<double> s(0, 2 * pi * f), w = 2 * pi * 20000;
    CHECK(std::abs(amplitude(x[0], f) - w * w / (s * s + s * w / 8.0 + w * w)) < 2e-3);
    for (const double y : x[1]) CHECK(std::abs(y - 0.7) < 1e-9);
  }
}

TEST_CASE("skew delays the far channel, crosstalk mixes, the quadratic share bends") {
  const double f = 16000, skew = 1.37e-6;
  std::array<std::vector<double>, 2> x{tone(f), tone(f)};
  rosin::disturb(x, {.skew_s = skew}, step_s);
  CHECK(std::abs(amplitude(x[1], f) / amplitude(x[0], f) - std::polar(1.0, -2 * pi * f * skew)) < 1e-5);
  x = {tone(f), std::vector<double>(40000, 0.0)};
  rosin::disturb(x, {.crosstalk = 0.02}, step_s);
  CHECK(std::abs(amplitude(x[1], f)) == test::approx(0.02));
  x = {tone(f), tone(f)};
  rosin::disturb(x, {.quadratic_per_N = {0, 0.1}}, step_s);
  CHECK(std::abs(amplitude(x[1], 2 * f)) == test::approx(0.05));
  CHECK(std::abs(amplitude(x[0], 2 * f)) < 1e-9);
}

TEST_CASE("a fast clock reads later moments too early, counted from where the take begins") {
  const double f = 9000, fast = 5e-5, begin_s = 0.002;
  std::array<std::vector<double>, 2> x{tone(f), tone(f)};
  rosin::disturb(x, {.clock_drift = fast}, step_s, begin_s);
  double worst = 0;
  for (std::size_t i = 10; i + 10 < x[1].size(); ++i) {
    const double t = static_cast<double>(i) * step_s;
    worst = std::max(worst, std::abs(x[1][i] - std::cos(2 * pi * f * (begin_s + (t - begin_s) / (1 + fast)))));
  }
  CHECK(worst < 1e-6);
  CHECK(x[0] == tone(f));
}

TEST_CASE("a sensor that rings at twice a tone passes on what it bends before that, and not what it bends behind it") {
  constexpr double f = 2000, q = 20, curve = 0.1;
  const auto octave = [&](bool rings_first) {
    std::array<std::vector<double>, 2> force{tone(f), tone(f)};
    rosin::sensor_faults faults;
    faults.quadratic_per_N[0] = curve, faults.resonance_Hz[0] = 2 * f, faults.resonance_q[0] = q,
    faults.rings_first[0] = rings_first;
    rosin::disturb(force, faults, step_s);
    return std::abs(amplitude(force[0], 2 * f));
  };
  const double own = 4.0 / 3;  // of the tone, an octave below the resonance
  CHECK(octave(false) == test::approx(q * curve / 2).epsilon(0.02));
  CHECK(octave(true) == test::approx(own * own * curve / 2).epsilon(0.02));
}

}  // namespace simulate_burdened_sensors
