// SPDX-License-Identifier: MIT
#include <rosin/simulate/modal_decimator.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_modal_decimator {

namespace {

constexpr double pi = 3.14159265358979323846;
const rosin::modal_low_pass low_pass{55e3, 64e3};
constexpr int stride = 4;
constexpr double step = 1 / (stride * 128e3);

std::vector<double> tone(double f, std::size_t reach, std::size_t samples) {
  std::vector<double> steps(2 * reach + (samples - 1) * stride + 1);
  for (std::size_t i = 0; i < steps.size(); ++i)
    steps[i] = std::cos(2 * pi * f * (static_cast<double>(i) - static_cast<double>(reach)) * step + 0.4);
  return steps;
}

}  // namespace

TEST_CASE("a tone in the pass band comes through without gain and without delay, one beyond the stop not at all") {
  const rosin::modal_decimator decimate{low_pass, step, stride};
  for (const double f : {0.0, 700.0, 20e3, 50e3, 75e3, 200e3}) {
    const auto samples = decimate.points(tone(f, decimate.reach(), 40));
    REQUIRE(samples.size() == 40);
    for (std::size_t n = 0; n < samples.size(); ++n) {
      const double expected = f < 60e3 ? std::cos(2 * pi * f * static_cast<double>(n) / 128e3 + 0.4) : 0.0;
      CAPTURE(f);
      CHECK(std::abs(samples[n] - expected) < 2e-5);
    }
  }
}

TEST_CASE("a force that runs straight between steps: its tones are those of the broken line") {
  // the line through samples of a tone contains it with the gain sinc^2(f T); its other tones lie beyond the stop
  const rosin::modal_decimator decimate{low_pass, step, stride};
  for (const double f : {700.0, 20e3, 50e3}) {
    const auto steps = tone(f, decimate.reach(), 40);
    const auto values = decimate.lines(steps), rates = decimate.slopes(steps);
    const double sinc = std::sin(pi * f * step) / (pi * f * step), w = 2 * pi * f;
    for (std::size_t n = 0; n < values.size(); ++n) {
      const double phase = w * static_cast<double>(n) / 128e3 + 0.4;
      CAPTURE(f);
      CHECK(std::abs(values[n] - sinc * sinc * std::cos(phase)) < 2e-5);
      CHECK(std::abs(rates[n] + sinc * sinc * w * std::sin(phase)) < 3e-5 * 2 * pi * 64e3);
    }
  }
}

TEST_CASE("the line's integral is kept") {
  const rosin::modal_decimator decimate{low_pass, step, stride};
  std::vector<double> steps(2 * decimate.reach() + 4000, 0.0);
  steps[decimate.reach() + 1001] = 3;
  double sum = 0;
  for (const double s : decimate.lines(steps)) sum += s / 128e3;
  CHECK(sum == test::approx(3 * step).epsilon(1e-4));
}

}  // namespace simulate_modal_decimator
