// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_string.hpp>

#include <doctest/doctest.h>

#include <rosin/friction/velocity_curve.hpp>

#include "support/approx.hpp"

namespace simulate_wave_string {

namespace {

constexpr double Z = 0.175, step_s = 1e-5;

/// An ideal string of whole steps' length, without loss.
rosin::wave_kernels<double> ideal(std::ptrdiff_t near, std::ptrdiff_t far, std::ptrdiff_t block) {
  rosin::wave_kernels<double> k;
  k.step_s = step_s;
  k.block = block;
  k.echo = {rosin::wave_taps<double>{rosin::fir{static_cast<int>(near), {-1}}},
            rosin::wave_taps<double>{rosin::fir{static_cast<int>(far), {-1}}}};
  k.fill = {rosin::wave_taps<double>{rosin::fir{0, {1 / (2 * Z)}}}};
  k.local = {1 / (2 * Z)};
  return k;
}

/// Energy of all waves under way: Z h (sum of squared velocities).
double energy_J(const rosin::wave_string<double>& string) {
  double sum = 0;
  for (std::size_t j = 0; j < 2; ++j)
    for (std::ptrdiff_t k = 1; k <= string.kernels().echo[j].first; ++k)
      sum += std::pow(string.wave(j, string.waves() - k) / (2 * Z), 2);
  return Z * step_s * sum;
}

}  // namespace

TEST_CASE("ideal delays and the junction with friction: what the rod gives is in the waves or was rubbed away, to 1e-10") {
  rosin::wave_string<double> string{ideal(31, 89, 31)};
  rosin::velocity_curve law{rosin::two_exponential_curve<>{}};
  double rod_J = 0, heat_J = 0, largest = 0;
  int slipped = 0;
  for (int n = 0; n < 31 * 2000; ++n) {
    const rosin::rod_state rod{.velocity_m_s = std::min(0.2, 40 * n * step_s), .normal_force_N = 0.5};
    const auto answer = law(string.line(rod));
    const auto state = string.apply(answer.force_N);
    rod_J += answer.force_N * rod.velocity_m_s * step_s;
    heat_J += answer.force_N * (rod.velocity_m_s - state.centre_m_s) * step_s;
    slipped += answer.slipping ? 1 : 0;
    if ((n + 1) % 31 == 0) largest = std::max(largest, std::abs(energy_J(string) + heat_J - rod_J));
  }
  CHECK(slipped > 1000);
  CHECK(heat_J > 0);
  CHECK(rod_J > 1e-5);
  CHECK(largest < 1e-10 * rod_J);
}

TEST_CASE("a click comes back when it should, turned over, and the block's length changes nothing") {
  rosin::wave_string<double> one{ideal(7, 12, 1)}, many{ideal(7, 12, 7)};
  for (int n = 0; n < 60; ++n) {
    const double force = n == 0 ? 1 : 0;
    CHECK(one.line({}).free_velocity_m_s == test::approx(many.line({}).free_velocity_m_s).scale(0.1));
    const double v = one.apply(force).centre_m_s * 2 * Z;
    many.apply(force);
    if (n == 0) CHECK(v == test::approx(1));
    if (n == 7 || n == 12) CHECK(v == test::approx(-1));
    if (n == 19) CHECK(v == test::approx(2));
    if (n == 5 || n == 18) CHECK(v == 0);
  }
}

TEST_CASE("a tape keeps its past when it is turned") {
  rosin::wave_tape<double> tape{10, 4};
  for (std::ptrdiff_t n = 0; n < 20000; ++n) {
    tape.turn(n, n + 4);
    *tape.at(n) = static_cast<double>(n);
    if (n >= 10) REQUIRE(*tape.at(n - 10) == static_cast<double>(n - 10));
    REQUIRE(*tape.at(n + 3) == 0);
  }
}

TEST_CASE("block sums are those of the definition") {
  std::vector<double> in(64), out(21, 0.5), thin(5, 0.0);
  for (std::size_t i = 0; i < in.size(); ++i) in[i] = std::sin(static_cast<double>(i * i));
  const rosin::wave_taps<double> kernel{rosin::fir{2, {1, -0.5, 0.25, 3, 0.125}}};
  rosin::detail::add_filtered(kernel, in.data() + 20, out.data(), 21);
  for (std::size_t i = 0; i < out.size(); ++i)
    CHECK(out[i] == test::approx(0.5 + in[18 + i] - 0.5 * in[17 + i] + 0.25 * in[16 + i] + 3 * in[15 + i] + 0.125 * in[14 + i]));
  const rosin::wave_taps<double> even{rosin::fir{-4, {1, 2, 3, 4, 5, 4, 3, 2, 1}}};
  rosin::detail::add_thinned(even, in.data() + 10, 3, thin.data(), 5);
  for (std::size_t i = 0; i < thin.size(); ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < 9; ++k) sum += even.taps[k] * in[10 + 3 * i + 4 - k];
    CHECK(thin[i] == test::approx(sum));
  }
}

}  // namespace simulate_wave_string
