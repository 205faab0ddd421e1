// SPDX-License-Identifier: MIT
#include <rosin/simulate/modal_contact.hpp>

#include <doctest/doctest.h>

#include "support/approx.hpp"

namespace simulate_modal_contact {

namespace {

rosin::modal_rig soft_rig(double quality) {
  return {.string = {.length_m = 0.314,
                     .tension_N = 72.5,
                     .fundamental_Hz = 660,
                     .bending_stiffness_Nm2 = 4.7e-5,
                     .loss = {.quality = quality}},
          .torsion = {7, 3.5, 15}};
}

constexpr double step = 1 / (4 * 128e3);

}  // namespace

TEST_CASE("a lasting force is shared by the ends as a lever shares it, whatever the number of modes") {
  for (const double limit : {70e3, 200e3}) {
    rosin::modal_contact contact{soft_rig(2), 0.3, limit, step};
    rosin::modal_contact_state state;
    for (int i = 0; i < 6000; ++i) state = contact.apply(0.5);
    CHECK(state.near_N + contact.left_out().near * 0.5 == test::approx(0.5 * 0.7));
    CHECK(state.far_N + contact.left_out().far * 0.5 == test::approx(0.5 * 0.3));
    CHECK(std::abs(state.centre_m_s + state.torsion_m_s) < 1e-5);
  }
}

TEST_CASE("the load line foretells the surface's speed") {
  rosin::modal_contact contact{soft_rig(1000), 0.3, 200e3, step};
  double last = 0;
  for (int i = 0; i < 500; ++i) {
    const rosin::rod_state rod{0.2, 0.3};
    const auto line = contact.line(rod);
    const double force = 0.3 * std::sin(0.05 * i), predicted = line.slip(force) + rod.velocity_m_s;
    const auto state = contact.apply(force);
    const double rest = (contact.left_out().centre_m_N + contact.left_out().torsion_m_N) * (force - last) / step;
    CHECK(state.centre_m_s + state.torsion_m_s + rest == test::approx(predicted).scale(0.1).epsilon(1e-9));
    last = force;
  }
}

TEST_CASE("a string that does not turn has no torsional speed, and yields less") {
  auto rig = soft_rig(1000);
  const rosin::modal_contact turning{rig, 0.3, 200e3, step};
  rig.torsion = {};
  rosin::modal_contact stiff{rig, 0.3, 200e3, step};
  CHECK(stiff.mobility_m_Ns() < turning.mobility_m_Ns());
  CHECK(stiff.left_out().torsion_m_N == 0.0);
  for (int i = 0; i < 10; ++i) CHECK(stiff.apply(1.0).torsion_m_s == 0.0);
}

TEST_CASE("on an ideal string the first steps see half the reciprocal impedance, transverse and torsional") {
  auto rig = soft_rig(1e6);
  rig.string.bending_stiffness_Nm2 = 0;
  rosin::modal_contact contact{rig, 0.3, 0.49 / step, step};
  double velocity = 0;
  for (int i = 0; i < 30; ++i) {  // before the first reflection, torsion's, returns after 65 us
    const auto state = contact.apply(1.0);
    if (i >= 10) velocity += (state.centre_m_s + state.torsion_m_s) / 20;
  }
  const double Z = rig.string.impedance_Ns_m();
  CHECK(velocity == test::approx((1 + 1 / 3.5) / (2 * Z)).epsilon(0.02));
}

TEST_CASE("a positive force turns and moves the surface forwards") {
  rosin::modal_contact contact{soft_rig(1000), 0.3, 200e3, step};
  rosin::modal_contact_state state;
  for (int i = 0; i < 20; ++i) state = contact.apply(1.0);
  CHECK(state.centre_m_s > 1);
  CHECK(state.torsion_m_s > 0.3);
}

TEST_CASE(
    "a steady force that runs along an ideal string: the closed form of its velocity and of the forces on the ends, Doppler's") {
  auto rig = soft_rig(1e6);
  rig.string.bending_stiffness_Nm2 = 0;
  rig.torsion = {};
  const double mach = 0.3, force = 0.5, c = rig.string.wave_speed_m_s(), length = rig.string.length_m, from = 0.35;
  rosin::modal_contact contact{rig, from, 0.49 / step, step};
  double velocity = 0, near = 0, far = 0;
  int counted = 0, near_counted = 0, far_counted = 0;
  for (int n = 0; n * step < 1.1 * length * (1 - from) / c; ++n) {
    const double x = from + mach * c * n * step / length, into = n * step * c / length;
    contact.move_to(x);
    const auto line = contact.line({});
    const double now = line.slip(force);
    const auto state = contact.apply(force);
    if (into > 0.1 && into < 0.6) velocity += now, ++counted;
    if (into > 1.08 * from) near += state.near_N + contact.left_out().near * force, ++near_counted;
    if (into > 1.03 * (1 - from)) far += state.far_N + contact.left_out().far * force, ++far_counted;
  }
  CHECK(velocity / counted == test::approx(force / (2 * rig.string.impedance_Ns_m()) / (1 - mach * mach)).epsilon(1e-3));
  CHECK(near / near_counted == test::approx(force / (1 + mach)).epsilon(5e-3));
  CHECK(far / far_counted == test::approx(force / (1 - mach)).epsilon(5e-3));
}

TEST_CASE("a contact that is told to stay where it is does what it would have done") {
  rosin::modal_contact told{soft_rig(1000), 0.3, 200e3, step}, left_alone{soft_rig(1000), 0.3, 200e3, step};
  for (int i = 0; i < 300; ++i) {
    told.move_to(0.3);
    const double force = 0.3 * std::sin(0.05 * i);
    CHECK(told.line({}).slip(force) == test::approx(left_alone.line({}).slip(force)).scale(0.1).epsilon(1e-9));
    told.apply(force), left_alone.apply(force);
  }
}

}  // namespace simulate_modal_contact
