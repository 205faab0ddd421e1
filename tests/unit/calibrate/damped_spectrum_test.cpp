// SPDX-License-Identifier: MIT
#include <rosin/calibrate/damped_spectrum.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

TEST_CASE("the spectrum of a decaying tone is 1 / (s - p), off the axis, however sharp the tone") {
  const double rate_Hz = 48e3;
  const std::complex<double> p(-3, 2 * std::numbers::pi * 777);
  std::vector<double> x(20000);
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = std::exp(p * static_cast<double>(n) / rate_Hz).real();
  const rosin::damped_line_of_frequencies line(rate_Hz, 150, x.size(), 4e3);
  const auto spectrum = rosin::damped_spectrum(line, x);
  CHECK(spectrum.size() == line.bins());
  CHECK(line.samples < x.size());
  const auto sum = [&](std::complex<double> pole, std::complex<double> s) {
    return 0.5 / rate_Hz / (1.0 - std::exp((pole - s) / rate_Hz));
  };
  for (std::size_t k = 0; k < line.bins(); ++k) {
    const std::complex<double> s = line.at(k), exact = sum(p, s) + sum(std::conj(p), s);
    CHECK(std::abs(spectrum[k] - exact) < 1e-5 * std::abs(exact) + 2e-8);
  }
}

TEST_CASE("the weights' squares, summed") {
  const rosin::damped_line_of_frequencies line(48e3, 150, 20000, 4e3);
  double sum = 0;
  for (std::size_t n = 0; n < line.samples; ++n) sum += std::exp(-2 * 150 * static_cast<double>(n) / 48e3);
  CHECK(line.weighted_samples() == test::approx(sum));
}
