// SPDX-License-Identifier: MIT
#include <rosin/simulate/burdened_take.hpp>

#include <rosin/friction/friction_curves.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/modal_pluck.hpp>

#include "support/apart.hpp"
#include "support/approx.hpp"

#include <doctest/doctest.h>

namespace simulate_burdened_take {

namespace {

const rosin::modal_rig rig{
    {.length_m = 0.32, .tension_N = 70, .fundamental_Hz = 640, .bending_stiffness_Nm2 = 4e-5, .loss = {.quality = 1000}},
    {7, 3.5, 15}};
constexpr double rate_Hz = 128000;
constexpr int oversampling = 16;
constexpr double step_s = 1 / rate_Hz / oversampling;

}  // namespace

TEST_CASE("a pluck of a string without a burden is that of the closed form") {
  const rosin::modal_decimator decimate{rosin::modal_settings{}.low_pass(), step_s, oversampling};
  const double lead_s = static_cast<double>(decimate.reach()) * step_s;
  for (const double duration : {0.0, 40e-6}) {
    const auto steps = rosin::step_pluck(rig, {}, {.release_s = 0.004 + lead_s, .release_duration_s = duration},
                                         0.02 + 2 * lead_s, 250e3, step_s);
    const auto near = decimate.points(steps.end_N[0]);
    const auto truth = rosin::simulate_pluck(rig, {.release_s = 0.004, .release_duration_s = duration, .duration_s = 0.02});
    REQUIRE(truth);
    CHECK(test::apart(near, std::span(truth->force_near_N).first(2400)) < (duration > 0 ? 5e-5 : 1e-6));
  }
}

TEST_CASE("a wire of some width plucks as many narrow ones beside each other do") {
  constexpr double width_m = 0.004, duration_s = 0.006;
  const rosin::burdened_pluck narrow{.position = 0.3, .force_N = 1, .release_s = 0.001};
  auto wide = narrow;
  wide.width_m = width_m;
  const auto steps = rosin::step_pluck(rig, {}, wide, duration_s, 150e3, step_s);
  constexpr int wires = 24;
  std::vector<double> sum(steps.end_N[0].size());
  for (int i = 0; i < wires; ++i) {
    auto one = narrow;
    one.position += width_m / rig.string.length_m * ((i + 0.5) / wires - 0.5);
    const auto of_one = rosin::step_pluck(rig, {}, one, duration_s, 150e3, step_s);
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += of_one.end_N[0][n] / wires;
  }
  CHECK(test::apart(steps.end_N[0], sum) < 2e-3);  // all frequencies alike
  CHECK(test::apart(rosin::step_pluck(rig, {}, narrow, duration_s, 150e3, step_s).end_N[0], sum) > 0.015);
}

TEST_CASE("a transducer that feels the tension reads the string's strain besides") {
  const rosin::burdened_pluck pluck{.position = 0.3, .force_N = 1, .release_s = 0.001};
  const auto plain = rosin::step_pluck(rig, {}, pluck, 0.006, 60e3, step_s),
             felt = rosin::step_pluck(rig, {.sensed_stiffness_N = {0, -2000}}, pluck, 0.006, 60e3, step_s);
  CHECK(felt.end_N[0] == plain.end_N[0]);
  const double held = std::pow(1 / rig.string.tension_N, 2) * 0.3 * 0.7 / 2;
  CHECK(felt.end_N[1][100] - plain.end_N[1][100] == test::approx(-2000 * held).epsilon(0.02));
  double most = -1e9, least = 1e9;  // it sways twice a period, never below nothing
  for (std::size_t n = 4000; n < felt.end_N[1].size(); ++n) {
    const double strain = (felt.end_N[1][n] - plain.end_N[1][n]) / -2000;
    most = std::max(most, strain), least = std::min(least, strain);
  }
  CHECK(least > 0);
  CHECK(most < held);
  CHECK(most > 0.8 * held);
}

TEST_CASE("a stroke is that of modal_stroke; a contact of no width is one of very little; a heavy rod does not yield") {
  const rosin::velocity_curve<rosin::two_exponential_curve<double>> law{{0.38, 0.02, 0.42, 0.14, 0.35}};
  const rosin::steady_rod motion{.speed_m_s = 0.2, .normal_force_N = 0.3};
  const auto play = [&](const rosin::yielding_rod& rod, double width, int places = 2) {
    return rosin::step_stroke(rig, {}, law, motion, rod, 0.3, width, 0.02, 250e3, step_s, 0, places);
  };
  const auto plain = play({}, 0);
  const rosin::modal_contact peer{rig, 0.3, 250e3, step_s};
  CHECK(plain.force_N.size() == plain.end_N[0].size());
  CHECK(test::apart(play({100, 900, 10}, 0).force_N, plain.force_N) < 1e-3);
  CHECK(test::apart(play({0.003, 900, 10}, 0).force_N, plain.force_N) > 0.02);
  const auto early = static_cast<std::size_t>(0.0075 / step_s);  // until the first slips: then the smallest difference grows
  CHECK(test::apart(play({}, 1e-5).force_N, std::span(plain.force_N).first(early)) < 0.02);
  CHECK(test::apart(play({}, 1e-5, 5).force_N, std::span(plain.force_N).first(early)) < 0.02);
  CHECK(test::apart(play({}, 3e-3, 5).force_N, play({}, 3e-3).force_N) > 0.1);

  rosin::modal_settings settings{.oversampling = oversampling};
  const auto other = rosin::simulate_stroke(rig, law, motion, {.position = 0.3, .duration_s = 0.02}, settings);
  REQUIRE(other);
  const rosin::modal_decimator decimate{settings.low_pass(), step_s, oversampling};
  const auto near = decimate.points(plain.end_N[0]);
  std::vector<double> same(other->force_near_N.begin(), other->force_near_N.begin() + static_cast<std::ptrdiff_t>(near.size()));
  // The first sample of `near` is reach() steps later.
  std::vector<double> late;
  const double offset = static_cast<double>(decimate.reach()) / oversampling;
  for (std::size_t i = 0; i + 60 < near.size(); ++i) {
    const auto j = static_cast<std::size_t>(static_cast<double>(i) + offset);
    const double u = static_cast<double>(i) + offset - static_cast<double>(j);
    late.push_back((1 - u) * other->force_near_N[j] + u * other->force_near_N[j + 1]);
  }
  CHECK(test::apart(near, std::span(late).first(900)) < 0.05);  // up to the straight line between two samples
}

}  // namespace simulate_burdened_take
