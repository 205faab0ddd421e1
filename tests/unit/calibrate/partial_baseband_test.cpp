// SPDX-License-Identifier: MIT
#include <rosin/calibrate/partial_baseband.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

TEST_CASE("a tone comes down to zero frequency with its amplitude and decay") {
  constexpr double rate_Hz = 8000, f = 441.3, decay = 1.5;
  std::vector<double> x(16000);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = static_cast<double>(i) / rate_Hz;
    x[i] = 0.7 * std::exp(-decay * t) * std::cos(2 * std::numbers::pi * f * t + 0.3) + std::cos(2 * std::numbers::pi * 1200 * t);
  }
  const rosin::baseband_bank bank{x, rate_Hz, 40};
  const rosin::baseband_record r = bank.around(440);
  CHECK(std::abs(r.centre_Hz - 440) < 1);
  CHECK(r.rate_Hz >= 80);
  // The window is not flat: a line beside the centre is the window's value there, at the damped frequency, times itself.
  const std::complex<double> gain = r.window(std::complex<double>{f - r.centre_Hz, decay / (2 * std::numbers::pi)});
  CHECK(std::abs(gain) < 0.995);
  for (std::size_t j = r.samples.size() / 4; j < r.samples.size() / 2; ++j) {
    const double t = static_cast<double>(j) / r.rate_Hz;
    const auto expected = gain * 0.7 * std::exp(-decay * t) * std::polar(1.0, 2 * std::numbers::pi * (f - r.centre_Hz) * t + 0.3);
    CHECK(std::abs(r.samples[j] - expected) < 1e-6);
  }
}
