// SPDX-License-Identifier: MIT
#include <rosin/diagnose/contact_width.hpp>

#include <doctest/doctest.h>

#include <random>

#include <rosin/simulate/modal_bank.hpp>

#include "contact_rigs.hpp"

namespace {

using contact_rigs::e_string;
using contact_rigs::rate;

/// A string held at two places by forces of their own: forces on its ends, and how both places move.
struct two_places {
  std::vector<double> near, far, v_near, v_far;
};

two_places drive(double position, double width_m) {
  constexpr int finer = 4;
  const double half = 0.5 * width_m / e_string.length_m;
  rosin::modal_bank<2> bank(rosin::transverse_modes(e_string, 200e3), rosin::damping_convention::viscous, {position - half, position + half}, 1 / (finer * rate));
  std::mt19937 source(5);
  std::normal_distribution<double> normal;
  two_places out;
  std::array<double, 4> slow{};
  for (int i = 0; i < 8000 * finer; ++i) {
    const double fade = i < 800 * finer ? 0 : i < 7000 * finer ? 1 : 0;
    for (int k = 0; k < 2; ++k) {  // two first-order low-passes: hardly anything above 10 kHz
      const auto a = static_cast<std::size_t>(2 * k);
      slow[a] += 0.02 * (fade * normal(source) - slow[a]);
      slow[a + 1] += 0.02 * (slow[a] - slow[a + 1]);
    }
    const std::array<double, 2> force{slow[1], slow[3]};
    const auto free = bank.free();
    if (i % finer == 0) {
      out.near.push_back(free.near + bank.near_gain(0) * force[0] + bank.near_gain(1) * force[1]);
      out.far.push_back(free.far + bank.far_gain(0) * force[0] + bank.far_gain(1) * force[1]);
      out.v_near.push_back(free.velocity[0] + bank.mobility(0, 0) * force[0] + bank.mobility(0, 1) * force[1]);
      out.v_far.push_back(free.velocity[1] + bank.mobility(1, 0) * force[0] + bank.mobility(1, 1) * force[1]);
    }
    bank.advance(force);
  }
  return out;
}

double error(const std::vector<double>& a, std::vector<double> b) {
  rosin::contact_signal<> signal(b, rate);
  b = signal.through(rosin::smooth_window{30e3}, [](double) { return 1.0; });
  double off = 0, all = 0;
  for (std::size_t i = 1500; i < 6500; ++i) off += std::pow(a[i] - b[i], 2), all += b[i] * b[i];
  return std::sqrt(off / all);
}

}  // namespace

TEST_CASE("contact width: both places of a wide contact follow from the ends' forces") {
  const double width = 0.005, position = 0.27;
  const auto truth = drive(position, width);
  const auto at = rosin::contact_at(e_string, position);
  rosin::contact_take take;
  take.near_N = truth.near, take.far_N = truth.far, take.force_N = truth.near, take.velocity_m_s = truth.v_near;
  take.rate_Hz = rate, take.rod_speed_m_s = 1e-9, take.delay_s = at.delay_s, take.impedance_Ns_m = at.impedance_Ns_m, take.stiffness_s2 = at.stiffness_s2, take.inverse_q = 1e-3;
  const rosin::stick_record record(rosin::stick_bench::stick_takes({take}).front());
  rosin::wide_record wide(take, record);
  const rosin::torsion_values rigid{7, 1e9, 15};
  const double d = 0.5 * width / e_string.wave_speed_m_s();
  const auto right = wide.at(d, {30e3}, rigid), point = wide.at(0, {30e3}, rigid);
  CHECK(error(right.near_m_s, truth.v_near) < 0.05);
  CHECK(error(right.far_m_s, truth.v_far) < 0.05);
  CHECK(error(point.near_m_s, truth.v_near) > 2 * error(right.near_m_s, truth.v_near));
}

TEST_CASE("contact width: a contact at one point is not called wide") {
  const auto a = contact_rigs::play(contact_rigs::curve(), contact_rigs::slow(), contact_rigs::rolls, 81);
  rosin::stick_bench bench({a.take()}, contact_rigs::declared());
  const auto h = rosin::width_hypothesis(bench, {a.take()});
  CHECK((!h || !h->decided));
}
