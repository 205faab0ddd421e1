// SPDX-License-Identifier: MIT
#include <rosin/diagnose/tone_band.hpp>

#include <doctest/doctest.h>

#include <random>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

namespace {

/// A slip of a fifth of each period, which may alternate in size and be rippled.
std::vector<double> slips(double period, double alternate, double ripple_Hz, double noise) {
  std::mt19937 source(3);
  std::normal_distribution<double> normal;
  std::vector<double> v;
  for (std::size_t i = 0; i < 4000; ++i) {
    const double t = static_cast<double>(i), which = std::floor(t / period), at = t / period - which;
    const double size = 1 + alternate * (std::fmod(which, 2) < 1 ? 1 : -1);
    v.push_back((at < 0.2 ? -size * std::sin(5 * std::numbers::pi * at) : 0) +
                0.05 * std::sin(2 * std::numbers::pi * ripple_Hz * t / 10e3) + noise * normal(source));
  }
  return v;
}

}  // namespace

TEST_CASE("tone band: the pitch of a stroke is where its motion is most like itself") {
  for (const double period : {101.3, 109.7, 130.2}) {
    const auto p = rosin::pitch_of(slips(period, 0, 83, 0.02), 100, 3900, 10e3, 100 / 10e3);
    CHECK(p.measured);
    CHECK(p.pitch_Hz == test::approx(10e3 / period).epsilon(0.002));
  }
}

TEST_CASE("tone band: a stroke that does not repeat itself, or is too short or not known, has the pitch of the string at rest") {
  const auto rest = [](const rosin::stroke_pitch& p) { return !p.measured && p.pitch_Hz == test::approx(100); };
  CHECK(rest(rosin::pitch_of(slips(105, 0.9, 83, 0.02), 100, 3900, 10e3, 0.01)));
  CHECK(rest(rosin::pitch_of(slips(105, 0, 83, 1), 100, 3900, 10e3, 0.01)));
  CHECK(rest(rosin::pitch_of(slips(155, 0, 83, 0.02), 100, 3900, 10e3, 0.01)));
  CHECK(rest(rosin::pitch_of(slips(105, 0, 83, 0.02), 100, 600, 10e3, 0.01)));
  auto gap = slips(105, 0, 83, 0.02);
  gap[500] = std::nan("");
  CHECK(rest(rosin::pitch_of(gap, 100, 3900, 10e3, 0.01)));
}

TEST_CASE("tone band: of a measured pitch only what is within a fiftieth is its own; else all that friction flattens") {
  const rosin::tone_band rest{500, {{100, false}}}, measured{500, {{100, true}}};
  for (const double own : {92.0, 100.0, 196.0, 201.0}) CHECK(rest.is_its_own(own));
  for (const double other : {40.0, 74.0, 104.0, 180.0, 231.7}) CHECK_FALSE(rest.is_its_own(other));
  for (const double high : {1046.0, 1049.9, 1050.1, 1440.0}) CHECK(rest.is_its_own(high));
  for (const double own : {98.5, 100.0, 101.5, 197.0, 203.0}) CHECK(measured.is_its_own(own));
  for (const double other : {76.0, 90.0, 97.5, 194.0, 206.0, 231.7}) CHECK_FALSE(measured.is_its_own(other));
  CHECK(measured.is_its_own(90, 12));
  CHECK_FALSE(rosin::tone_band{}.is_its_own(100));
  CHECK(rosin::tone_band{500, {{100, true}, {90, true}}}.is_its_own(89));
}

TEST_CASE("tone band: strokes of a string that is pressed hard repeat themselves below the pitch at rest, or at it") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 61);
  rosin::stick_bench bench({a.take()}, contact_rigs::declared());
  const auto pitches = rosin::pitches_of(bench);
  REQUIRE(pitches.size() == 1);
  CHECK(pitches[0].measured);
  CHECK(pitches[0].pitch_Hz < 1.01 * contact_rigs::e_string.fundamental_Hz);
  CHECK(pitches[0].pitch_Hz > 0.9 * contact_rigs::e_string.fundamental_Hz);
}
