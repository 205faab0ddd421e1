// SPDX-License-Identifier: MIT
#include <rosin/condition/held_record.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace condition_held_record {

namespace {

std::vector<double> step_and_ramp() {
  std::vector<double> x(700);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 3.0 + 0.01 * static_cast<double>(i) + (i > 300 ? 2.0 : 0.0);
  return x;
}

}  // namespace

TEST_CASE("to the spectrum and back a record is itself") {
  const auto x = step_and_ramp();
  rosin::held_record held{x.size(), 256};
  const auto spectrum = held.spectrum(x);
  CHECK(spectrum.size() == held.bins());
  const auto back = held.record(spectrum);
  REQUIRE(back.size() == x.size());
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(back[i] == test::approx(x[i]).epsilon(1e-12));
}

TEST_CASE("a short filter sees what it would see if the record had been held before it for ever") {
  const auto x = step_and_ramp();
  const double rate_Hz = 1000, pole = 0.9;  // y_n = 0.9 y_{n-1} + 0.1 x_n
  rosin::held_record held{x.size(), 512};
  auto spectrum = held.spectrum(x);
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const auto z = std::polar(1.0, -2 * std::numbers::pi * held.frequency_Hz(k, rate_Hz) / rate_Hz);
    spectrum[k] *= (1 - pole) / (1.0 - pole * z);
  }
  const auto y = held.record(std::move(spectrum));
  double state = x.front(), worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    state = pole * state + (1 - pole) * x[i];
    worst = std::max(worst, std::abs(y[i] - state));
  }
  CHECK(worst < 1e-10);
}

TEST_CASE("nothing jumps where the period closes: the spectrum of a ramp falls faster than that of a step") {
  std::vector<double> ramp(1000);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<double>(i);
  rosin::held_record held{ramp.size(), 1000};
  const auto spectrum = held.spectrum(ramp);
  const auto high = spectrum.size() - 1;  // a step's bin there is about its height / 2
  CHECK(std::abs(spectrum[high]) < 5.0);
  CHECK(std::abs(spectrum[1]) > 1e5);
}

}  // namespace condition_held_record
