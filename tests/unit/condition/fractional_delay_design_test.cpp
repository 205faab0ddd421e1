// SPDX-License-Identifier: MIT
#include <rosin/condition/fractional_delay_design.hpp>

#include <doctest/doctest.h>
#include <boost/math/special_functions/bessel.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "support/approx.hpp"

namespace condition_fractional_delay_design {

TEST_CASE("I0 is that of Boost") {
  for (double x = 0; x < 40; x += 0.7) CHECK(rosin::bessel_i0(x) == test::approx(boost::math::cyl_bessel_i(0, x)).epsilon(1e-14));
}

TEST_CASE("weights are symmetric about the middle, sum to one and pass through the samples") {
  std::array<double, 12> w{}, mirrored{};
  rosin::kaiser_weights(0.3, 6, w);
  rosin::kaiser_weights(0.7, 6, mirrored);
  for (std::size_t j = 0; j < w.size(); ++j) CHECK(w[j] == test::approx(mirrored[w.size() - 1 - j]).epsilon(1e-13));
  CHECK(std::accumulate(w.begin(), w.end(), 0.0) == test::approx(1).epsilon(1e-15));
  rosin::kaiser_weights(0, 6, w);
  for (std::size_t j = 0; j < w.size(); ++j) CHECK(std::abs(w[j] - (j == 5 ? 1 : 0)) < 1e-15);
}

TEST_CASE("a kernel keeps its limits between the points it was designed at, and half a sample needs every tap") {
  for (const double bandwidth : {0.3, 0.5, 0.8, 0.9, 0.95})
    for (const double error_dB : {-40.0, -80.0, -140.0, -200.0})
      for (const double delay : {0.5, -67.911, 29.105, 3.001}) {
        const auto kernel = rosin::design_kaiser_delay(delay, {bandwidth, error_dB});
        REQUIRE(kernel);
        double worst = 0;
        for (double f = 0; f <= bandwidth; f += bandwidth / 333) {
          std::complex<double> sum = 0;
          for (std::size_t j = 0; j < kernel->taps.size(); ++j)
            sum += kernel->taps[j] * std::polar(1.0, -std::numbers::pi * f * (kernel->first + static_cast<double>(j)));
          worst = std::fmax(worst, std::abs(sum - std::polar(1.0, -std::numbers::pi * f * delay)));
        }
        CAPTURE(bandwidth);
        CAPTURE(error_dB);
        CAPTURE(delay);
        CHECK(20 * std::log10(worst) < error_dB);

        if (delay != 0.5) continue;
        rosin::delay_kernel shorter{kernel->first + 1, std::vector<double>(kernel->taps.size() - 2)};
        const double beta = rosin::kaiser_beta(rosin::kaiser_attenuation_dB(shorter.taps.size(), bandwidth));
        rosin::kaiser_weights(delay - std::floor(delay), beta, shorter.taps);
        CHECK(rosin::delay_error_dB(shorter, delay, bandwidth) > error_dB - 0.5);
      }
}

TEST_CASE("a whole delay is one tap of one") {
  const auto kernel = rosin::design_kaiser_delay(-5);
  REQUIRE(kernel);
  REQUIRE(kernel->taps.size() == 2);
  CHECK(kernel->first == -5);
  CHECK(kernel->taps[0] == 1);
  CHECK(std::abs(kernel->taps[1]) < 1e-15);
}

TEST_CASE("what cannot be designed is named") {
  CHECK(rosin::design_kaiser_delay(std::numeric_limits<double>::quiet_NaN()).error().find("nan") != std::string::npos);
  CHECK(rosin::design_kaiser_delay(std::numeric_limits<double>::infinity()).error().find("1e9") != std::string::npos);
  CHECK(rosin::design_kaiser_delay(1.5, {1.0, -80}).error().find("bandwidth 1 ") != std::string::npos);
  CHECK(rosin::design_kaiser_delay(1.5, {0.8, -300}).error().find("-300") != std::string::npos);
}

}  // namespace condition_fractional_delay_design
