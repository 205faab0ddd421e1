// SPDX-License-Identifier: MIT
#include <rosin/simulate/burdened_signals.hpp>

#include <rosin/friction/friction_curves.hpp>
#include <rosin/friction/velocity_curve.hpp>

#include "support/apart.hpp"
#include "support/approx.hpp"
#include "support/moving_end_rig.hpp"

#include <doctest/doctest.h>

namespace simulate_burdened_signals {

namespace {

const rosin::string_parameters string{
    .length_m = 0.32, .tension_N = 70, .fundamental_Hz = 640, .bending_stiffness_Nm2 = 4e-5, .loss = {.quality = 1000}};
const rosin::modal_rig rig{string, {}};
constexpr double limit_Hz = 60e3;
const rosin::modal_settings settings{.sample_rate_Hz = 96e3, .oversampling = 8, .mode_limit_Hz = limit_Hz};
const test::moving_settings same{.rate_Hz = 96e3, .mode_limit_Hz = limit_Hz, .oversampling = 8};

/// A bridge of three modes at the near end, a stiff nut of one at the far end.
const std::array<std::vector<test::end_mode>, 2> ends{
    {{{460, 30, 0.1}, {2400, 12, 0.004}, {5100, 8, 0.003}}, {{7000, 20, 0.01}}}};

rosin::rig_burden on_these() {
  rosin::rig_burden out;
  for (std::size_t e = 0; e < 2; ++e)
    for (const auto& m : ends[e]) out.string.ends[e].modes.push_back({m.frequency_Hz, m.q, string.impedance_Ns_m() / m.mass_kg});
  return out;
}

}  // namespace

TEST_CASE("without a burden plucks and strokes are those of the ideal rig") {
  REQUIRE(rosin::rig_burden{}.none());
  REQUIRE(!on_these().none());
  const rosin::modal_pluck pluck{.release_s = 0.0040037, .duration_s = 0.02};
  const auto one = rosin::simulate_pluck(rig, rosin::rig_burden{}, pluck, settings),
             other = rosin::simulate_pluck(rig, pluck, settings);
  REQUIRE((one && other));
  CHECK(one->size() == other->size());
  CHECK(test::apart(one->force_near_N, other->force_near_N) < 1e-3);
  CHECK(test::apart(one->force_far_N, other->force_far_N) < 1e-3);
  CHECK(test::apart(one->centre_velocity_m_s, other->centre_velocity_m_s) < 1e-2);
  const rosin::velocity_curve<rosin::two_exponential_curve<double>> law{};
  const rosin::modal_rig turning{string, {7, 3.5, 15}};
  const auto bowed =
      rosin::simulate_stroke(turning, rosin::rig_burden{}, law, rosin::steady_rod{}, {.duration_s = 0.02}, settings);
  const auto peer = rosin::simulate_stroke(turning, law, rosin::steady_rod{}, {.duration_s = 0.02}, settings);
  REQUIRE((bowed && peer));
  CHECK(bowed->size() == peer->size());
  CHECK(test::apart(bowed->contact_force_N, peer->contact_force_N) < 1e-6);
  CHECK(test::apart(bowed->centre_velocity_m_s, peer->centre_velocity_m_s) < 1e-6);
  CHECK(test::apart(bowed->torsion_velocity_m_s, peer->torsion_velocity_m_s) < 1e-6);
  CHECK(test::apart(bowed->force_near_N, peer->force_near_N) < 1e-4);
}

TEST_CASE("plucks of a string on a bridge and a nut that move are those of component modes") {
  const test::moving_end_rig peer{string, ends};
  const double half_step = 0.5 / (same.rate_Hz * same.oversampling);  // where the other's slope of one step has its middle
  const auto one = rosin::simulate_pluck(
      rig, on_these(), {.position = 0.3, .force_N = 1, .release_s = 0.004 + half_step, .duration_s = 0.03}, settings);
  REQUIRE(one);
  const auto other = test::pluck_moving_ends(peer, 0.3, 1, 0.004 + half_step, 0.03, same);
  CHECK(test::apart(one->force_near_N, other.near_N) < 2e-3);
  CHECK(test::apart(one->force_far_N, other.far_N) < 2e-3);
  CHECK(test::apart(one->centre_velocity_m_s, other.velocity_m_s) < 1e-3);
}

TEST_CASE("a bowed string on a body runs free as component modes say") {
  const test::moving_end_rig peer{string, ends};
  const rosin::velocity_curve<rosin::two_exponential_curve<double>> law{};
  const rosin::steady_rod rod{.speed_m_s = 0.2, .normal_force_N = 0.3};
  const auto one = rosin::simulate_stroke(rig, on_these(), law, rod, {.position = 0.3, .duration_s = 0.03}, settings);
  REQUIRE(one);
  const auto other = test::bow_moving_ends(peer, 0.3, law, rod, 0.03, same);
  CHECK(one->slips > 20);
  CHECK(test::apart(one->contact_force_N, other.force_N) < 1e-3);
  CHECK(test::apart(one->centre_velocity_m_s, other.velocity_m_s) < 1e-3);
  CHECK(test::apart(one->force_near_N, other.near_N) < 3e-3);
  CHECK(test::apart(one->force_far_N, other.far_N) < 3e-3);
  const auto rigid = rosin::simulate_stroke(rig, law, rod, {.position = 0.3, .duration_s = 0.03}, settings);
  REQUIRE(rigid);
  CHECK(test::apart(rigid->contact_force_N, other.force_N) > 0.3);
}

TEST_CASE("a second plane takes its share of a pluck and none of what the wire holds") {
  rosin::rig_burden two;
  two.detuning = 4e-3, two.coupling = 0.1;
  const rosin::modal_pluck pluck{.release_s = 0.004, .duration_s = 0.02};
  const auto both = rosin::simulate_pluck(rig, two, pluck, settings),
             one = rosin::simulate_pluck(rig, rosin::rig_burden{}, pluck, settings);
  auto sharper = rig;
  sharper.string.fundamental_Hz *= 1.004, sharper.string.tension_N *= 1.004 * 1.004;
  const auto other = rosin::simulate_pluck(sharper, rosin::rig_burden{}, pluck, settings);
  REQUIRE((both && one && other));
  CHECK(both->force_near_N[0] == test::approx(0.7).epsilon(1e-3));
  std::vector<double> sum;
  for (std::size_t n = 0; n < one->size(); ++n) sum.push_back((one->force_near_N[n] + 0.1 * other->force_near_N[n]) / 1.1);
  CHECK(test::apart(both->force_near_N, sum) < 1e-9);
}

TEST_CASE("planes of one pitch stretch a string as one plane does, since they have one tension") {
  rosin::rig_burden one, two;
  one.string.axial_stiffness_N = two.string.axial_stiffness_N = 2e4;
  const rosin::modal_pluck pluck{.force_N = 1.5, .release_s = 0.004, .duration_s = 0.02};
  const auto single = rosin::simulate_pluck(rig, one, pluck, settings),
             slack = rosin::simulate_pluck(rig, rosin::rig_burden{}, pluck, settings);
  REQUIRE((single && slack));
  const double stretched = test::apart(single->force_near_N, slack->force_near_N);
  CHECK(stretched > 0.01);
  for (const double coupling : {0.4, -0.2}) {
    two.coupling = coupling;
    const auto both = rosin::simulate_pluck(rig, two, pluck, settings);
    REQUIRE(both);
    // the planes were stepped one after the other
    CHECK(test::apart(both->force_near_N, single->force_near_N) < 0.01 * stretched);
    CHECK(test::apart(both->centre_velocity_m_s, single->centre_velocity_m_s) <
          0.01 * test::apart(single->centre_velocity_m_s, slack->centre_velocity_m_s));
  }
}

TEST_CASE("what a sensor feels of the strain is the same from two planes of one pitch as from one") {
  rosin::rig_burden one;
  one.string.sensed_stiffness_N = {4e3, 0};
  rosin::rig_burden two = one;
  two.coupling = 0.4;
  const rosin::modal_pluck pluck{.release_s = 0.004, .duration_s = 0.02};
  const auto single = rosin::simulate_pluck(rig, one, pluck, settings), both = rosin::simulate_pluck(rig, two, pluck, settings),
             deaf = rosin::simulate_pluck(rig, rosin::rig_burden{}, pluck, settings);
  REQUIRE((single && both && deaf));
  CHECK(test::apart(single->force_near_N, deaf->force_near_N) > 1e-3);
  CHECK(test::apart(both->force_near_N, single->force_near_N) < 1e-9);
}

TEST_CASE("what cannot be is refused") {
  const auto says = [](const rosin::rig_burden& burden, const char* what) {
    const auto take = rosin::simulate_pluck(rig, burden, {}, settings);
    REQUIRE(!take);
    CHECK(take.error().find(what) != std::string::npos);
  };
  rosin::rig_burden b;
  b.string.loads = {{.position = 1, .mass_kg = 1e-6}};
  says(b, "load");
  b = {}, b.coupling = -1;
  says(b, "second plane");
  b = {}, b.string.ends[0].modes = {{500, 0, 10}};
  says(b, "termination");
  b = {}, b.string.ends[1].modes = {{500, 10, -1}};
  says(b, "termination");
  b = {}, b.string.supports[1] = {0.001, 0, 10};
  says(b, "support");
  b = {}, b.string.clamping[0] = 1.5;
  says(b, "clamped end: the clamping");
  b = {}, b.string.clamping[0] = 1, b.string.axial_stiffness_N = 1e4;
  says(b, "not together");
  b = {}, b.contact_width_m = 0.5;
  says(b, "wider");
  b = {}, b.pluck_width_m = 0.5;
  says(b, "wire: wider");
  b = {}, b.sensors.clock_drift = 0.02;
  says(b, "clock");
}

}  // namespace simulate_burdened_signals
