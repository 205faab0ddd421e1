// SPDX-License-Identifier: MIT
#include <rosin/diagnose/string_poles.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

rosin::pluck_scene scene() {
  rosin::pluck_scene s;
  s.string = {612.87, 6.6e-5, {850, 0, 0}, 0};
  return s;
}

/// One mode of a stiff string whose ends resist turning, sin(q x - a) + sin(a) exp(-k x) from either end: L = 1, T = 1, c = 1.
struct clamped_mode {
  double omega = 0;
  std::array<double, 2> force{};  ///< on the ends, for a pluck of 1 N
};
clamped_mode mode_between(const std::array<double, 2>& clamping, int n, double B, double x) {
  constexpr double pi = std::numbers::pi;
  double q = n * pi, kappa = 0;
  std::array<double, 2> a{};
  for (int i = 0; i < 200; ++i) {
    kappa = std::sqrt(q * q + 1 / B);
    for (std::size_t e = 0; e < 2; ++e) {
      // B y'' = spring y'
      const double spring = clamping[e] * std::sqrt(B), free = (1 - clamping[e]) * B * (q * q + kappa * kappa);
      a[e] = std::atan2(spring * q, free + spring * kappa);
    }
    q = n * pi + a[0] + a[1];
  }
  const double parity = n % 2 == 1 ? 1 : -1, w2 = q * q + B * q * q * q * q;
  double mass = 0;
  const int points = 400 * n + 4000;
  const auto shape = [&](double z) {
    return std::sin(q * z - a[0]) + std::sin(a[0]) * std::exp(-kappa * z) + parity * std::sin(a[1]) * std::exp(-kappa * (1 - z));
  };
  for (int i = 0; i < points; ++i) mass += std::pow(shape((i + 0.5) / points), 2) / points;
  clamped_mode out{std::sqrt(w2), {}};
  for (std::size_t e = 0; e < 2; ++e) {
    const double slope = q * std::cos(a[e]) - kappa * std::sin(a[e]),
                 shear = -q * q * q * std::cos(a[e]) - kappa * kappa * kappa * std::sin(a[e]);
    out.force[e] = (e == 0 ? 1 : parity) * (slope - B * shear) * shape(x) / (mass * w2);
  }
  return out;
}

/// What lines up to `top_Hz` come to at the instant of the release, their sum smoothed (Fejer).
std::array<double, 2> sum_of(const std::vector<rosin::damped_line>& lines, double top_Hz) {
  std::array<double, 2> sum{};
  for (const auto& line : lines) {
    const double x = line.pole.imag() / (2 * top_Hz), fejer = x > 0 ? std::pow(std::sin(x) / x, 2) : 1;
    for (std::size_t e = 0; e < 2; ++e) sum[e] += fejer * line.residue[e].real();
  }
  return sum;
}

}  // namespace

TEST_CASE("without anything on it the string has its own poles, with the residues of a pluck") {
  const auto poles = rosin::string_poles(scene(), 50e3, 200);
  const auto lines = rosin::decay_lines(scene(), 0.3264, poles);
  const auto plain = rosin::pluck_lines(scene().string, 0.3264, 0, {64e3, 64e3}, static_cast<int>(poles.size()));
  REQUIRE(poles.size() > 60);
  for (std::size_t i = 0; i < poles.size(); ++i) {
    CHECK(std::abs(poles[i] - plain[i].pole) < 1e-6 * std::abs(poles[i]));
    for (std::size_t c = 0; c < 2; ++c) CHECK(std::abs(lines[i].residue[c] - plain[i].residue[c]) < 1e-5);
  }
}

TEST_CASE("poles of a loaded string solve the modes' own equation, 1 + (M/Z) s^2 4 f0 sum sin^2 / (s^2 + w^2 (1 + i/Q)) = 0") {
  auto with = scene();
  constexpr double load_s = 3.7e-5, at = 0.4222;  // 6.5 mg on 0.174 N s/m
  with.scatterers = {{.position = at, .mass_s = load_s}};
  const auto poles = rosin::string_poles(with, 40e3, 200);
  for (std::size_t i = 0; i < poles.size(); i += 7) {
    const auto s = poles[i];
    std::complex<double> sum = 0;
    for (int n = 1; n < 100000; ++n) {
      const double w = 2 * std::numbers::pi * with.string.partial_Hz(n);
      sum += std::pow(std::sin(n * std::numbers::pi * at), 2) / (s * s + w * w * std::complex<double>(1, 1 / 850.0));
    }
    CHECK(std::abs(1.0 + load_s * s * s * 4.0 * with.string.fundamental_Hz * sum) < 2e-2);
    CHECK(s.imag() < 2 * std::numbers::pi * with.string.partial_Hz(static_cast<int>(i) + 1));  // a mass lowers every partial
  }
}

TEST_CASE("a support that resonates brings one pole of its own, and the pluck still begins from rest") {
  auto with = scene();
  with.ends[1].modes = {{.frequency_Hz = 2485, .q = 10.6, .per_mass_per_s = 0.1737 / 0.00325}};
  const auto poles = rosin::string_poles(with, 50e3, 200);
  CHECK(poles.size() == rosin::string_poles(scene(), 50e3, 200).size() + 1);
  double near = 0, far = 0;
  for (const auto& line : rosin::decay_lines(with, 0.3264, poles)) near += line.residue[0].real(), far += line.residue[1].real();
  CHECK(near == test::approx(1 - 0.3264).epsilon(0.03));  // as far as a series of 70 terms goes
  CHECK(far == test::approx(0.3264).epsilon(0.03));
}

TEST_CASE("modes of an end that all but let go of it have residues as small, and leave the string's alone") {
  auto with = scene();
  for (int n = 1; n <= 20; ++n) with.ends[1].modes.push_back({.frequency_Hz = 246.9 * n, .q = 900, .per_mass_per_s = 1e-4});
  const auto lines = rosin::decay_lines(with, 0.3264, rosin::string_poles(with, 50e3, 200));
  const auto own = rosin::decay_lines(scene(), 0.3264, rosin::string_poles(scene(), 50e3, 200));
  CHECK(lines.size() == own.size() + 20);
  for (const auto& line : lines) {
    const auto same = std::find_if(own.begin(), own.end(), [&](const auto& o) { return std::abs(o.pole - line.pole) < 0.1; });
    if (same == own.end()) CHECK(std::abs(line.residue[0]) < 1e-5);
    else CHECK(std::abs(line.residue[0] - same->residue[0]) < 1e-5);
  }
}

TEST_CASE("from poles nearby the search comes to the same end") {
  auto with = scene();
  with.scatterers = {{.position = 0.31, .mass_s = 3e-5}};
  const auto near = rosin::string_poles(with, 40e3, 200);
  with.scatterers[0].mass_s *= 1 + 1e-5;
  const auto warm = rosin::string_poles(with, 40e3, 200, near), cold = rosin::string_poles(with, 40e3, 200);
  REQUIRE(warm.size() == cold.size());
  for (std::size_t i = 0; i < warm.size(); ++i) CHECK(std::abs(warm[i] - cold[i]) < 1e-3);
}

TEST_CASE(
    "a string whose ends resist turning has the modes of the beam under tension: sin(q x - a) with a near field, q L = n pi + a "
    "+ a'") {
  for (const auto& clamping : {std::array{1.0, 1.0}, std::array{1.0, 0.0}, std::array{0.0, 0.6}, std::array{0.3, 1.0}}) {
    rosin::pluck_scene s;
    s.string = {0.5, 4e-6 * std::numbers::pi * std::numbers::pi, {1e7, 0, 0}, 0};  // one second there and one back
    for (std::size_t e = 0; e < 2; ++e) s.ends[e].clamping = clamping[e];
    const auto lines = rosin::decay_lines(s, 0.27, rosin::string_poles(s, 60, 500));
    REQUIRE(lines.size() > 80);
    for (std::size_t i = 0; i < 80; i += 7) {
      const auto mode = mode_between(clamping, static_cast<int>(i) + 1, 4e-6, 0.27);
      CHECK(lines[i].pole.imag() == test::approx(mode.omega).epsilon(1e-7));
      for (std::size_t e = 0; e < 2; ++e)
        CHECK(lines[i].residue[e].real() == test::approx(mode.force[e]).epsilon(1e-5).scale(0.01));
    }
  }
}

TEST_CASE("while the wire holds a clamped string its ends share the force as those of a shorter one" *
          doctest::test_suite("long")) {
  rosin::pluck_scene s;
  s.string = {0.5, 4e-6 * std::numbers::pi * std::numbers::pi, {1e7, 0, 0}, 0};
  s.ends[0].clamping = 1, s.ends[1].clamping = 0.5;
  std::array<double, 2> sum{};
  for (int n = 1; n < 800; ++n) {
    const auto mode = mode_between({1, 0.5}, n, 4e-6, 0.27);
    for (std::size_t e = 0; e < 2; ++e)
      sum[e] += mode.force[e] * std::pow(std::sin(n * std::numbers::pi / 800) / (n * std::numbers::pi / 800), 2);
  }
  const auto held = rosin::held_forces(s, 0.27);
  for (std::size_t e = 0; e < 2; ++e) CHECK(sum[e] == test::approx(held[e]).epsilon(2e-5));
}

TEST_CASE(
    "no partial of a clamped string is lost, whatever else is there, to where one was half a spacing away from where a pinned "
    "one has it") {
  for (const int what : {0, 1, 2, 3}) {
    CAPTURE(what);
    rosin::pluck_scene s;
    s.string = {196, 1e-4, {1000, 0, 0}, 0};
    for (auto& end : s.ends) end.clamping = 1;
    const double top = 2 * std::numbers::pi * 40e3;
    const auto alone = rosin::string_poles(s, 40e3, 500);
    if (what == 0) s.scatterers = {{.position = 0.42, .mass_s = 1e-5}};
    if (what == 1) s.scatterers = {{.position = 0.42, .resistance = 0.02}};
    if (what == 2) s.ends[0].modes = {{.frequency_Hz = 800, .q = 0.01, .per_mass_per_s = 0.002 * 2 * std::numbers::pi * 80e3}};
    if (what == 3) s.ends[1].modes = {{.frequency_Hz = 2485, .q = 10.6, .per_mass_per_s = 30}};
    const auto poles = rosin::string_poles(s, 40e3, 500);
    CHECK(poles.size() == alone.size() + (what >= 2 ? 1 : 0));
    const double spacing = alone.back().imag() - alone[alone.size() - 2].imag();
    CHECK(poles.back().imag() > top - 1.6 * spacing);
    for (std::size_t i = 1; i < poles.size(); ++i) {
      CHECK(poles[i].imag() - poles[i - 1].imag() < 1.5 * spacing);
      CHECK(std::abs(poles[i] - poles[i - 1]) > 1e-4 * spacing);
    }
  }
}

TEST_CASE("an end that is damped and hardly held: what relaxes is one of the lines, and together they are what the wire held") {
  rosin::pluck_scene s;
  s.string = {300, 1e-5, {1e7, 0, 0}, 0};
  const double corner = 2 * std::numbers::pi * 30, fast = 2e7, conductance = 0.01;
  s.ends[1].modes = {{.frequency_Hz = std::sqrt(corner * fast) / (2 * std::numbers::pi),
                      .q = std::sqrt(corner / fast),
                      .per_mass_per_s = conductance * fast}};
  const auto poles = rosin::string_poles(s, 120e3, 500);
  REQUIRE(poles.front().imag() == 0);
  CHECK(poles.front().real() == test::approx(-(corner + 600 * conductance)).epsilon(0.01));
  // Of the static forces a triangle's sum of partials and the relaxation are left: F (1 - x, x) of a string longer by the end's
  // yield.
  const auto sum = sum_of(rosin::decay_lines(s, 0.3, poles), 120e3);
  const double longer = 600 * conductance / corner;
  const auto held = rosin::held_forces(s, 0.3);
  CHECK(held[1] == test::approx(0.3 / (1 + longer)));
  for (std::size_t e = 0; e < 2; ++e) CHECK(sum[e] == test::approx(held[e]).epsilon(2e-3));
}

TEST_CASE("ends that are alike have poles of their own: all lines together are what the wire held") {
  const auto damped = [](double conductance, double corner_Hz) { return rosin::overdamped_mode(conductance, corner_Hz); };
  const auto ringing = [](double frequency_Hz, double per_mass) {
    return rosin::admittance_mode{.frequency_Hz = frequency_Hz, .q = 30, .per_mass_per_s = per_mass};
  };
  const std::vector<std::array<rosin::admittance_mode, 2>> both{{damped(0.01, 20), damped(0.01, 20.2)},
                                                                {damped(0.001, 20), damped(0.001, 20)},
                                                                {ringing(900, 5), ringing(900, 5)},
                                                                {ringing(60, 50), ringing(60, 50)},
                                                                {ringing(1980, 8), ringing(1980, 8)}};
  for (const auto& modes : both) {
    CAPTURE(modes[0].frequency_Hz);
    rosin::pluck_scene s;
    s.string = {660, 1e-6, {1e7, 0, 0}, 0};
    for (std::size_t e = 0; e < 2; ++e) s.ends[e].modes = {modes[e]};
    const auto poles = rosin::string_poles(s, 300e3, 600);
    double nearest = 1e300;
    for (std::size_t i = 0; i < poles.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, std::abs(poles[i] - poles[j]));
    CHECK(nearest > 0.01);
    const auto sum = sum_of(rosin::decay_lines(s, 0.35, poles), 300e3);
    const auto held = rosin::held_forces(s, 0.35);
    for (std::size_t e = 0; e < 2; ++e) CHECK(sum[e] == test::approx(held[e]).epsilon(2e-3));
  }
}

TEST_CASE("where the loss is causal the loop's poles and residues are those of the dispersed partials") {
  rosin::pluck_scene s = scene();
  s.string.inharmonicity = 0;  // the loop and the modes disperse a stiff string alike to first order only
  s.string.loss = {.quality = 400, .causality = 1, .reference_Hz = s.string.fundamental_Hz};
  const auto lines = rosin::decay_lines(s, 0.3, rosin::string_poles(s, 20e3, 40));
  const auto plain = rosin::pluck_lines(s.string, 0.3, 0, {20e3, 20e3}, 40);
  REQUIRE(lines.size() == plain.size());
  for (std::size_t n = 0; n < lines.size(); ++n) {
    CHECK(std::abs(lines[n].pole - plain[n].pole) < 3e-6 * std::abs(plain[n].pole));
    for (std::size_t e = 0; e < 2; ++e) CHECK(std::abs(std::abs(lines[n].residue[e]) - std::abs(plain[n].residue[e])) < 1e-5);
  }
  CHECK(plain[30].pole.imag() / (31 * plain[0].pole.imag()) ==
        test::approx(std::pow(31, 1 / (400 * std::numbers::pi))).epsilon(1e-5));
}
