// SPDX-License-Identifier: MIT
#include <rosin/simulate/converter.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_converter {

namespace {

constexpr double pi = 3.14159265358979323846;

std::vector<double> tone(double f, double amplitude, std::size_t size) {
  std::vector<double> x(size);
  for (std::size_t n = 0; n < size; ++n) x[n] = amplitude * std::sin(2 * pi * f * static_cast<double>(n) / 128e3);
  return x;
}

}  // namespace

TEST_CASE("codes are rounded to the nearest and end where the range ends") {
  const std::vector<double> force{0.0, 1.0 / 64, 1.49 / 64, 1.51 / 64, -1.51 / 64, 1.98, 5.0, -2.0, -2.1};
  const auto channel = rosin::convert(force, 128e3, {.newtons_per_full_scale = 2, .bits = 8}, 1);
  CHECK(channel.codes == std::vector<std::int32_t>{0, 1, 1, 2, -2, 127, 127, -128, -128});
  CHECK(channel.clipped == 2);
  CHECK(channel.share(7) == -1.0);
  CHECK(channel.newtons()[1] == test::approx(1.0 / 64));
}

TEST_CASE("16 and 24 bits: error of at most half a step, gain included, any full scale") {
  const auto force = tone(711, 0.9, 4000);
  for (const int bits : {16, 24, 32}) {
    const rosin::converter with{.gain = 1.03, .newtons_per_full_scale = 1.65, .bits = bits};
    const auto newtons = rosin::convert(force, 128e3, with, 1).newtons();
    const double half = 1.65 * std::ldexp(0.5, 1 - bits);
    double worst = 0;
    for (std::size_t n = 0; n < force.size(); ++n) worst = std::max(worst, std::abs(newtons[n] - 1.03 * force[n]));
    CHECK(worst <= half * (1 + 1e-6));
    CHECK(worst > 0.5 * half);
  }
}

TEST_CASE("noise: white, of the size asked for, and the same for the same seed") {
  const std::vector<double> silence(200000, 0.0);
  const rosin::converter with{.newtons_per_full_scale = 1, .noise_N = 1e-3, .bits = 24};
  const auto a = rosin::convert(silence, 128e3, with, 7), again = rosin::convert(silence, 128e3, with, 7),
             b = rosin::convert(silence, 128e3, with, 8);
  CHECK(a.codes == again.codes);
  CHECK(a.codes != b.codes);
  const auto x = a.newtons();
  double mean = 0, square = 0, neighbour = 0, fourth = 0;
  for (std::size_t n = 0; n + 1 < x.size(); ++n) {
    mean += x[n], square += x[n] * x[n], neighbour += x[n] * x[n + 1], fourth += std::pow(x[n], 4);
  }
  const double size = static_cast<double>(x.size() - 1);
  CHECK(std::abs(mean / size) < 4e-3 / std::sqrt(size));
  CHECK(square / size == test::approx(1e-6).epsilon(4 * std::sqrt(2 / size)));
  CHECK(std::abs(neighbour / square) < 4 / std::sqrt(size));
  CHECK(fourth * size / (square * square) == test::approx(3.0).epsilon(0.03));  // a normal distribution's
}

TEST_CASE("AC coupling: a step decays with the time constant, a steady force has long gone") {
  const double corner = 20;
  const rosin::converter with{.newtons_per_full_scale = 2, .ac_coupled_Hz = corner, .bits = 32};
  std::vector<double> force(4000, 1.0);
  for (std::size_t n = 1000; n < force.size(); ++n) force[n] = 0.25;
  const auto x = rosin::convert(force, 128e3, with, 1).newtons();
  CHECK(std::abs(x[999]) < 1e-9);
  for (const std::size_t n : {1100U, 2000U, 3999U})  // the step is a ramp over one sample: its centre lies half a sample earlier
    CHECK(x[n] == test::approx(-0.75 * std::exp(-2 * pi * corner * (static_cast<double>(n) - 999.5) / 128e3)).epsilon(1e-6));
}

TEST_CASE("AC coupling: gain and phase of a tone are the analogue filter's") {
  const double corner = 100, f = 60;
  const rosin::converter with{.newtons_per_full_scale = 2, .ac_coupled_Hz = corner, .bits = 32};
  const auto x = rosin::convert(tone(f, 1.0, 40000), 128e3, with, 1).newtons();
  const double gain = f / std::hypot(f, corner), phase = std::atan2(corner, f);
  for (std::size_t n = 20000; n < 40000; n += 777)
    CHECK(std::abs(x[n] - gain * std::sin(2 * pi * f * static_cast<double>(n) / 128e3 + phase)) < 2e-6);
}

TEST_CASE("hum is added as stated") {
  const std::vector<double> silence(2000, 0.0);
  const rosin::converter with{.newtons_per_full_scale = 0.1, .hum = {{50, 2e-3, 0.3}, {150, 1e-3, -1}}, .bits = 32};
  const auto x = rosin::convert(silence, 128e3, with, 1).newtons();
  for (const std::size_t n : {0U, 700U, 1999U}) {
    const double t = static_cast<double>(n) / 128e3;
    CHECK(std::abs(x[n] - 2e-3 * std::cos(2 * pi * 50 * t + 0.3) - 1e-3 * std::cos(2 * pi * 150 * t - 1)) < 1e-9);
  }
}

TEST_CASE("what is no number ends at the range's end and is counted") {
  const auto channel = rosin::convert(std::vector<double>{0.1, std::nan(""), 0.1}, 128e3, {}, 1);
  CHECK(channel.clipped == 1);
  CHECK(channel.codes[2] == channel.codes[0]);
  CHECK(rosin::convert(std::vector<double>{}, 128e3, {}, 1).size() == 0);
}

TEST_CASE("normal deviates by Box and Muller from the standard's twister: the same everywhere") {
  std::mt19937_64 twister{42};
  const auto uniform = [&] { return (static_cast<double>(twister() >> 11) + 0.5) / 9007199254740992.0; };
  rosin::gaussian_source source{42};
  for (int i = 0; i < 5; ++i) {
    const double u = uniform(), v = uniform();
    CHECK(source() == test::approx(std::sqrt(-2 * std::log(u)) * std::cos(2 * pi * v)));
  }
  const double between = source.uniform(3, 4);
  CHECK(between > 3);
  CHECK(between < 4);
}

}  // namespace simulate_converter
