// SPDX-License-Identifier: MIT
#include <rosin/torsion/torsion_response.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace torsion_torsion_response {

namespace {

using complex = std::complex<double>;

// A violin E string: 660 Hz, position 0.3, torsion seven times as fast.
rosin::torsion_waveguide e_string(double q) {
  const double one_way = 0.5 / 660.0;
  return rosin::torsion_of({0.3 * one_way, 0.7 * one_way}, 0.175, 7.0, 3.5, q);
}

// Sum over the modes, each with the loss proportional to displacement that a constant Q stands for:
// sum_n (2 / M) sin^2(n pi p) i w / (w_n^2 - w^2 + i w w_n / Q), M = Z tau the inertia of the whole string.
complex modal_sum(const rosin::torsion_waveguide& at, double frequency_Hz, int modes) {
  const double w = 2 * std::numbers::pi * frequency_Hz, one_way = at.delay_s[0] + at.delay_s[1];
  const double p = at.delay_s[0] / one_way, mass = at.impedance_Ns_m * one_way;
  complex sum = 0;
  for (int n = 1; n <= modes; ++n) {
    const double wn = std::numbers::pi * n / one_way, shape = std::sin(n * std::numbers::pi * p);
    sum += 2 / mass * shape * shape * complex(0, w) / complex(wn * wn - w * w, w * wn / at.q);
  }
  return sum;
}

}  // namespace

TEST_CASE("torsion: the transfer function is the sum over the torsional modes") {
  const auto at = e_string(300);
  for (const double f : {500.0, 2000.0, 4600.0, 9000.0, 13870.0, 20000.0}) {
    const complex exact = modal_sum(at, f, 40000), mine = at(f);
    CHECK(std::abs(mine - exact) < 0.01 * std::abs(exact));
  }
}

TEST_CASE("torsion: first resonance, height and width at Q = 15") {
  const auto at = e_string(15);
  const double f1 = 0.5 / (at.delay_s[0] + at.delay_s[1]);
  CHECK(f1 == test::approx(7 * 660.0));
  const double peak = std::abs(at(f1)), half = std::abs(at(f1 * (1 + 0.5 / 15)));
  CHECK(half / peak == test::approx(1 / std::sqrt(2.0)).epsilon(0.1));
  // 2 sin^2(pi p) / (M w / Q)
  const double mass = at.impedance_Ns_m * (at.delay_s[0] + at.delay_s[1]), w = 2 * std::numbers::pi * f1;
  CHECK(peak == test::approx(2 * std::pow(std::sin(0.3 * std::numbers::pi), 2) * 15 / (mass * w)).epsilon(0.03));
}

TEST_CASE("torsion: with its dispersion the answer does not come before the question") {
  constexpr std::size_t size = 1 << 15;
  constexpr double rate = 1e6;
  for (const double q : {8.0, 15.0}) {
    const auto early = [&](bool causal) {  // share of an impulse's answer that comes first, but for the band's own ringing
      auto at = e_string(q);
      at.causal = causal;
      std::vector<complex> bins = at.on_grid(rate / size, size / 2 + 1);
      std::vector<double> answer(size);
      for (std::size_t k = 0; k < bins.size(); ++k)
        bins[k] *= std::exp(-std::pow(rate / size * static_cast<double>(k) / 60e3, 2)) *
                   std::polar(1.0, -6.283185307179586 * static_cast<double>(k) * 0.25);  // an impulse at a quarter
      rosin::eigen_fft<double> fft(size);
      fft.inverse(bins.data(), answer.data());
      double before = 0, all = 0;
      for (std::size_t i = 0; i < size; ++i) {
        all += answer[i] * answer[i];
        if (i + 12 < size / 4) before += answer[i] * answer[i];
      }
      return before / all;
    };
    CHECK(early(true) < 0.3 * early(false));
  }
}

TEST_CASE("torsion: where waves disperse, speed and Q are those of the first resonance, and a grid is the same as one by one") {
  auto at = e_string(15), plain = at;
  at.causal = true;
  const double f1 = 7 * 660.0;
  CHECK(std::abs(at(f1)) == test::approx(std::abs(plain(f1))).epsilon(0.002));
  CHECK(std::arg(at(f1) / plain(f1)) == test::approx(-0.5 / 15).epsilon(0.05));  // of the string's own impedance
  CHECK(rosin::causal_loss(15, std::exp(1.0)).sooner == test::approx(1 - 0.021).epsilon(0.001));
  const auto grid = at.on_grid(37.0, 2000);
  for (const std::size_t k : {0U, 1U, 125U, 1999U}) CHECK(std::abs(grid[k] - at(37.0 * static_cast<double>(k))) < 1e-12);
  CHECK(std::abs(at(-f1) - std::conj(at(f1))) < 1e-12);
}

TEST_CASE("torsion: a causal loss in the stress is the sum of the modes of a string whose stiffness alone is complex") {
  auto at = e_string(15);
  at.causal = true;
  const double tau = at.delay_s[0] + at.delay_s[1], first = std::numbers::pi / tau, p = at.delay_s[0] / tau,
               angle = std::atan(1 / 15.0);
  const double inertia = at.impedance_Ns_m * tau / std::cos(angle / 2);  // real, and alike at all frequencies
  for (const double f : {500.0, 3e3, 4620.0, 1.3e4, 4e4}) {
    const double w = 2 * std::numbers::pi * f;
    // w_n^2 goes as the modulus, (i w / w_1)^(2 G); so told that the speed is the real one at w_1
    const complex modulus = std::pow(complex(0, w / first), 2 * angle / std::numbers::pi) * std::pow(std::cos(angle / 2), 2);
    complex sum = 0;
    constexpr int most = 200000;
    for (int n = 1; n <= most; ++n)
      sum += 2 * std::pow(std::sin(n * std::numbers::pi * p), 2) * complex(0, w) /
             (inertia * (modulus * (n * first) * (n * first) - w * w));
    CHECK(std::abs(at(f) - sum) < 2e-4 * std::abs(sum));
  }
}

TEST_CASE("torsion: the trend of a flat spectrum of relaxations, against the sum of its modes") {
  const double q = 15, per_efold = 2 / (std::numbers::pi * q);
  auto with = e_string(q);
  with.causal = true;
  auto without = with;
  with.trend = per_efold;
  const double tau = with.delay_s[0] + with.delay_s[1], first = std::numbers::pi / tau, p = with.delay_s[0] / tau,
               angle = std::atan(1 / q), inertia = with.impedance_Ns_m * tau / std::cos(angle / 2);
  double off = 0, off_without = 0;
  for (const double f : {1e3, 3e3, 8e3, 1.3e4, 2e4}) {
    const double w = 2 * std::numbers::pi * f;
    // a loss modulus that is the same at all frequencies, and the stiffness that goes with it
    const complex modulus =
        (complex(1, 1 / q) + per_efold * std::log(w / first)) / std::abs(complex(1, 1 / q)) * std::pow(std::cos(angle / 2), 2);
    complex sum = 0;
    for (int n = 1; n <= 100000; ++n)
      sum += 2 * std::pow(std::sin(n * std::numbers::pi * p), 2) * complex(0, w) /
             (inertia * (modulus * (n * first) * (n * first) - w * w));
    off = std::max(off, std::abs(with(f) - sum) / std::abs(sum));
    off_without = std::max(off_without, std::abs(without(f) - sum) / std::abs(sum));
  }
  CHECK(off < 0.006);
  CHECK(off < 0.2 * off_without);
}

TEST_CASE("torsion: nothing moves under a steady force, and nothing overflows") {
  const auto at = e_string(15);
  CHECK(std::abs(at(0.0)) == 0);
  CHECK(std::abs(at(1e-3)) < 1e-6);
  CHECK(std::isfinite(std::abs(at(1e9))));
  CHECK(std::abs(at(1e9)) == test::approx(1 / (2 * at.impedance_Ns_m)));  // nothing comes back: a bare waveguide
  const std::vector<double> steady(500, 0.7);
  for (const double v : rosin::torsion_velocity(at, steady, 128e3)) CHECK(std::abs(v) < 1e-12);
  CHECK(rosin::torsion_velocity(at, {}, 128e3).empty());
}

TEST_CASE("torsion: a force in time gives the waves that a step sends out, one after the other") {
  // Until the first echo is back the surface moves by 1 / (2 Z_T); then the echo of the near end takes that back.
  const auto at = e_string(40);
  const double rate = 4e6;
  std::vector<double> force(8000, 0.0);
  for (std::size_t i = 2000; i < force.size(); ++i) force[i] = 1;
  const auto v = rosin::torsion_velocity(at, force, rate);
  const double echo = 2 * at.delay_s[0] * rate;
  CHECK(v[2000 + static_cast<std::size_t>(0.5 * echo)] * 2 * at.impedance_Ns_m == test::approx(1).epsilon(0.02));
  CHECK(std::abs(v[2000 + static_cast<std::size_t>(1.5 * echo)] * 2 * at.impedance_Ns_m) < 0.03);
  CHECK(std::abs(v[1900]) * 2 * at.impedance_Ns_m < 0.02);  // constant Q looks ahead by very little
}

TEST_CASE("torsion: the record's end does not reach its beginning") {
  const auto at = e_string(15);
  std::vector<double> force(3000, 0.0);
  for (std::size_t i = 1000; i < force.size(); ++i) force[i] = 0.2 * std::sin(0.11 * static_cast<double>(i)) + 0.5;
  const auto whole = rosin::torsion_velocity(at, force, 128e3);
  force.resize(6000, 0.0);
  const auto longer = rosin::torsion_velocity(at, force, 128e3);
  for (std::size_t i = 0; i < 2900; ++i) CHECK(std::abs(whole[i] - longer[i]) < 2e-3);
  for (std::size_t i = 0; i < 900; ++i) CHECK(std::abs(whole[i]) < 2e-3);
}

TEST_CASE("torsion: on a grid of frequencies it is what it is at each of them") {
  const auto at = e_string(15);
  const auto grid = at.on_grid(0.7, 90000);
  for (std::size_t k = 0; k < grid.size(); k += 97)
    CHECK(std::abs(grid[k] - at(0.7 * static_cast<double>(k))) <= 1e-11 * std::abs(grid[k]));
}

}  // namespace torsion_torsion_response
