// SPDX-License-Identifier: MIT
#include <rosin/calibrate/pickup_glide.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace {

constexpr double rate_Hz = 44100;

/// A plucked string on one pickup; glide: relative sharpness at the start, gone at 5 per second.
std::vector<double> plucked(double f0, double b, double noise, unsigned seed, double glide = 0) {
  std::mt19937_64 random{seed};
  std::normal_distribution<double> gauss{0, noise};
  std::uniform_real_distribution<double> phase{0, 6.28};
  std::vector<double> x(66150), offset(41);
  for (double& o : offset) o = phase(random);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double t = static_cast<double>(i) / rate_Hz - 0.1;
    x[i] = gauss(random);
    if (t < 0) continue;
    const double warped = t + glide * (1 - std::exp(-5 * t)) / 5;
    for (int n = 1; n <= 25; ++n) {
      const double f = n * f0 * std::sqrt(1 + b * n * n);
      x[i] += std::exp(-std::numbers::pi * f * (1 / 1200.0 + 2e-7 * f) * t) / n * std::cos(2 * std::numbers::pi * f * warped + offset[static_cast<std::size_t>(n)]);
    }
  }
  return x;
}

}  // namespace

TEST_CASE("a glide of pitch is found, and none is found where there is none") {
  for (const double glide : {0.0, 4e-3}) {
    const auto x = plucked(247.1, 6e-5, 1e-4, 3, glide);
    const rosin::baseband_bank bank{x, rate_Hz, 40};
    std::vector<rosin::partial_track> tracks;
    for (int n = 1; n <= 6; ++n)
      if (auto t = rosin::track_partial(bank, n, n * 247.1 * std::sqrt(1 + 6e-5 * n * n), 5, 0.2, 1.4)) tracks.push_back(*std::move(t));
    REQUIRE(tracks.size() >= 5);
    const rosin::glide_estimate found = rosin::estimate_glide(tracks);
    if (glide == 0) CHECK(std::abs(found.glide.relative) < 2e-4);
    else CHECK(found.glide.relative == doctest::Approx(glide * std::exp(-5 * 0.1)).epsilon(0.25));
  }
}
