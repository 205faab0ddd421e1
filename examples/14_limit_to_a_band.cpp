// SPDX-License-Identifier: MIT
//
// A whole record cut down to a band, without delay: a tone stays where it was, what lies above the band is gone.
//
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include <rosin/condition/low_pass.hpp>
#include <rosin/propagate/band.hpp>

int main() {
  const double rate_Hz = 128e3;
  const auto tone = [&](double frequency_Hz, std::size_t n) {
    return std::cos(2 * std::numbers::pi * frequency_Hz / rate_Hz * static_cast<double>(n));
  };
  std::vector<double> record(5000);
  for (std::size_t n = 0; n < record.size(); ++n) record[n] = tone(7e3, n) + tone(61e3, n);

  const std::vector<double> low = rosin::low_pass<double>(record, rate_Hz, rosin::band{.pass_Hz = 20e3, .stop_Hz = 60e3});
  double inside = 0, anywhere = 0;
  for (std::size_t n = 0; n < low.size(); ++n) {
    const double error = std::abs(low[n] - tone(7e3, n));
    anywhere = std::fmax(anywhere, error);
    if (n >= 40 && n + 40 < low.size()) inside = std::fmax(inside, error);
  }
  std::printf("worst error %.0e from 40 samples off the ends, %.2f at the ends\n", inside, anywhere);
  return inside < 1e-3 ? 0 : 1;
}
