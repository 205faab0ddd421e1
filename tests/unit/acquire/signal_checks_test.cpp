// SPDX-License-Identifier: MIT
#include <rosin/acquire/signal_checks.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <random>

#include "support/approx.hpp"

namespace acquire_signal_checks {

namespace {

/// One second of a channel of 2 N full scale, 16 bit: a sine and noise.
rosin::take_signals sine(double amplitude, double noise, double offset = 0) {
  std::mt19937_64 random{3};
  std::normal_distribution<double> white{0, 1};
  rosin::take_signals out;
  out.sample_rate_Hz = 8000;
  out.signals.resize(1);
  auto& s = out.signals[0];
  s.sensor.name = "near";
  s.sensor.per_full_scale = 2.0;
  s.full_scale = 2.0;
  for (std::size_t i = 0; i < 8000; ++i) {
    const double v = offset + amplitude * std::sin(0.3 * static_cast<double>(i)) + noise * white(random);
    s.values.push_back(std::round(v * 16384) / 16384);
  }
  return out;
}

rosin::take_check check(const rosin::take_signals& s, bool quiet = false) {
  rosin::take_check out;
  out.duration_s = s.time_s(s.frames());
  (void)rosin::detail::check_signal(out, s, s.signals[0], quiet);
  return out;
}

}  // namespace

TEST_CASE("an ordinary channel gives figures and no findings") {
  const auto c = check(sine(0.8, 1e-3));
  CHECK(c.findings.empty());
  REQUIRE(c.channels.size() == 1);
  CHECK(c.channels[0].rms == test::approx(0.8 / std::sqrt(2)).epsilon(1e-2));
  CHECK(c.channels[0].of_full_scale == test::approx(0.4).epsilon(1e-2));
  CHECK(c.channels[0].unit == "N");
}

TEST_CASE("samples that are not numbers end the check of the channel") {
  auto s = sine(0.8, 1e-3);
  s.signals[0].values[2000] = std::numeric_limits<double>::quiet_NaN();
  rosin::take_check out;
  CHECK_FALSE(rosin::detail::check_signal(out, s, s.signals[0], false));
  REQUIRE(out.found("not-a-number"));
  CHECK(out.findings[0].start_s == 0.25);
  CHECK(out.findings[0].level == rosin::severity::error);
}

TEST_CASE("clipping and dropouts are errors with their time and place") {
  auto s = sine(2.5, 1e-3);
  for (double& v : s.signals[0].values) v = std::clamp(v, -2.0, 2.0 - 1.0 / 16384);
  const auto clipped = check(s);
  REQUIRE(clipped.found("clipping"));
  CHECK(clipped.findings[0].channel == "near");
  CHECK(clipped.findings[0].what.find("of full scale") != std::string::npos);
  s.signals[0].sensor.quantity = rosin::quantity::sound;  // much of it is an error here too, a touch of it is not
  CHECK(check(s).findings[0].level == rosin::severity::error);
  auto touch = sine(0.8, 1e-3);
  for (std::size_t i = 100; i < 104; ++i) touch.signals[0].values[i] = 2.0 - 1.0 / 16384;
  CHECK(check(touch).findings.at(0).level == rosin::severity::error);
  touch.signals[0].sensor.quantity = rosin::quantity::sound;
  CHECK(check(touch).findings.at(0).level == rosin::severity::warning);
  auto lost = sine(0.8, 1e-3);
  for (std::size_t i = 4000; i < 4040; ++i) lost.signals[0].values[i] = lost.signals[0].values[3999];
  const auto dropped = check(lost);
  REQUIRE(dropped.found("dropouts"));
  CHECK(dropped.findings[0].start_s == test::approx(0.5).epsilon(1e-3));
  CHECK(dropped.findings[0].samples == 41);  // and the one that they repeat
}

TEST_CASE("silence is an error in a take that should sound, a warning in a quiet one") {
  CHECK(check(sine(0, 0)).findings.at(0).level == rosin::severity::error);
  CHECK(check(sine(0, 0), true).findings.at(0).level == rosin::severity::warning);
  CHECK(check(sine(0, 0)).findings.at(0).kind == "silence");
  CHECK(check(sine(0.003, 0)).found("low-level"));
  CHECK(check(sine(0, 5e-4), true).findings.empty());
}

TEST_CASE("an offset counts where the mean has to be zero") {
  CHECK(check(sine(0, 5e-4, 0.3), true).found("offset"));
  CHECK_FALSE(check(sine(0.8, 1e-3, 0.3)).found("offset"));  // a force may have a mean
  auto ac = sine(0.8, 1e-3, 0.3);
  ac.signals[0].sensor.ac_coupled_Hz = 10;
  CHECK(check(ac).found("offset"));
  ac.signals[0].sensor.ac_coupled_Hz = 0.5;  // has had no time to settle
  CHECK_FALSE(check(ac).found("offset"));
  auto microphone = sine(0.8, 1e-3, 0.3);
  microphone.signals[0].sensor.quantity = rosin::quantity::sound;
  CHECK(check(microphone).found("offset"));
}

TEST_CASE("units by quantity, and of full scale without calibration") {
  rosin::sensor_channel c;
  CHECK(rosin::unit_of(c) == "of full scale");
  c.per_full_scale = 1;
  CHECK(rosin::unit_of(c) == "N");
  c.quantity = rosin::quantity::sound;
  CHECK(rosin::unit_of(c) == "Pa");
  c.quantity = rosin::quantity::bow_speed;
  CHECK(rosin::unit_of(c) == "m/s");
}

}  // namespace acquire_signal_checks
