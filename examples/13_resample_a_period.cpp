// SPDX-License-Identifier: MIT
//
// A periodic record at another number of samples per period, and later by any number of them: both are exact.
//
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include <rosin/condition/fourier_resampler.hpp>
#include <rosin/condition/fourier_shift.hpp>

int main() {
  const auto period = [](std::size_t samples, double late) {
    std::vector<double> x(samples);
    for (std::size_t j = 0; j < samples; ++j) {
      const double turn = 2 * std::numbers::pi * (static_cast<double>(j) - late) / static_cast<double>(samples);
      x[j] = std::cos(turn) + 0.5 * std::sin(40 * turn);
    }
    return x;
  };
  const auto worst = [](const std::vector<double>& is, const std::vector<double>& should) {
    double error = 0;
    for (std::size_t j = 0; j < is.size(); ++j) error = std::fmax(error, std::abs(is[j] - should[j]));
    return error;
  };
  const std::vector<double> measured = period(193, 0);  // 660 Hz at 128 kHz is 193.9 samples: 193 is prime

  const std::vector<double> resampled = rosin::fourier_resample<double>(measured, 256);
  std::printf("193 to 256 samples: worst error %.0e\n", worst(resampled, period(256, 0)));

  std::vector<double> shifted(193);
  rosin::fourier_shift<double>(193).process(measured, shifted, 29.105);
  std::printf("29.105 samples later: worst error %.0e\n", worst(shifted, period(193, 29.105)));
  return worst(resampled, period(256, 0)) < 1e-12 ? 0 : 1;
}
