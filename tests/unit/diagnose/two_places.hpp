// SPDX-License-Identifier: MIT
//
// A string that is driven at two places, for the tests of a contact of some width.
//
#pragma once

#include <rosin/simulate/modal_bank.hpp>

#include <random>

#include "contact_rigs.hpp"

namespace contact_rigs {

/// A string held at two places by forces of their own: forces on its ends, how both places move, and what both forces come to.
struct two_places {
  std::vector<double> near, far, v_near, v_far, force;
};

inline two_places drive(double position, double width_m) {
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
      out.force.push_back(force[0] + force[1]);
      out.near.push_back(free.near + bank.near_gain(0) * force[0] + bank.near_gain(1) * force[1]);
      out.far.push_back(free.far + bank.far_gain(0) * force[0] + bank.far_gain(1) * force[1]);
      out.v_near.push_back(free.velocity[0] + bank.mobility(0, 0) * force[0] + bank.mobility(0, 1) * force[1]);
      out.v_far.push_back(free.velocity[1] + bank.mobility(1, 0) * force[0] + bank.mobility(1, 1) * force[1]);
    }
    bank.advance(force);
  }
  return out;
}

/// The take that a contact of this width, declared to be a point, would be.
inline rosin::contact_take take_of(const two_places& truth, double position) {
  const auto at = rosin::contact_at(e_string, position);
  rosin::contact_take take;
  take.near_N = truth.near, take.far_N = truth.far, take.force_N = truth.near, take.velocity_m_s = truth.v_near;
  take.rate_Hz = rate, take.rod_speed_m_s = 1e-9, take.delay_s = at.delay_s, take.impedance_Ns_m = at.impedance_Ns_m, take.stiffness_s2 = at.stiffness_s2, take.inverse_q = 1e-3;
  return take;
}

inline std::vector<double> within_30_kHz(const std::vector<double>& x) {
  return rosin::contact_signal<>(x, rate).through(rosin::smooth_window{30e3}, [](double) { return 1.0; });
}

/// How far a signal is off the truth in the middle, relative.
inline double off(const std::vector<double>& found, const std::vector<double>& truth) {
  double error = 0, all = 0;
  for (std::size_t i = 1500; i < 6500; ++i) error += std::pow(found[i] - truth[i], 2), all += truth[i] * truth[i];
  return std::sqrt(error / all);
}

}  // namespace contact_rigs
