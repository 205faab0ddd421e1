// SPDX-License-Identifier: MIT
#include <rosin/calibrate/stroke_spectra.hpp>
#include <rosin/simulate/converter.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace {

constexpr double spectra_rate_Hz = 20e3;

rosin::stroke_take white(double sd_N, std::size_t samples) {
  rosin::stroke_take t{"white", spectra_rate_Hz, {}, 0.1};
  rosin::gaussian_source g{3};
  for (auto& x : t.force_N)
    for (std::size_t i = 0; i < samples; ++i) x.push_back(sd_N * g());
  return t;
}

}  // namespace

TEST_CASE("A stroke's spectra have the bins of the band, and noise in them has the power that is said") {
  const auto take = white(2e-3, 12345);
  const rosin::stroke_spectra s(take, 100, 4000, 0.003);
  CHECK(static_cast<double>(s.first()) * s.bin_Hz() >= 100);
  CHECK(static_cast<double>(s.last()) * s.bin_Hz() <= 4000);
  CHECK(s.bins() > s.last());
  double power = 0;
  for (std::size_t k = s.first(); k <= s.last(); ++k) power += std::norm(s.windowed(0)[k]);
  power /= static_cast<double>(s.last() - s.first() + 1);
  CHECK(power == test::approx(4e-6 * s.noise_power()).epsilon(0.06));  // 2400 independent values
  CHECK(s.independence() > 0.6);
  CHECK(s.independence() < 1);
}

TEST_CASE("What happens only within a transit of the record's ends is not seen") {
  auto take = white(0, 12000);
  take.force_N[0][5] = 1, take.force_N[0][11990] = -1;
  const rosin::stroke_spectra s(take, 100, 4000, 0.003);
  double most = 0;
  for (std::size_t k = s.first(); k <= s.last(); ++k) most = std::max(most, std::abs(s.windowed(0)[k]));
  CHECK(most < 1e-4);
  take.force_N[0][6000] = 1;
  const rosin::stroke_spectra seen(take, 100, 4000, 0.003);
  CHECK(std::abs(seen.windowed(0)[seen.first() + 50]) == test::approx(1).epsilon(1e-3));
}
