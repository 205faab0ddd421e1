// SPDX-License-Identifier: MIT
#include <rosin/simulate/wave_way.hpp>

#include "support/approx.hpp"
#include "support/violin_e_string.hpp"

#include <doctest/doctest.h>

namespace simulate_wave_way {

namespace {

constexpr double rate_Hz = 512e3;
constexpr rosin::band limits{90e3, 250e3};
const rosin::string_parameters& string = test::violin_e_string.string;

/// Response of a kernel that turned or scattered itself into an array of its lags.
std::complex<double> response(const std::vector<double>& taps, double frequency_Hz) {
  return rosin::fir{0, taps}.response(frequency_Hz, rate_Hz);
}

std::vector<double> scattered(const rosin::wave_way<double>& way, double distance) {
  std::vector<double> out(static_cast<std::size_t>(way.last()) + 1, 0.0);
  way.to_end(distance).scatter(1, out.data());
  return out;
}

std::vector<double> gathered(const rosin::wave_way<double>& way, double distance) {
  const auto size = static_cast<std::size_t>(way.last()) + 1;
  std::vector<double> out(size, 0.0);
  for (std::size_t lag = 0; lag < size; ++lag) {
    std::vector<double> past(size, 0.0);
    past[size - 1 - lag] = 1;
    out[lag] = way.back(distance).gather(past.data() + size - 1);
  }
  return out;
}

}  // namespace

TEST_CASE("anywhere on the way, between the rows too, a wave comes late, spread and weakened as the string has it") {
  const rosin::wave_way<double> way{string, 0.11, 0.15, limits, rate_Hz};
  for (const double distance : {0.11, 0.1163, 0.13, 0.14217, 0.15}) {
    CAPTURE(distance);
    const auto to_end = scattered(way, distance), back = gathered(way, distance);
    for (const double f : {0.0, 700.0, 3e3, 9e3, 2e4, 5e4, 8.9e4}) {
      CAPTURE(f);
      const double w = 2 * std::numbers::pi * f;
      const auto pass = -rosin::pinned_echo{{distance / (2 * string.fundamental_Hz), string.stiffness_s2(), string.loss},
                                            string.fundamental_Hz}(f);
      CHECK(std::abs(response(to_end, f) - pass) < (f < 3e4 ? 6e-4 : 4e-3));
      const double mobility = rosin::wave_mobility(string, w) * rosin::straight_line_weight(w, 1 / rate_Hz);
      CHECK(std::abs(response(back, f) - pass * mobility) < (f < 3e4 ? 6e-4 : 4e-3) * rosin::wave_mobility(string, 0));
    }
  }
}

TEST_CASE("beyond the way a contact is at its end, and what does not change is let through as it is") {
  const rosin::wave_way<double> way{string, 0.11, 0.15, limits, rate_Hz};
  CHECK(way.first() >= 1);
  for (const double distance : {0.02, 0.11}) CHECK(scattered(way, distance) == scattered(way, 0.11));
  CHECK(scattered(way, 0.7) == scattered(way, 0.5));
  for (const double distance : {0.11, 0.1234, 0.15})
    CHECK(response(scattered(way, distance), 0).real() == test::approx(1).epsilon(1e-12));
  CHECK(rosin::wave_way<double>{}.empty());
}

TEST_CASE("in single precision the same kernels") {
  const rosin::wave_way<double> way{string, 0.11, 0.15, limits, rate_Hz};
  const rosin::wave_way<float> single{way};
  std::vector<float> out(static_cast<std::size_t>(way.last()) + 1, 0.0F);
  single.to_end(0.1301).scatter(1.0F, out.data());
  const auto exact = scattered(way, 0.1301);
  for (std::size_t i = 0; i < out.size(); ++i)
    CHECK(static_cast<double>(out[i]) == test::approx(exact[i]).epsilon(1e-5).scale(0.1));
}

}  // namespace simulate_wave_way
