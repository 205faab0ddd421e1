// SPDX-License-Identifier: MIT
//
// A string that is driven at two places, for the tests of a contact of some width.
//
#pragma once

#include <rosin/simulate/burdened_string.hpp>
#include <rosin/simulate/modal_bank.hpp>

#include <random>
#include <tuple>

#include "contact_rigs.hpp"

namespace contact_rigs {

/// A string held at two places by forces of their own: forces on its ends, how both places move, and what both forces come to.
struct two_places {
  std::vector<double> near, far, v_near, v_far, force;
};

/// Two forces that hardly have anything above 10 kHz, step by step.
class smooth_forces {
public:
  std::array<double, 2> operator()(double fade) {
    for (std::size_t a = 0; a < 4; a += 2) {  // two first-order low-passes
      slow_[a] += 0.02 * (fade * normal_(source_) - slow_[a]);
      slow_[a + 1] += 0.02 * (slow_[a] - slow_[a + 1]);
    }
    return {slow_[1], slow_[3]};
  }

private:
  std::mt19937 source_{5};
  std::normal_distribution<double> normal_;
  std::array<double, 4> slow_{};
};

constexpr int finer = 4, driven_samples = 8000;
inline double fade_at(int step) { return step >= 800 * finer && step < 7000 * finer ? 1 : 0; }

inline two_places drive(double position, double width_m) {
  const double half = 0.5 * width_m / e_string.length_m;
  rosin::modal_bank<2> bank(rosin::transverse_modes(e_string, 200e3), rosin::damping_convention::viscous,
                            {position - half, position + half}, 1 / (finer * rate));
  smooth_forces forces;
  two_places out;
  for (int i = 0; i < driven_samples * finer; ++i) {
    const auto force = forces(fade_at(i));
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

/// The same of a string that carries something or ends on something that moves.
inline two_places drive(double position, double width_m, const rosin::string_burden& burden) {
  const double half = 0.5 * width_m / e_string.length_m;
  rosin::burdened_string string({.string = e_string}, burden, {position - half, position + half}, 200e3, 1 / (finer * rate));
  smooth_forces forces;
  two_places out;
  for (int i = 0; i < driven_samples * finer; ++i) {
    const auto force = forces(fade_at(i));
    std::ignore = string.free_velocity();  // begins the step
    const auto now = string.advance(Eigen::Vector2d{force[0], force[1]});
    if (i % finer != 0) continue;
    out.force.push_back(force[0] + force[1]);
    out.near.push_back(now.end_N[0]), out.far.push_back(now.end_N[1]);
    out.v_near.push_back(now.surface_m_s[0]), out.v_far.push_back(now.surface_m_s[1]);
  }
  return out;
}

/// The take that a contact of this width, declared to be a point, would be.
inline rosin::contact_take take_of(const two_places& truth, double position) {
  const auto at = rosin::contact_at(e_string, position);
  rosin::contact_take take;
  take.near_N = truth.near, take.far_N = truth.far, take.force_N = truth.near, take.velocity_m_s = truth.v_near;
  take.rate_Hz = rate, take.rod_speed_m_s = 1e-9, take.delay_s = at.delay_s, take.impedance_Ns_m = at.impedance_Ns_m,
  take.stiffness_s2 = at.stiffness_s2, take.loss = at.loss;
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
