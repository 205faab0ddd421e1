// SPDX-License-Identifier: MIT
#include <rosin/diagnose/scene_lines.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

constexpr rosin::band upper_band{45e3, 60e3};
rosin::pluck_scene lines_scene() {
  rosin::pluck_scene s;
  s.string = {659.69, 6.49e-5, {900, 0, 0}, 0};
  return s;
}
double at(const std::vector<rosin::damped_line>& lines, std::size_t c, double t) {
  double sum = 0;
  for (const auto& l : lines) sum += (l.residue[c] * std::exp(l.pole * t)).real();
  return sum;
}

}  // namespace

TEST_CASE("a slow release is the fast one smeared by the rate at which the wire lets go") {
  auto slow = lines_scene();
  slow.release_duration_s = 60e-6;
  const auto sharp = rosin::scene_lines(lines_scene(), 0.3, upper_band, 100, {}),
             smeared = rosin::scene_lines(slow, 0.3, upper_band, 100, {});
  constexpr int steps = 2000;
  for (const double t : {0.0005, 0.00161, 0.0042}) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double u = 60e-6 * (i + 0.5) / steps;
      sum += at(sharp, 0, t - u) * std::numbers::pi / (2 * 60e-6) * std::sin(std::numbers::pi * u / 60e-6) * 60e-6 / steps;
    }
    CHECK(at(smeared, 0, t) == test::approx(sum).epsilon(1e-4));
  }
}

TEST_CASE("a sensor that resonates follows its differential equation, driven by the force") {
  auto with = lines_scene();
  with.sensors[1] = {.resonance_Hz = 9000, .q = 8};
  const auto force = rosin::scene_lines(lines_scene(), 0.3, upper_band, 100, {}),
             seen = rosin::scene_lines(with, 0.3, upper_band, 100, {});
  const double w = 2 * std::numbers::pi * 9000, h = 1e-7;
  for (const double t : {0.0003, 0.0011, 0.0031}) {
    const double y = at(seen, 1, t), d1 = (at(seen, 1, t + h) - at(seen, 1, t - h)) / (2 * h),
                 d2 = (at(seen, 1, t + h) - 2 * y + at(seen, 1, t - h)) / (h * h);
    CHECK(y + d1 / (w * 8) + d2 / (w * w) == test::approx(at(force, 1, t)).epsilon(1e-3));
    CHECK(at(seen, 0, t) == test::approx(at(force, 0, t)));
  }
  // It was at rest with the held string: its own ringing has to make up for what the lines alone begin with.
  CHECK(at(seen, 1, 0) == test::approx(0.3).epsilon(0.02));
}

TEST_CASE("crosstalk mixes, a skew turns, and two planes share the force") {
  auto with = lines_scene();
  const auto bare = rosin::scene_lines(with, 0.3, upper_band, 100, {});
  with.crosstalk = 0.02;
  const auto mixed = rosin::scene_lines(with, 0.3, upper_band, 100, {});
  CHECK(at(mixed, 0, 0.002) == test::approx(at(bare, 0, 0.002) + 0.02 * at(bare, 1, 0.002)));
  with = lines_scene();
  with.sensors[1].delay_s = 3e-6;
  CHECK(at(rosin::scene_lines(with, 0.3, upper_band, 100, {}), 1, 0.002) == test::approx(at(bare, 1, 0.002 - 3e-6)));
  with = lines_scene();
  with.detuning = 1e-3, with.coupling = 0.2;
  const auto both = rosin::scene_lines(with, 0.3, upper_band, 100, {});
  CHECK(both.size() == 2 * bare.size());
  CHECK(at(both, 0, 0) == test::approx(at(bare, 0, 0)).epsilon(1e-3));
}

TEST_CASE("a second plane whose stiffness is detuned as well has all partials by one ratio, else high ones by less") {
  auto with = lines_scene();
  with.string.inharmonicity = 1e-3, with.detuning = 4e-3, with.coupling = 0.2;
  const auto ratio = [&](std::size_t n) {
    const auto lines = rosin::scene_lines(with, 0.3, upper_band, 100, {});
    return lines[lines.size() / 2 + n].pole.imag() / lines[n].pole.imag() - 1;
  };
  with.detuned_alike = 1;
  CHECK(ratio(0) == test::approx(4e-3).epsilon(1e-9));
  CHECK(ratio(19) == test::approx(4e-3).epsilon(1e-9));
  with.detuned_alike = 0;
  CHECK(ratio(0) == test::approx(4e-3).epsilon(2e-3));
  CHECK(ratio(19) == test::approx(4e-3 / 1.4).epsilon(0.01));  // b n^2 = 0.4
}
