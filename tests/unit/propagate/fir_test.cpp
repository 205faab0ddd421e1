// SPDX-License-Identifier: MIT
#include <rosin/propagate/fir.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "support/approx.hpp"

namespace propagate_fir {

namespace {

constexpr double rate_Hz = 48e3;
const rosin::band limits{8e3, 20e3};

/// A delay of 7.3 samples that also halves.
std::complex<double> wanted(double f) { return std::polar(0.5, -2 * std::numbers::pi * f * 7.3 / rate_Hz); }

}  // namespace

TEST_CASE("taps are the inverse transform of what is wanted") {
  const rosin::fir k = rosin::sample_response(wanted, limits, rate_Hz, -40, 60);
  CHECK(k.first == -40);
  CHECK(k.last() == 60);
  // One tap by a Riemann sum of its own.
  double tap = 0;
  const int steps = 200000;
  for (int i = 0; i < steps; ++i) {
    const double f = 0.5 * rate_Hz * (i + 0.5) / steps;
    tap += (wanted(f) * limits(f) * std::polar(1.0, 2 * std::numbers::pi * f * 5 / rate_Hz)).real() / steps;
  }
  CHECK(k.taps[45] == test::approx(tap).epsilon(1e-7));
}

TEST_CASE("the response of an FIR is its Fourier sum") {
  const rosin::fir k{-2, {0.5, -1.0, 2.0, 0.25}};
  std::complex<double> sum = 0;
  for (int j = 0; j < 4; ++j)
    sum += k.taps[static_cast<std::size_t>(j)] * std::polar(1.0, -2 * std::numbers::pi * 3000.0 * (j - 2) / rate_Hz);
  CHECK(std::abs(k.response(3000, rate_Hz) - sum) < 1e-14);
}

TEST_CASE("the shortest run keeps the error asked for, and one tap less does not") {
  std::size_t before = 0;
  for (const double error : {1e-2, 1e-3, 1e-4, 1e-5}) {
    const rosin::fir k = rosin::shortest_fir(wanted, limits, rate_Hz, -100, 120, error);
    CHECK(rosin::pass_band_error(k, wanted, limits, rate_Hz, 1111) <= 1.02 * error);
    CHECK(k.taps.size() > before);
    before = k.taps.size();
    const rosin::fir shorter = rosin::detail::shrink(k, k.taps.size() - 1);
    CHECK(rosin::pass_band_error(shorter, wanted, limits, rate_Hz) > error);
  }
}

TEST_CASE("a set of runs: each is as short as its own size allows") {
  const auto set = [](double f) { return std::array<std::complex<double>, 2>{1e-3 * wanted(f), wanted(f)}; };
  const auto two = rosin::shortest_firs(set, limits, rate_Hz, -100, 120, 1e-4);
  const rosin::fir alone = rosin::shortest_fir(wanted, limits, rate_Hz, -100, 120, 1e-4);
  CHECK(two[1].taps == alone.taps);
  CHECK(two[0].first == alone.first);
  REQUIRE(two[0].taps.size() == alone.taps.size());
  CHECK(two[0].taps[9] == test::approx(1e-3 * alone.taps[9]));
}

}  // namespace propagate_fir
