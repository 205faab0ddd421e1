// SPDX-License-Identifier: MIT
#include <rosin/diagnose/rod_beside_bristles.hpp>

#include <doctest/doctest.h>

#include <rosin/diagnose/contact_bristles.hpp>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

namespace {

using bristle_law = rosin::elasto_plastic<rosin::two_exponential_curve<>>;

/// What is said of a rod once the bristles over it are known, from two strokes; and of the whole band.
template <class Law>
[[nodiscard]] std::array<rosin::contact_hypothesis, 2> rod_under(const Law& law) {
  auto slow_rod = contact_rigs::slow(), fast_rod = contact_rigs::fast();
  slow_rod.steady.normal_force_N = fast_rod.steady.normal_force_N = 0.4;
  const auto slow = contact_rigs::play(law, slow_rod, contact_rigs::rolls, 41),
             fast = contact_rigs::play(law, fast_rod, contact_rigs::rolls, 43);
  const std::vector<rosin::contact_take> takes{slow.take(), fast.take()};
  rosin::stick_bench bench(takes, contact_rigs::declared());
  REQUIRE(bench.usable());
  const auto bristles = rosin::bristle_hypothesis(bench, takes);
  REQUIRE(bristles.decided);
  rosin::stick_bench with(takes, rosin::include(contact_rigs::declared(), bristles));
  return {rosin::rod_beside_bristles(with, takes), rosin::rod_hypothesis(with)};
}

const bristle_law bristly_curve{{}, {.stiffness_1_m = 1.5e4 / 0.4, .damping_Ns_m = 0.01, .kinetic = 0.35}};

}  // namespace

TEST_CASE("rod beside bristles: it is told where the whole band does not tell it" * doctest::test_suite("long")) {
  const contact_rigs::springy_rod<bristle_law> law{bristly_curve, 1800, 14, 0.003};
  const auto [rod, whole] = rod_under(law);
  CHECK(rod.decided);
  CHECK(rod.of_samples > 300);
  CHECK(rod.gain > 0.07 * rod.of_samples);
  CHECK(rod.held_out_gain > 0.07 * rod.of_samples);
  const double truth[] = {1800, 14, 0.003};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = rod.parameters[i].name;
    CAPTURE(name);
    CHECK(std::abs(rod.parameters[i].value - truth[i]) < 1.96 * rod.parameters[i].sd);
    CHECK(rod.parameters[i].sd < 0.2 * truth[i]);
  }
  CHECK(rod.gain > 1.5 * whole.gain);
}

TEST_CASE("rod beside bristles: of a rod that does not give way it is not claimed" * doctest::test_suite("long")) {
  const auto rod = rod_under(bristly_curve).front();
  CHECK((!rod.decided || rod.gain < 0.035 * rod.of_samples));
}

TEST_CASE("rod beside bristles: a narrow band knows the velocity as well as its versions agree there") {
  constexpr std::size_t n = 6400;
  constexpr double rate = 64e3, low_Hz = 1e3, high_Hz = 24e3;
  std::vector<double> mean(n, 0.1), near = mean, far = mean;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / rate,
                 apart = 0.01 * std::sin(2 * std::numbers::pi * low_Hz * t) + 0.05 * std::sin(2 * std::numbers::pi * high_Hz * t);
    near[i] += apart, far[i] -= apart;
  }
  near.front() = far.back() = std::nan("");  // as at the ends of a reconstruction
  const auto low = rosin::in_band({{.name = "bow",
                                    .velocity_m_s = mean,
                                    .velocity_near_m_s = near,
                                    .velocity_far_m_s = far,
                                    .rate_Hz = rate,
                                    .velocity_sd_m_s = 0.02,
                                    .edge_Hz = 27e3}},
                                  12e3);
  const rosin::contact_take& t = low.takes.front();
  CHECK(t.edge_Hz == 12e3);
  CHECK(t.velocity_sd_m_s == test::approx(0.02 * std::sqrt(12.0 / 27)));
  CHECK(std::isnan(t.velocity_near_m_s.front()));
  double square = 0;
  for (std::size_t i = n / 4; i < 3 * n / 4; ++i) {
    const double apart = 0.5 * (t.velocity_near_m_s[i] - t.velocity_far_m_s[i]);
    square += apart * apart;
    CHECK(0.5 * (t.velocity_near_m_s[i] + t.velocity_far_m_s[i]) == test::approx(mean[i]));
  }
  const double passed = std::pow(std::cos(0.5 * std::numbers::pi * low_Hz / 12e3), 2);
  CHECK(std::sqrt(2 * square / (n / 2)) == test::approx(0.01 * passed).epsilon(0.01));
  CHECK(rosin::in_band({t}, 20e3).takes.front().edge_Hz == 12e3);  // it does not widen
}
