// SPDX-License-Identifier: MIT
#include <rosin/calibrate/stroke_start.hpp>

#include <doctest/doctest.h>

#include <limits>

#include "support/approx.hpp"

namespace {

rosin::stroke_take sawtooth(double pitch_Hz) {
  rosin::stroke_take t{"saw", 20e3, {}, 0.1};
  for (int i = 0; i < 8000; ++i) t.force_N[0].push_back(std::fmod(i * pitch_Hz / 20e3, 1.0));
  t.force_N[1] = t.force_N[0];
  return t;
}

}  // namespace

TEST_CASE("A string that was tuned since it was declared begins where it plays") {
  const rosin::stroke_guess guess{.fundamental_Hz = 300, .fundamental_tolerance = 0.05};
  CHECK(rosin::starting_pitch_Hz({sawtooth(309), sawtooth(309.3), sawtooth(309.2)}, guess) == test::approx(309.2).epsilon(2e-3));
  CHECK(rosin::starting_pitch_Hz({sawtooth(300.5), sawtooth(301)}, guess) == 300);               // near enough, and bows flatten
  CHECK(rosin::starting_pitch_Hz({sawtooth(305), sawtooth(309), sawtooth(313)}, guess) == 300);  // no two agree
}

TEST_CASE("Records that no fit can use are refused by take, channel, sample and reason") {
  const rosin::stroke_guess guess{.fundamental_Hz = 300};
  CHECK(rosin::problem_with({}, guess) == "no stroke to fit");
  CHECK(rosin::problem_with({sawtooth(300)}, guess).empty());
  auto bad = sawtooth(300);
  bad.force_N[1][77] = std::numeric_limits<double>::quiet_NaN();
  CHECK(rosin::problem_with({sawtooth(300), bad}, guess) == "saw: far, sample 77 is not a number");
  bad.force_N[1].assign(8000, 0.25);
  CHECK(rosin::problem_with({bad}, guess) == "saw: far is constant");
  bad.force_N[1].pop_back();
  CHECK(rosin::problem_with({bad}, guess) == "saw: near has 8000 samples, far 7999");
  for (auto& x : bad.force_N) x.resize(1000);
  CHECK(rosin::problem_with({bad}, guess) == "saw: shorter than 30 periods of the declared string");
  bad = sawtooth(300), bad.position = 1.2;
  CHECK(rosin::problem_with({bad}, guess) == "saw: the contact must lie between the ends");
}
