// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_slip_effects.hpp>
#include <rosin/reconstruct/dc_level.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"
#include "slips_by_hand.hpp"
#include "support/approx.hpp"

#include <random>

TEST_CASE("contact slip effects: a normal force that is not steady shows in slips alone") {
  auto slow = contact_rigs::slow(), fast = contact_rigs::fast();
  slow.normal_Hz = fast.normal_Hz = 118;
  slow.normal_relative = fast.normal_relative = 0.08;
  const auto a = contact_rigs::play(contact_rigs::curve(), slow, contact_rigs::rolls, 51),
             b = contact_rigs::play(contact_rigs::curve(), fast, contact_rigs::rolls, 53);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  rosin::stick_bench sticks(takes, contact_rigs::declared());
  const rosin::slip_bench bench(sticks, takes);
  REQUIRE(bench.usable());
  const auto h = rosin::normal_ripple_hypothesis(bench);
  CHECK(h.decided);
  CHECK(h.gain > 60);
  CHECK(h.held_out_gain > 30);
  CHECK(h.parameters[0].value == test::approx(118).epsilon(0.01));
  CHECK(h.parameters[1].value == test::approx(0.08).epsilon(0.1));
  CHECK(rosin::speed_ripple_hypothesis(sticks).gain < 20);
  // once it is part of the model, nothing of it is left
  auto model = rosin::include(contact_rigs::declared(), h);
  rosin::stick_bench again(takes, model);
  const rosin::slip_bench rest(again, takes);
  CHECK(rest.declared().residual() < 0.5 * bench.declared().residual());
}

TEST_CASE("contact slip effects: a normal force that ripples faster than the string sounds") {
  auto slow = contact_rigs::slow(), fast = contact_rigs::fast();
  slow.normal_Hz = fast.normal_Hz = 790;
  slow.normal_relative = fast.normal_relative = 0.08;
  const auto a = contact_rigs::play(contact_rigs::curve(), slow, contact_rigs::rolls, 55),
             b = contact_rigs::play(contact_rigs::curve(), fast, contact_rigs::rolls, 57);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  rosin::stick_bench sticks(takes, contact_rigs::declared());
  const auto h = rosin::normal_ripple_hypothesis(rosin::slip_bench(sticks, takes));
  CHECK(h.decided);
  CHECK(h.gain > 60);
  CHECK(h.parameters[0].value == test::approx(790).epsilon(0.002));
  CHECK(h.parameters[1].value == test::approx(0.08).epsilon(0.1));
}

TEST_CASE(
    "contact slip effects: where sensors lost the mean force, strokes may be off by a constant, and a ripple's size holds that "
    "doubt" *
    doctest::test_suite("long")) {
  auto slow = contact_rigs::slow(), fast = contact_rigs::fast();
  slow.normal_Hz = fast.normal_Hz = 118;
  slow.normal_relative = fast.normal_relative = 0.08;
  auto a = contact_rigs::play(contact_rigs::curve(), slow, contact_rigs::rolls, 51),
       b = contact_rigs::play(contact_rigs::curve(), fast, contact_rigs::rolls, 53);
  double level_N = 0.1;
  for (auto* s : {&a, &b}) {
    for (double& f : s->force) f -= level_N;
    level_N = 0.16;
  }
  const auto look = [&](bool estimated) {
    std::vector<rosin::contact_take> takes{a.take(), b.take()};
    for (auto* s : {&a, &b}) {
      auto& t = takes[s == &a ? 0 : 1];
      const auto dc = rosin::estimate_dc_level(s->force, s->velocity, s->speed, s->normal);
      REQUIRE(dc.available);
      if (estimated)
        for (double& f : s->force) f += dc.level_N;
      t.level_sd_N = estimated ? dc.sd_N : 0;
    }
    rosin::stick_bench sticks(takes, contact_rigs::declared());
    const rosin::slip_bench bench(sticks, takes);
    return std::pair{rosin::normal_ripple_hypothesis(bench), bench.declared().residual()};
  };
  const auto lost = look(false), level = look(true);
  const auto& size = level.first.parameters[1];
  CHECK(level.first.gain > 60);
  CHECK(std::abs(size.value - 0.08) < 2 * size.sd);
  CHECK(size.sd > 0.1 * size.value);
  CHECK(size.sd < 0.6 * size.value);
  CHECK(level.second < lost.second);
}

TEST_CASE(
    "contact slip effects: heat under a normal force that ripples is told only with the ripple taken out, and the ripple's size "
    "with the heat in" *
    doctest::test_suite("long")) {
  const rosin::contact_heat_parameters<double> heat{.layer_m = 3e-6, .area_per_newton_m2 = 1e-7};
  const auto strength = rosin::design_yield_curve(rosin::two_exponential_curve<>{}, heat.without_string(), 0.3);
  REQUIRE(strength);
  const rosin::thermal_plastic<double> law{*strength, heat};
  auto slow = contact_rigs::slow(), fast = contact_rigs::fast();
  slow.normal_Hz = fast.normal_Hz = 118;
  slow.normal_relative = fast.normal_relative = 0.2;
  const auto a = contact_rigs::play(law, slow, contact_rigs::rolls, 81),
             b = contact_rigs::play(law, fast, contact_rigs::rolls, 83);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  rosin::stick_bench sticks(takes, contact_rigs::declared());
  const rosin::slip_bench ignorant(sticks, takes);
  const auto ripple = rosin::normal_ripple_hypothesis(ignorant), alone = rosin::law_hypothesis(ignorant);
  const auto model = rosin::include(contact_rigs::declared(), ripple);
  rosin::stick_bench steady(takes, model);
  const rosin::slip_bench curve(steady, takes);
  const auto beside = rosin::law_hypothesis(curve);
  CHECK(beside.effect == "thermal-friction");
  CHECK(beside.density > 1.5 * alone.density);
  CHECK(beside.fluctuation < 0.7 * curve.declared().residual());
  for (const auto* heard : {&alone, &beside}) {
    rosin::stick_bench warm(takes, rosin::include(contact_rigs::declared(), *heard));
    const auto size = rosin::normal_ripple_hypothesis(rosin::slip_bench(warm, takes)).parameters[1].value;
    CHECK(size == test::approx(0.2).epsilon(0.03));
  }
  const auto known = rosin::include(contact_rigs::declared(), beside).heat;  // taken for granted once it is part of the model
  REQUIRE(known);
  CHECK((*known)[0] == beside.parameters[0].value);
}

TEST_CASE("contact slip effects: a velocity curve as declared gains by nothing") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 61),
             b = contact_rigs::play(contact_rigs::curve(), contact_rigs::fast(), contact_rigs::rolls, 63);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  rosin::stick_bench sticks(takes, contact_rigs::declared());
  const rosin::slip_bench bench(sticks, takes);
  REQUIRE(bench.usable());
  CHECK(bench.declared().residual() < 0.02);
  const auto ripple = rosin::normal_ripple_hypothesis(bench);
  CHECK((!ripple.decided || ripple.gain < 20));
  CHECK(rosin::law_hypothesis(bench).gain < 20);
}

TEST_CASE("contact slip effects: heat is told as well where the curve leaves as little as imperfect models do" *
          doctest::test_suite("long")) {
  const rosin::contact_heat_parameters<double> heat{.layer_m = 1e-6, .area_per_newton_m2 = 3e-8};
  const auto strength = rosin::design_yield_curve(rosin::two_exponential_curve<>{}, heat.without_string(), 0.3);
  REQUIRE(strength);
  const rosin::thermal_plastic<double> law{*strength, heat};
  const auto a = contact_rigs::play(law, contact_rigs::slow(), contact_rigs::rolls, 81),
             b = contact_rigs::play(law, contact_rigs::fast(), contact_rigs::rolls, 83);
  std::vector<rosin::contact_take> takes{a.take(), b.take()};
  constexpr double harder = 20;  // all coefficients of friction are so many times smaller
  for (auto& t : takes) t.normal_force_N *= harder;
  rosin::stick_bench sticks(takes, contact_rigs::declared());
  const rosin::slip_bench bench(sticks, takes);
  REQUIRE(bench.usable());
  CHECK(bench.declared().residual() < 2 * bench.floor());
  CHECK(bench.declared().residual() > 2 * bench.least_floor());
  const auto h = rosin::law_hypothesis(bench);
  CHECK(h.decided);
  CHECK(h.gain > 100);
  CHECK(h.held_out_gain > 50);
  CHECK(h.fluctuation < 0.5 * bench.declared().residual());
}

TEST_CASE("contact slip effects: heat that takes little of what the curve leaves is not what is wrong" *
          doctest::test_suite("long")) {
  const rosin::contact_heat_parameters<double> heat{.layer_m = 1e-6, .area_per_newton_m2 = 3e-8};
  const auto strength = rosin::design_yield_curve(rosin::two_exponential_curve<>{}, heat.without_string(), 0.3);
  REQUIRE(strength);
  const rosin::thermal_plastic<double> law{*strength, heat};
  auto a = contact_rigs::play(law, contact_rigs::slow(), contact_rigs::rolls, 81),
       b = contact_rigs::play(law, contact_rigs::fast(), contact_rigs::rolls, 83);
  std::mt19937 random(5);
  std::normal_distribution<double> rough_N(0, 0.16);
  for (auto* stroke : {&a, &b})
    for (double& f : stroke->force) f += rough_N(random);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  rosin::stick_bench sticks(takes, contact_rigs::declared());
  const rosin::slip_bench bench(sticks, takes);
  REQUIRE(bench.usable());
  const auto h = rosin::law_hypothesis(bench);
  CHECK(h.density > 50);
  CHECK(h.fluctuation > 0.85 * bench.declared().residual());
  CHECK_FALSE(h.decided);
  CHECK(h.gain == 0);
}

TEST_CASE("contact slip effects: strokes on two materials tell of a law by their halves" * doctest::test_suite("long")) {
  double heat = 0;
  std::vector<rosin::slip_record> records;
  for (const double material : {1.0, 1.5}) {
    heat = 0;
    records.push_back(rosin_test::slips_by_hand(1, 20000, 0.4, [&](double v, double normal_N) {
      const double mu = material * (0.4 + 0.5 / (1 + std::pow(heat / 0.2, 4)));
      heat = heat * std::exp(-(400 + 2500 * v) / rosin_test::slip_rate_Hz) + v * normal_N * mu * 1e3 / rosin_test::slip_rate_Hz;
      return mu;
    }));
  }
  auto curve = rosin::fit_velocity_curve(records, 1e-4), thermal = rosin::fit_thermal(records, 1e-4);
  CHECK(rosin::detail::predicts_halves_better(thermal.design, curve.design, 1e-4) > 500);
  CHECK(rosin::detail::predicts_halves_better(curve.design, thermal.design, 1e-4) == 0);
  // one stroke that is not told better is enough to say no
  thermal.design.rows[1] = curve.design.rows[1];
  CHECK(rosin::detail::predicts_halves_better(thermal.design, curve.design, 1e-4) == 0);
}

TEST_CASE("contact slip effects: a law is asked to foretell a stroke only as far as the other one tells of it" *
          doctest::test_suite("long")) {
  // heat that fades by itself, friction that falls with it; the stronger stroke gets far hotter
  double heat = 0;
  const auto fading = [&heat](double v, double normal_N) {
    const double mu = 0.4 + 0.5 / (1 + std::pow(heat / 0.2, 4));
    heat = heat * std::exp(-(400 + 2500 * v) / rosin_test::slip_rate_Hz) + v * normal_N * mu * 1e3 / rosin_test::slip_rate_Hz;
    return mu;
  };
  std::vector<rosin::slip_record> records;
  for (const double strength : {1.0, 1.6}) heat = 0, records.push_back(rosin_test::slips_by_hand(strength, 20000, 0.4, fading));
  const auto curve = rosin::fit_velocity_curve(records, 1e-4), thermal = rosin::fit_thermal(records, 1e-4);
  const auto told = rosin::detail::told_by_others(thermal.design.rows, 1);
  const auto count = std::count(told.begin(), told.end(), 1);
  CHECK(count > 100);
  CHECK(count < static_cast<std::ptrdiff_t>(told.size()) / 2);
  CHECK(rosin::detail::predicts_better(thermal.design, curve.design, 1e-4) > 500);
  CHECK(rosin::detail::predicts_better(curve.design, curve.design, 1e-4) == 0);
}

TEST_CASE("contact slip effects: a row counts where the other strokes have samples under the same pieces of the spline") {
  rosin::stick_rows seen, asked;
  seen.shared = Eigen::MatrixXd::Zero(30, 3), asked.shared = Eigen::MatrixXd::Zero(4, 3);
  seen.shared.col(0).head(20).setOnes(), seen.shared.col(1).segment(20, 8).setOnes(), seen.shared.col(2).tail(2).setOnes();
  asked.shared.row(0) << 0.5, 0.5, 0;
  asked.shared.row(1) << 0, 0.95, 0.05;
  asked.shared.row(2) << 0, 0.7, 0.3;     // two samples are too few
  asked.shared.row(3) << 0.1, -0.2, 0.1;  // keeps the spline smooth
  CHECK(rosin::detail::told_by_others({seen, asked}, 1) == std::vector<char>{1, 1, 0, 0});
}
