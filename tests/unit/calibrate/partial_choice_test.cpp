// SPDX-License-Identifier: MIT
#include <rosin/calibrate/partial_choice.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "support/approx.hpp"

namespace {

using complex = std::complex<double>;
constexpr double baseband_rate_Hz = 160;

std::vector<complex> drawn_lines(bool second, double noise) {
  std::mt19937_64 random{11};
  std::normal_distribution<double> gauss;
  std::vector<complex> z;
  for (int j = 0; j < 480; ++j) {
    const double t = j / baseband_rate_Hz;
    z.push_back(std::exp(complex(-1.2, 9) * t) + (second ? 0.6 * std::exp(complex(-0.4, 15) * t) : 0.0) +
                complex(noise * gauss(random), noise * gauss(random)));
  }
  return z;
}

}  // namespace

TEST_CASE("one line stays one, two are told apart") {
  for (const bool two : {false, true}) {
    const auto z = drawn_lines(two, 1e-3);
    const rosin::line_fit one = rosin::fit_one_line(z, baseband_rate_Hz, 220, 4);
    const rosin::line_fit best = rosin::one_or_two_lines(z, baseband_rate_Hz, one, 4, 1);
    REQUIRE(best.model.parts.size() == (two ? 2U : 1U));
    if (!two) CHECK(best.model.parts[0].detuning_rad_s == test::approx(9).epsilon(1e-3));
    else {
      const double low = std::min(best.model.parts[0].detuning_rad_s, best.model.parts[1].detuning_rad_s);
      const double high = std::max(best.model.parts[0].detuning_rad_s, best.model.parts[1].detuning_rad_s);
      CHECK(low == test::approx(9).epsilon(1e-3));
      CHECK(high == test::approx(15).epsilon(1e-3));
    }
  }
}
