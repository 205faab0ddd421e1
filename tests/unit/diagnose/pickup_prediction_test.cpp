// SPDX-License-Identifier: MIT
#include <rosin/diagnose/pickup_prediction.hpp>

#include <doctest/doctest.h>

#include "pickup_plucks.hpp"
#include "support/approx.hpp"

using namespace rosin;

TEST_CASE("left_by_lines: true poles leave the noise, wrong ones more") {
  const std::complex<double> s{-3, 2 * 3.14159265358979323846 * 441}, wrong{-3, s.imag() + 2};
  const glide_shape shape{{1}, {5}, {0}};
  const glide_found glide{shape, 1e-3, 0, 0, 1};
  judged_stretch stretch{{}, 8000, 0};
  gaussian_source normal{3};
  for (int j = 0; j < 6000; ++j) {
    const double t = j / 8000.0;
    stretch.x.push_back(
        std::real(std::complex{1.0, -0.4} * std::exp(s * t) * std::polar(1.0, s.imag() * 1e-3 * shape.path_s(1, t))) +
        0.01 * normal());
  }
  const auto left = left_by_lines(stretch, {{1, s}}, &glide);
  CHECK(rms_level(left) == test::approx(0.01).epsilon(0.05));
  CHECK(quietest_piece(left, 8000) == test::approx(0.01).epsilon(0.2));
  CHECK(rms_level(left_by_lines(stretch, {{1, s}})) > 0.03);
  CHECK(rms_level(left_by_lines(stretch, {{1, wrong}}, &glide)) > 0.03);
}

TEST_CASE("halves_of: one recording in two that do not overlap") {
  const rosin_test::heard_string s;
  const auto [early, late] = halves_of(s.pluck("a", 0.13, 1, 1), 220);
  CHECK(early.to_s == late.from_s);
  CHECK(late.to_s <= 1.2);
  CHECK(early.to_s == test::approx(0.65).epsilon(0.1));
}
