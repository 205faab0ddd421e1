// SPDX-License-Identifier: MIT
#include <rosin/hardware/level_meter.hpp>

#include <doctest/doctest.h>

#include <numbers>

#include "support/approx.hpp"

TEST_CASE("a sine's peak and rms, the peak's fall, and clipping, channel by channel") {
  rosin::level_meter meter{{48000, 2, 16}};
  std::vector<double> frames;
  for (int i = 0; i < 96000; ++i) {
    frames.push_back(0.5 * std::sin(2 * std::numbers::pi * 1000 * i / 48000));
    frames.push_back(i % 1000 == 0 ? 32767 / 32768.0 : 0);
  }
  meter.push(frames);
  CHECK(meter.levels()[0].peak == test::approx(0.5).epsilon(1e-3));
  CHECK(meter.levels()[0].rms == test::approx(0.5 / std::numbers::sqrt2).epsilon(2e-3));
  CHECK(meter.levels()[0].clipped == 0);
  CHECK(meter.levels()[1].clipped == 96);
  meter.push(std::vector<double>(48000, 0.0));  // half a second of silence
  CHECK(meter.levels()[0].peak == test::approx(0.5 * std::sqrt(0.1)).epsilon(1e-3));
  CHECK(rosin::decibels(0.1) == test::approx(-20));
  CHECK(rosin::decibels(0) == -120);
}
