// SPDX-License-Identifier: MIT
#include <rosin/acquire/stroke_motion.hpp>

#include <doctest/doctest.h>

#include <support/bowed_take.hpp>

#include "support/approx.hpp"

namespace acquire_stroke_motion {

TEST_CASE("steady speed and force, and the offset that shows while the bow is off the string") {
  for (const double offset : {0.0, 0.05, -0.04}) {
    CAPTURE(offset);
    test::stroke s;
    s.offset_N = offset;
    const auto m = rosin::motion_of(test::bowed_take(s), test::bowed_signals(s));
    REQUIRE(m.steady_speed_m_s);
    REQUIRE(m.steady_normal_force_N);
    REQUIRE(m.normal_offset_N);
    CHECK(*m.steady_speed_m_s == test::approx(s.speed_m_s).epsilon(2e-3));
    CHECK(*m.steady_normal_force_N == test::approx(s.normal_force_N).epsilon(1e-3));
    CHECK(std::abs(m.normal_offset_N->value - offset) < 5 * m.normal_offset_N->sd + 1e-5);
    CHECK(m.normal_noise_N == test::approx(s.gauge_noise_N).epsilon(0.05));
    CHECK(static_cast<double>(m.steady_begin) / s.rate_Hz == test::approx(s.rise_s + s.onset_s).epsilon(0.1));
    CHECK(static_cast<double>(m.steady_end) / s.rate_Hz == test::approx(s.lift_s).epsilon(0.02));
    CHECK(m.normal_N(20000) == m.normal_force_N[20000] - m.normal_offset_N->value);
  }
}

TEST_CASE("without a lift nothing is taken off, and a changing force is no offset") {
  test::stroke s;
  s.lift_s = 10, s.offset_N = 0.05, s.onset_s = 0;
  auto m = rosin::motion_of(test::bowed_take(s), test::bowed_signals(s));
  CHECK_FALSE(m.normal_offset_N);
  CHECK(*m.steady_normal_force_N == test::approx(s.normal_force_N + 0.05).epsilon(1e-3));
  auto signals = test::bowed_signals(s);
  for (std::size_t i = 0; i < signals.frames(); ++i)  // from half of the force to all of it
    signals.signals[0].values[i] *= 0.5 + 0.5 * static_cast<double>(i) / static_cast<double>(signals.frames());
  CHECK_FALSE(rosin::motion_of(test::bowed_take(s), signals).normal_offset_N);
}

TEST_CASE("what was called steady is taken as far as the channels bear it out") {
  const test::stroke s;
  auto take = test::bowed_take(s);
  take.steady_s = {0.3, 0.5};
  auto m = rosin::motion_of(take, test::bowed_signals(s));
  CHECK_FALSE(m.hint_doubted);
  CHECK(m.steady_begin == 15000);
  CHECK(m.steady_end == 25000);
  take.steady_s = {0.0, 0.12};  // the bow has not begun to move
  m = rosin::motion_of(take, test::bowed_signals(s));
  CHECK(m.hint_doubted);
  CHECK(m.steady_begin > 6000);
}

TEST_CASE("what is declared stays, what is not is what was measured") {
  const test::stroke s;
  auto take = test::bowed_take(s);
  const auto m = rosin::motion_of(take, test::bowed_signals(s));
  CHECK(rosin::with_measured(take, m).speed_m_s == m.steady_speed_m_s);
  take.speed_m_s = 7;
  CHECK(rosin::with_measured(take, m).speed_m_s == 7.0);
  CHECK(rosin::with_measured(take, m).normal_force_N == m.steady_normal_force_N);
  rosin::take_signals none;
  none.sample_rate_Hz = 48000;
  CHECK_FALSE(rosin::motion_of(take, none).steady_speed_m_s);
}

}  // namespace acquire_stroke_motion
