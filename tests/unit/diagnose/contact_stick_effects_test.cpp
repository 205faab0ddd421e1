// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_stick_effects.hpp>

#include <doctest/doctest.h>

#include <rosin/diagnose/contact_bristles.hpp>
#include <rosin/friction/creep.hpp>

#include "contact_rigs.hpp"
#include "support/approx.hpp"

namespace {

double value(const rosin::contact_hypothesis& h, const char* name) {
  for (const auto& p : h.parameters)
    if (p.name == name) return p.value;
  return -1;
}

/// A slow and a fast stroke, and the bench that looks at them with the torsion they were made with.
struct two_strokes {
  contact_rigs::stroke slow, fast;
  std::vector<rosin::contact_take> takes{slow.take(), fast.take()};  // views of them
  rosin::stick_bench bench{takes, contact_rigs::declared()};
};

template <class Law>
[[nodiscard]] two_strokes over(const Law& law, std::uint64_t slow_seed, std::uint64_t fast_seed) {
  return {contact_rigs::play(law, contact_rigs::slow(), contact_rigs::rolls, slow_seed),
          contact_rigs::play(law, contact_rigs::fast(), contact_rigs::rolls, fast_seed)};
}

/// What the bench says of a rod.
[[nodiscard]] rosin::contact_hypothesis rod_of(rosin::stick_bench& bench) {
  REQUIRE(bench.usable());
  bench.use_damping(rosin::torsion_damping::viscous_modes);
  return rosin::rod_hypothesis(bench);
}

}  // namespace

TEST_CASE("contact stick effects: a rod that gives way, with its frequency, q and mass" * doctest::test_suite("long")) {
  const contact_rigs::springy_rod<decltype(contact_rigs::curve())> law{contact_rigs::curve(), 1800, 14, 0.003};
  auto [slow, fast, takes, bench] = over(law, 11, 13);
  const auto rod = rod_of(bench);
  CHECK(rod.decided);
  CHECK(rod.gain > 300);
  CHECK(rod.held_out_gain > 200);
  CHECK(value(rod, "frequency_Hz") == test::approx(1800).epsilon(0.01));
  CHECK(value(rod, "q") == test::approx(14).epsilon(0.12));
  CHECK(value(rod, "mass_kg") == test::approx(0.003).epsilon(0.06));
  CHECK(rod.peculiar);
  for (const auto& other :
       {rosin::torsion_hypothesis(bench), rosin::bristle_hypothesis(bench), rosin::creep_hypothesis(bench, takes)})
    CHECK(other.density < 0.3 * rod.density);
}

TEST_CASE("contact stick effects: rods that ring for longer than a window of the transform" * doctest::test_suite("long")) {
  const struct { double frequency_Hz, q; } rods[] = {{1340, 280}, {700, 170}, {150, 60}};
  for (const auto& r : rods) {
    const contact_rigs::springy_rod<decltype(contact_rigs::curve())> law{contact_rigs::curve(), r.frequency_Hz, r.q, 0.004};
    auto [slow, fast, takes, bench] = over(law, 17, 19);
    const auto rod = rod_of(bench);
    CHECK(rod.decided);
    CHECK(value(rod, "frequency_Hz") == test::approx(r.frequency_Hz).epsilon(0.003));
    CHECK(value(rod, "q") == test::approx(r.q).epsilon(0.08));
    CHECK(value(rod, "mass_kg") == test::approx(0.004).epsilon(0.05));
  }
}

TEST_CASE("contact stick effects: a light rod is peculiar, but not within the width of a torsional mode" *
          doctest::test_suite("long")) {
  constexpr double first_Hz = 7 * 660;  // of the torsion that rolls
  for (const double frequency_Hz : {0.97 * first_Hz, 0.8 * first_Hz}) {
    CAPTURE(frequency_Hz);
    const contact_rigs::springy_rod<decltype(contact_rigs::curve())> law{contact_rigs::curve(), frequency_Hz, 14, 0.001};
    auto [slow, fast, takes, bench] = over(law, 11, 13);
    const auto rod = rod_of(bench);
    CHECK(rod.decided);
    CHECK(value(rod, "frequency_Hz") == test::approx(frequency_Hz).epsilon(0.02));
    CHECK(rod.peculiar == (frequency_Hz < 0.9 * first_Hz));
  }
}

TEST_CASE("contact stick effects: creep, with its speed and how sharply it grows" * doctest::test_suite("long")) {
  constexpr double limit_m_s = 0.02, sharp = 0.3;
  const rosin::two_exponential_curve<double> curve{};
  const rosin::creep<rosin::two_exponential_curve<double>> law{curve, {limit_m_s, sharp}};
  auto [slow, fast, takes, bench] = over(law, 11, 13);
  REQUIRE(bench.usable());
  bench.use_damping(rosin::torsion_damping::viscous_modes);
  const auto creep = rosin::creep_hypothesis(bench, takes);
  CHECK(creep.gain > 1000);
  CHECK(creep.held_out_gain > 1000);
  CHECK(value(creep, "sharpness") == test::approx(sharp).epsilon(0.1));
  CHECK(value(creep, "speed_at_normal_force_m_s") ==
        test::approx(limit_m_s * std::exp((1 - curve(0).value) / sharp)).epsilon(0.2));
  for (const auto& other : {rosin::torsion_hypothesis(bench), rosin::rod_hypothesis(bench), rosin::bristle_hypothesis(bench)})
    CHECK(other.gain < 0.5 * creep.gain);
}

TEST_CASE("contact stick effects: a contact as declared gains by nothing" * doctest::test_suite("long")) {
  auto [slow, fast, takes, bench] = over(contact_rigs::curve(), 31, 33);
  REQUIRE(bench.usable());
  for (const auto& h : {rosin::torsion_hypothesis(bench), rosin::rod_hypothesis(bench), rosin::bristle_hypothesis(bench),
                        rosin::creep_hypothesis(bench, takes)}) {
    CHECK((!h.decided || h.gain < 40));
    CHECK_FALSE(h.peculiar);
  }
}

TEST_CASE("contact stick effects: one harmonic of the string that is off is no rod" * doctest::test_suite("long")) {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 31),
             b = contact_rigs::play(contact_rigs::curve(), contact_rigs::fast(), contact_rigs::rolls, 33);
  const struct { double off_m_s, most_q; } faults[] = {{1e-3, 100}, {1e-2, 200}};
  for (const auto& [off_m_s, most_q] : faults) {
    auto slow = a, fast = b;
    for (auto* stroke : {&slow, &fast})
      for (std::size_t i = 0; i < stroke->velocity.size(); ++i) {
        const double off = off_m_s * std::sin(8 * std::numbers::pi * 659 * static_cast<double>(i) / contact_rigs::rate + 3);
        for (auto* v : {&stroke->velocity, &stroke->velocity_near, &stroke->velocity_far}) (*v)[i] += off;
      }
    two_strokes strokes{slow, fast};
    // with the string's own loss at the contact in the equation, and without it
    CHECK_FALSE(rod_of(strokes.bench).decided);
    for (auto& take : strokes.takes) take.loss = {};
    strokes.bench = rosin::stick_bench(strokes.takes, contact_rigs::declared());
    const auto rod = rod_of(strokes.bench);
    CHECK(rod.gain > 40);
    CHECK(value(rod, "q") < most_q);
    CHECK_FALSE(rod.decided);
  }
}
