// SPDX-License-Identifier: MIT
#include <rosin/simulate/random_rig.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_random_rig {

namespace {

bool within(double x, double low, double high) { return x >= low && x <= high; }

/// Seconds of computing are for the proofs: short takes, few steps.
rosin::rig_recordings quickly(rosin::random_rig rig) {
  rig.stroke_s = 0.03;
  for (auto& p : rig.plucks) p.duration_s = 0.008;
  return *rosin::record(rig, {.oversampling = 2, .mode_limit_Hz = 100e3});
}

}  // namespace

TEST_CASE("every rig lies in the ranges, differs from the others and from its notebook") {
  int thermal = 0;
  double last = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto r = rosin::draw_rig(seed);
    const auto& s = r.rig.string;
    CAPTURE(seed);
    CHECK(within(s.length_m, 0.30, 0.335));
    CHECK(within(s.tension_N, 60, 80));
    CHECK(within(s.fundamental_Hz, 590, 700));
    CHECK(within(s.bending_stiffness_Nm2, 3.5e-5, 6.5e-5));
    CHECK(within(s.loss.quality, 800, 1500));
    CHECK(within(r.position, 0.1, 0.4));
    CHECK(within(r.rig.torsion.speed_ratio, 6.4, 7.9));
    CHECK(within(r.rig.torsion.impedance_ratio, 2.9, 4.1));
    CHECK(within(r.rig.torsion.quality, 12, 20));
    CHECK(within(r.noise_N, 0.3e-3, 0.5e-3));
    for (const auto& stroke : r.strokes) CHECK((within(stroke.speed_m_s, 0.1, 0.3) && within(stroke.normal_force_N, 0.25, 0.5)));
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(within(r.plucks[i].force_N / r.declared.pluck_N[i], 0.97, 1.03));
      CHECK(within(r.plucks[i].release_s, 0.0039, 0.0043));
      CHECK(r.plucks[i].position == r.position);
    }
    CHECK(within(r.declared.string.tension_N / s.tension_N, 0.98, 1.02));
    CHECK(within(r.declared.string.fundamental_Hz / s.fundamental_Hz, 0.998, 1.002));
    CHECK(within(r.declared.position - r.position, -0.004, 0.004));
    CHECK(r.declared.position != r.position);
    CHECK(within(r.gain[0], 0.96, 1.04));
    CHECK(r.gain[0] != r.gain[1]);
    CHECK(s.length_m != last);
    CHECK(rosin::draw_rig(seed).gain == r.gain);
    last = s.length_m;
    thermal += r.thermal() ? 1 : 0;
  }
  CHECK(within(thermal, 8, 32));
}

TEST_CASE("takes are recorded through gain, noise and converter, one range for all") {
  const auto rig = rosin::draw_rig(4);
  const auto recordings = quickly(rig);
  REQUIRE(recordings.takes.size() == 5);
  CHECK(recordings.takes[0].name == "pluck-1");
  CHECK(recordings.takes[4].name == "bow-2");
  double loudest = 0;
  for (const auto& take : recordings.takes) {
    CHECK(take.bowed == (take.name[0] == 'b'));
    for (std::size_t c = 0; c < 2; ++c) {
      const auto& force = c == 0 ? take.truth.force_near_N : take.truth.force_far_N;
      const auto newtons = take.channels[c].newtons();
      REQUIRE(newtons.size() == force.size());
      double square = 0;
      for (std::size_t n = 0; n < force.size(); ++n) {
        square += std::pow(newtons[n] - rig.gain[c] * force[n], 2);
        if (c == 0) loudest = std::max(loudest, std::abs(newtons[n]));
      }
      CHECK(take.channels[c].clipped == 0);
      CHECK(std::sqrt(square / static_cast<double>(force.size())) == test::approx(rig.noise_N).epsilon(0.1));
      CHECK(take.channels[c].newtons_per_full_scale == recordings.takes[0].channels[c].newtons_per_full_scale);
    }
  }
  CHECK(loudest / recordings.takes[0].channels[0].newtons_per_full_scale == test::approx(rig.peak_share).epsilon(0.01));
  CHECK(recordings.takes[0].truth.force_near_N[0] == test::approx(rig.plucks[0].force_N * (1 - rig.position)));
}

TEST_CASE("noise differs from take to take and from end to end") {
  auto rig = rosin::draw_rig(5);
  rig.strokes[0].speed_m_s = rig.strokes[1].speed_m_s = 0;
  const auto recordings = quickly(rig);
  const auto &a = recordings.takes[3].channels, &b = recordings.takes[4].channels;
  CHECK(a[0].codes != b[0].codes);
  CHECK(a[0].codes != a[1].codes);
}

TEST_CASE("a stroke without slip is not usable, and says so") {
  auto rig = rosin::draw_rig(6);
  rig.strokes[0] = {.speed_m_s = 0.0005, .normal_force_N = 3};
  const auto recordings = quickly(rig);
  CHECK(!recordings.takes[3].usable());
  CHECK(recordings.takes[0].usable());
}

TEST_CASE("a rig that cannot be simulated is refused with the reason") {
  auto rig = rosin::draw_rig(7);
  rig.position = 1.5;
  const auto recordings = rosin::record(rig, {.oversampling = 2, .mode_limit_Hz = 100e3});
  REQUIRE(!recordings);
  CHECK(recordings.error().find("position") != std::string::npos);
}

}  // namespace simulate_random_rig
