// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_ripple.hpp>

#include <doctest/doctest.h>

#include <random>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

namespace {

/// Patches of 30 samples out of every 100.
rosin::tone_rows patches(double size, double f, double noise, unsigned seed) {
  std::mt19937 source(seed);
  std::normal_distribution<double> normal;
  rosin::tone_rows r;
  r.rate_Hz = 10e3;
  std::vector<double> residual;
  for (std::size_t i = 0; i < 10000; ++i) {
    if (i % 100 >= 30) continue;
    r.sample.push_back(i);
    residual.push_back(2 * size * std::sin(2 * std::numbers::pi * f * static_cast<double>(i) / r.rate_Hz + 1) +
                       noise * normal(source));
  }
  const auto n = static_cast<Eigen::Index>(residual.size());
  r.residual = Eigen::Map<Eigen::VectorXd>(residual.data(), n);
  r.carrier = Eigen::VectorXd::Constant(n, 2);
  r.weight = Eigen::VectorXd::Ones(n);
  return r;
}

}  // namespace

TEST_CASE("ripple: a tone in patches, its frequency and size, and that it lasts") {
  const std::vector<rosin::tone_rows> takes{patches(0.03, 97.3, 0.1, 1), patches(0.03, 97.3, 0.1, 2)};
  const auto tone = rosin::find_tone(takes);
  CHECK(tone.frequency_Hz == test::approx(97.3).epsilon(0.002));
  CHECK(tone.size == test::approx(0.03).epsilon(0.1));
  CHECK(std::arg(std::complex<double>(tone.relative[0].real(), tone.relative[0].imag())) == test::approx(1).epsilon(0.2));
  CHECK(rosin::tone_prediction(takes, tone.frequency_Hz) > 0.7 * tone.explained);
}

TEST_CASE("ripple: a scan explains at each step what its frequency alone does") {
  const std::vector<rosin::tone_rows> takes{patches(0.03, 97.3, 0.1, 1), patches(0.01, 97.3, 0.1, 2)};
  rosin::detail::tone_scan scan(takes, 20, 0.37);
  for (int k = 0; k < 1000; ++k) {
    const double here = scan.next();
    if (k % 111 == 0) CHECK(here == test::approx(rosin::detail::explained_at(takes, 20 + 0.37 * k)).epsilon(1e-9));
  }
}

TEST_CASE("ripple: the strongest frequency of noise that is not white does not stand out, a tone in it does") {
  int named = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::vector<rosin::tone_rows> takes{patches(0, 97.3, 0.01, seed), patches(0, 97.3, 0.01, seed + 50)}, toned = takes;
    std::mt19937 source(seed + 100);
    std::normal_distribution<double> normal;
    for (std::size_t t = 0; t < 2; ++t) {
      double now = 0;
      std::size_t at = 0;
      for (std::size_t k = 0; k < takes[t].sample.size(); ++k) {
        for (; at <= takes[t].sample[k]; ++at) now += 0.1 * (0.1 * normal(source) - now);  // below 170 Hz
        const auto i = static_cast<Eigen::Index>(k);
        takes[t].residual[i] += now;
        toned[t].residual[i] =
            takes[t].residual[i] + 0.03 * std::sin(2 * std::numbers::pi * 97.3 * static_cast<double>(takes[t].sample[k]) / 10e3);
      }
    }
    named += rosin::find_tone(takes).stands_out() ? 1 : 0;
    CHECK(rosin::find_tone(toned).stands_out());
  }
  CHECK(named <= 2);
}

TEST_CASE("ripple: noise alone predicts nothing") {
  const std::vector<rosin::tone_rows> takes{patches(0, 97.3, 0.1, 3), patches(0, 97.3, 0.1, 4)};
  const auto tone = rosin::find_tone(takes);
  CHECK(tone.explained < 12 * 0.1 * 0.1 * 2);
  CHECK(rosin::tone_prediction(takes, tone.frequency_Hz) < 0.7 * tone.explained);
  CHECK(rosin::find_tone({}).explained == 0);
}

TEST_CASE("ripple: above the pitch as well, but not where the string repeats itself") {
  const rosin::tone_band band{500, {{100, false}}};
  const std::vector<rosin::tone_rows> between{patches(0.03, 231.7, 0.1, 5), patches(0.03, 231.7, 0.1, 6)};
  CHECK(rosin::find_tone(between, band).frequency_Hz == test::approx(231.7).epsilon(0.002));
  for (const double own : {92.0, 100.0, 196.0, 201.0}) {
    const std::vector<rosin::tone_rows> on{patches(0.03, own, 0.1, 7), patches(0.03, own, 0.1, 8)};
    CHECK_FALSE(band.is_its_own(rosin::find_tone(on, band).frequency_Hz));
  }
  const std::vector<rosin::tone_rows> below{patches(0.03, 88, 0.1, 7), patches(0.03, 88, 0.1, 8)};
  CHECK(rosin::find_tone(below, {500, {{100, true}}}).frequency_Hz == test::approx(88).epsilon(0.002));
  CHECK(rosin::find_tone(below, band).frequency_Hz != test::approx(88).epsilon(0.1));
  auto brief = between;
  for (auto& r : brief) {  // 0.04 s, four periods: there is nowhere to look
    r.sample.resize(120);
    for (auto* v : {&r.residual, &r.carrier, &r.weight}) v->conservativeResize(120);
  }
  CHECK(rosin::find_tone(brief, band).frequency_Hz == 0);
}

TEST_CASE("ripple: rows put together give the same sums as long as a tone hardly moves on between them") {
  auto all = patches(0.03, 97.3, 0.1, 9);
  for (Eigen::Index i = 0; i < all.weight.size(); ++i) all.weight[i] = 0.5 + 0.5 * std::sin(0.3 * static_cast<double>(i));
  const auto few = rosin::detail::gathered(all, 4e-4);
  CHECK(few.sample.size() == 6 * 100);  // of 30 in a patch
  const double most = rosin::detail::explained_at({all}, 97.3);
  for (const double f : {20.0, 97.3, 250.0})
    CHECK(std::abs(rosin::detail::explained_at({few}, f) - rosin::detail::explained_at({all}, f)) < 0.03 * most);
}

TEST_CASE("ripple: a rod whose speed is not steady") {
  auto slow = contact_rigs::slow(), fast = contact_rigs::fast();
  slow.speed_Hz = fast.speed_Hz = 143;
  slow.speed_relative = fast.speed_relative = 0.02;
  const auto a = contact_rigs::play(contact_rigs::curve(), slow, contact_rigs::rolls, 41),
             b = contact_rigs::play(contact_rigs::curve(), fast, contact_rigs::rolls, 43);
  rosin::stick_bench bench({a.take(), b.take()}, contact_rigs::declared());
  REQUIRE(bench.usable());
  const auto h = rosin::speed_ripple_hypothesis(bench);
  CHECK(h.decided);
  CHECK(h.gain > 200);
  CHECK(h.held_out_gain > 100);
  CHECK(h.parameters[0].value == test::approx(143).epsilon(0.005));
  CHECK(h.parameters[1].value == test::approx(0.02).epsilon(0.05));
  // once it is known, motion is taken against the rod as it moved, most of all where it does not stick
  rosin::stick_bench steady({a.take(), b.take()}, rosin::include(contact_rigs::declared(), h));
  const auto &before = bench.relative_m_s()[0], &after = steady.relative_m_s()[0];
  std::vector<char> sticks(before.size(), 0);
  const auto& at = bench.declared().rows[0].sample;
  for (const std::size_t i : at) sticks[i] = sticks[i + 1] = 1;
  double taken = 0, stuck = 0, slips = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    if (!sticks[i]) taken += std::pow(before[i] - after[i], 2), ++slips;
  for (const std::size_t i : at) stuck += std::pow(after[i], 2);
  CHECK(std::sqrt(taken / slips) == test::approx(0.02 / std::numbers::sqrt2 * a.speed).epsilon(0.15));
  CHECK(std::sqrt(stuck / static_cast<double>(at.size())) < 0.5 * 0.02 / std::numbers::sqrt2 * a.speed);
}
