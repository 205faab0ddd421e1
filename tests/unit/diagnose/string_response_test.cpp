// SPDX-License-Identifier: MIT
#include <rosin/diagnose/string_response.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

using complex = std::complex<double>;

rosin::pluck_scene response_scene() {
  rosin::pluck_scene s;
  s.string = {612.87, 6.6e-5, {1e9, 0, 0}, 0};
  return s;
}

/// Mobility of a lossless pinned stiff string as the sum of its modes, in units of 1/Z: s (2 / T_one_way) sum sin sin / (s^2 +
/// w^2).
complex by_modes(const rosin::pluck_scene& p, double a, double b, complex s) {
  complex sum = 0;
  for (int n = 1; n < 60000; ++n) {
    const double w = 2 * std::numbers::pi * p.string.partial_Hz(n);
    sum += std::sin(n * std::numbers::pi * a) * std::sin(n * std::numbers::pi * b) / (s * s + w * w);
  }
  return s * (2 * 2 * p.string.fundamental_Hz) * sum;
}

}  // namespace

TEST_CASE("mobility in closed form is the sum over modes, anywhere in the complex plane") {
  const auto p = response_scene();
  for (const complex s : {complex(300, 9000), complex(-50, 41000), complex(1000, 150000)})
    for (const auto& [a, b] : {std::pair{0.3, 0.3}, std::pair{0.2, 0.71}}) {
      const rosin::string_at string(p, s);
      const complex closed = string.mobility(a, b) / string.sine();
      CHECK(std::abs(closed - by_modes(p, a, b, s)) < 2e-4 * std::abs(closed));
      CHECK(std::abs(string.mobility(a, b) - string.mobility(b, a)) < 1e-12 * std::abs(string.mobility(a, b)));
    }
}

TEST_CASE("where every mode is damped by itself, a load meets what the sum over such modes gives") {
  auto p = response_scene();
  p.string.loss = {1000, 0, 0};
  const double x = 0.5746;
  for (const double f : {1.3, 2.45, 5.6, 10.35, 20.4}) {
    const double w = 2 * std::numbers::pi * f * p.string.fundamental_Hz;
    complex sum = 0;
    for (int n = 1; n < 20000; ++n) {
      const double wn = 2 * std::numbers::pi * p.string.partial_Hz(n), shape = std::sin(n * std::numbers::pi * x);
      sum += shape * shape / (wn * wn - w * w + complex(0, w * wn / 1000));
    }
    const complex modes = complex(0, w * 4 * p.string.fundamental_Hz) * sum;
    const rosin::string_at string(p, {0, w});
    // the loss shows in the real part; 1.6e-4 without its share
    CHECK(std::abs((string.mobility(x, x) / string.sine() - modes).real()) < 4e-5);
  }
}

TEST_CASE("where the loaded string's modes lose by themselves, its poles are those without loss, turned by 1 + i / 2Q") {
  auto lossless = response_scene();
  lossless.scatterers = {{.position = 0.33, .mass_s = 5e-5}};  // a tenth of the string's
  const auto pole = [](const rosin::pluck_scene& scene, complex s) {
    for (int step = 0; step < 30; ++step) {
      const complex h = 1e-6 * std::abs(s),
                    slope = (rosin::loop_determinant(scene, s + h) - rosin::loop_determinant(scene, s - h)) / (2.0 * h);
      s -= rosin::loop_determinant(scene, s) / slope;
    }
    return s;
  };
  auto loaded = lossless, bare = lossless;
  loaded.string.loss = bare.string.loss = {500, 0, 0};
  loaded.loaded_loss = 1;
  double apart = 0;
  for (const int n : {1, 2, 4, 7, 11}) {
    const complex free = pole(lossless, {0, 2 * std::numbers::pi * lossless.string.partial_Hz(n)}),
                  turned = free * complex(1, 1.0 / (2 * 500));
    CHECK(pole(loaded, free).real() / turned.real() == test::approx(1).epsilon(2e-3));
    CHECK(pole(loaded, free).imag() / turned.imag() == test::approx(1).epsilon(1e-5));
    apart = std::max(apart, std::abs(pole(bare, free).real() / turned.real() - 1));
  }
  CHECK(apart > 0.02);  // as the bare string's modes lose, the loaded string's decay otherwise
}

TEST_CASE("slowly, the ends share a force by the lever's law") {
  const rosin::string_at string(response_scene(), {0.01, 1});
  CHECK(std::abs(string.end_force(0, 0.3) / string.sine() - 0.7) < 1e-3);
  CHECK(std::abs(string.end_force(1, 0.3) / string.sine() - 0.3) < 1e-3);
}

TEST_CASE("a load changes the loop, one without weight does not") {
  auto with = response_scene();
  const complex s{-10, 30000};
  const auto bare = rosin::close_loop(with, 0.3, s);
  with.scatterers = {{.position = 0.4}};
  const auto nothing = rosin::close_loop(with, 0.3, s);
  for (std::size_t e = 0; e < 2; ++e)
    CHECK(std::abs(nothing.times_determinant[e] / nothing.determinant - bare.times_determinant[e] / bare.determinant) < 1e-9);
  with.scatterers = {{.position = 0.4, .resistance = 1e9}};  // a pin: only what bends passes it, about 2 k / kappa
  const auto clamped = rosin::close_loop(with, 0.3, s);
  CHECK(std::abs(clamped.times_determinant[1] / clamped.determinant) < 0.15);
  CHECK(std::abs(clamped.times_determinant[1] / clamped.determinant) <
        0.2 * std::abs(bare.times_determinant[1] / bare.determinant));
}
