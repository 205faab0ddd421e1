// SPDX-License-Identifier: MIT
#include <rosin/math/spectrum_line.hpp>

#include <doctest/doctest.h>

#include <array>

#include "support/approx.hpp"

namespace {

std::vector<double> two_sines(std::size_t size, double rate) {
  std::vector<double> x(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double t = 6.283185307179586 * static_cast<double>(i) / rate;
    x[i] = 0.3 + 0.8 * std::cos(441.7 * t + 1) + 0.05 * std::sin(1000.3 * t);
  }
  return x;
}

}  // namespace

TEST_CASE("lines come with frequency and amplitude, strongest first, without side lobes") {
  const auto x = two_sines(9973, 8000);  // a prime length
  const auto lines = rosin::strongest_lines(x, 8000, 20, 3900, 10);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0].frequency_Hz == test::approx(441.7).epsilon(2e-5));
  CHECK(lines[0].amplitude == test::approx(0.8).epsilon(5e-3));
  CHECK(lines[1].frequency_Hz == test::approx(1000.3).epsilon(2e-5));
  CHECK(lines[1].amplitude == test::approx(0.05).epsilon(5e-3));
}

TEST_CASE("the amplitude at a frequency is that of the sinusoid there") {
  const auto windowed = rosin::detail::hann_windowed(two_sines(8000, 8000));
  CHECK(rosin::detail::amplitude_at(windowed, 441.7, 8000) == test::approx(0.8).epsilon(1e-4));
  CHECK(rosin::detail::amplitude_at(windowed, 1000.3, 8000) == test::approx(0.05).epsilon(1e-3));
  CHECK(rosin::detail::amplitude_at(windowed, 700, 8000) < 1e-4);
}

TEST_CASE("nothing in silence or in a few samples") {
  CHECK(rosin::strongest_lines(std::vector<double>(1000, 0.5), 8000, 20, 3900, 10).empty());
  CHECK(rosin::strongest_lines(std::array{1.0, 2.0}, 8000, 20, 3900, 10).empty());
}
