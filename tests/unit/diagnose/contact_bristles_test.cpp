// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_bristles.hpp>

#include <doctest/doctest.h>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

namespace {

double named_value(const rosin::contact_hypothesis& h, const char* name) {
  for (const auto& p : h.parameters)
    if (p.name == name) return p.value;
  return -1;
}

using bristles = rosin::elasto_plastic<rosin::two_exponential_curve<>>;

/// Strokes over bristles of a stiffness that is the same in both; the sensors' noise in newtons.
struct bristly {
  contact_rigs::stroke slow, fast;
  explicit bristly(double stiffness_N_m, double noise_N = 0.3e-3) {
    constexpr double normal_N = 0.4;
    const bristles law{{}, {.stiffness_1_m = stiffness_N_m / normal_N, .damping_Ns_m = 0.01, .kinetic = 0.35}};
    auto rod = contact_rigs::slow(), other_rod = contact_rigs::fast();
    rod.steady.normal_force_N = other_rod.steady.normal_force_N = normal_N;
    slow = contact_rigs::play(law, rod, contact_rigs::rolls, 21, 0.27, 0.1, noise_N);
    fast = contact_rigs::play(law, other_rod, contact_rigs::rolls, 23, 0.27, 0.1, noise_N);
  }
  [[nodiscard]] std::vector<rosin::contact_take> takes() const { return {slow.take(), fast.take()}; }
};

}  // namespace

TEST_CASE("contact bristles: their stiffness, and that they let go bit by bit" * doctest::test_suite("long")) {
  for (const double stiffness : {1.5e4, 3e4}) {
    const bristly strokes(stiffness);
    rosin::stick_bench bench(strokes.takes(), contact_rigs::declared());
    REQUIRE(bench.usable());
    const auto h = rosin::bristle_hypothesis(bench, strokes.takes());
    CHECK(h.decided);
    CHECK(h.gain > 200);
    CHECK(named_value(h, "bristle_stiffness_N_m") == test::approx(stiffness).epsilon(0.03));
    CHECK(named_value(h, "friction_limit") > 0);
    CHECK(h.fluctuation < 1.1 * h.noise);  // nothing is left but noise
    CHECK(rosin::rod_hypothesis(bench).density < h.density);
    bench = rosin::stick_bench(strokes.takes(), rosin::include(contact_rigs::declared(), h));
    CHECK(bench.fit().solution.scale < 1.1 * h.noise * bench.speed_m_s());  // the model that was told of them sees no more
  }
}

TEST_CASE("contact bristles: sensors ten times as noisy do not make them stiffer" * doctest::test_suite("long")) {
  const bristly strokes(1.5e4, 3e-3);
  rosin::stick_bench bench(strokes.takes(), contact_rigs::declared());
  REQUIRE(bench.usable());
  const auto plain = rosin::bristle_hypothesis(bench), h = rosin::bristle_hypothesis(bench, strokes.takes());
  CHECK(named_value(plain, "bristle_stiffness_N_m") > 1.2 * 1.5e4);  // in the whole band they would
  CHECK(h.decided);
  const auto& s0 = h.parameters.front();
  CHECK(s0.value == test::approx(1.5e4).epsilon(0.05));
  CHECK(std::abs(s0.value - 1.5e4) < 1.96 * s0.sd);
  CHECK(h.fluctuation < 1.2 * h.noise);
}

TEST_CASE("contact bristles: of a law without bristles they are not claimed") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 31),
             b = contact_rigs::play(contact_rigs::curve(), contact_rigs::fast(), contact_rigs::rolls, 33);
  const std::vector<rosin::contact_take> takes{a.take(), b.take()};
  rosin::stick_bench bench(takes, contact_rigs::declared());
  REQUIRE(bench.usable());
  const auto h = rosin::bristle_hypothesis(bench, takes);
  CHECK((!h.decided || h.gain < 40));
}
