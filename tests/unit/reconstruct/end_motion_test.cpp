// SPDX-License-Identifier: MIT
#include <rosin/reconstruct/end_motion.hpp>

#include <rosin/propagate/termination_table.hpp>

#include <doctest/doctest.h>

namespace reconstruct_end_motion {

namespace {

constexpr double rate_Hz = 48e3, pi = std::numbers::pi;
const rosin::band limits{14e3, 22e3};

/// A tone burst cos(w t) that sets in as a Gaussian.
std::vector<double> tone(double f, std::size_t count) {
  std::vector<double> x(count);
  for (std::size_t n = 0; n < count; ++n) {
    const double t = static_cast<double>(n) / rate_Hz, rise = std::min(0.0, t - 0.02) / 0.003;
    x[n] = std::cos(2 * pi * f * t) * std::exp(-rise * rise);
  }
  return x;
}

/// m q'' + m w/Q q' + m w^2 q = F by Runge and Kutta, 16 steps a sample, F by its formula.
std::vector<double> integrated(const rosin::admittance_mode& m, double f, std::size_t count) {
  const double w = 2 * pi * m.frequency_Hz, h = 1 / rate_Hz / 16;
  const auto force = [&](double t) {
    const double rise = std::min(0.0, t - 0.02) / 0.003;
    return std::cos(2 * pi * f * t) * std::exp(-rise * rise);
  };
  const auto slope = [&](double t, double x, double v) {
    return std::pair{v, m.per_mass_per_s * force(t) - w / m.q * v - w * w * x};
  };
  double x = 0, v = 0;
  std::vector<double> out(count);
  for (std::size_t n = 0; n < count; ++n) {
    out[n] = v;
    for (int i = 0; i < 16; ++i) {
      const double t = static_cast<double>(n) / rate_Hz + i * h;
      const auto [a1, b1] = slope(t, x, v);
      const auto [a2, b2] = slope(t + h / 2, x + h / 2 * a1, v + h / 2 * b1);
      const auto [a3, b3] = slope(t + h / 2, x + h / 2 * a2, v + h / 2 * b2);
      const auto [a4, b4] = slope(t + h, x + h * a3, v + h * b3);
      x += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      v += h / 6 * (b1 + 2 * b2 + 2 * b3 + b4);
    }
  }
  return out;
}

double worst(const std::vector<double>& a, const std::vector<double>& b, std::size_t begin, std::size_t end) {
  double most = 0, size = 0;
  for (std::size_t i = begin; i < end; ++i) most = std::max(most, std::abs(a[i] - b[i])), size = std::max(size, std::abs(b[i]));
  return most / size;
}

}  // namespace

TEST_CASE("a mode moves as its equation of motion says, transient included") {
  for (const rosin::admittance_mode m : {rosin::admittance_mode{900, 40, 35}, {7000, 6, 20}, {300, 0.3, 100}, {500, 0.5, 100}})
    for (const double f : {250.0, 6500.0, 12e3}) {
      const std::vector<double> force = tone(f, 3000);
      const rosin::end_motion moved = rosin::motion_of_end(rosin::modal_termination{{m}}, force, limits, rate_Hz);
      CHECK(moved.known.begin < 200);
      CHECK(worst(moved.times_impedance_N, integrated(m, f, 3000), moved.known.begin, moved.known.end) < 1e-4);
    }
}

TEST_CASE("under a force that was always there an end is at rest, and what was before the record is forgotten in time") {
  const rosin::modal_termination bridge{{{460, 35, 1.4}, {2400, 15, 6}}};
  const rosin::end_motion still = rosin::motion_of_end(bridge, std::vector<double>(2000, 0.7), limits, rate_Hz);
  for (const double v : still.times_impedance_N) CHECK(std::abs(v) < 1e-7);
  std::vector<double> moving(static_cast<std::size_t>(3 * bridge.memory_s() * rate_Hz));
  for (std::size_t n = 0; n < moving.size(); ++n) moving[n] = std::sin(2 * pi * 470 * static_cast<double>(n) / rate_Hz);
  const std::vector<double> later(moving.begin() + 1000, moving.end());
  const rosin::end_motion whole = rosin::motion_of_end(bridge, moving, limits, rate_Hz),
                          part = rosin::motion_of_end(bridge, later, limits, rate_Hz);
  double most = 0, size = 0;
  for (std::size_t n = part.settled; n + 200 < later.size(); ++n)
    most = std::max(most, std::abs(part.times_impedance_N[n] - whole.times_impedance_N[n + 1000])),
    size = std::max(size, std::abs(part.times_impedance_N[n]));
  CHECK(most < 2e-3 * size);
}

TEST_CASE("a rigid end does not move") {
  const std::vector<double> force(100, 0.3);
  const auto still = rosin::motion_of_end(rosin::rigid_termination{}, force, limits, rate_Hz);
  CHECK(still.times_impedance_N == std::vector<double>(100, 0.0));
  CHECK(still.known.end == 100);
}

TEST_CASE("a measured table moves as the modes that it was measured on") {
  const rosin::modal_termination body{{{460, 15, 1.4}, {2400, 8, 6}}};
  std::vector<rosin::measured_admittance> table;
  for (double f = 4; f < 16e3; f += 4) table.push_back({f, body.relative_admittance(f) / 0.175});
  const auto end = rosin::complete_admittance(table, 0.175);
  REQUIRE(end);
  const std::vector<double> force = tone(520, 4000);
  const auto by_table = rosin::motion_of_end(*end, force, limits, rate_Hz),
             by_modes = rosin::motion_of_end(body, force, limits, rate_Hz);
  CHECK(worst(by_table.times_impedance_N, by_modes.times_impedance_N, 300, 3700) < 0.01);
  CHECK(by_table.settled > by_table.known.begin);
}

}  // namespace reconstruct_end_motion
