// tier: freestanding
// SPDX-License-Identifier: MIT
//
// What a simulator and a law of friction say to each other. In each time step the simulator, whatever its method,
// knows the string's surface speed at the contact up to the force that is still to be found (the load line)
//
//     v_surface = v_free + y f,      y = 1 / (2 Z_total) > 0,      f = force of the rod on the string,
//
// and the law answers with the force that satisfies both. With v_r = v_surface - v_rod, a force that resists the
// slip has f v_r <= 0. Whatever the law remembers (sticking or slipping, temperature, bristles) is its own state.
//
#pragma once

#include <concepts>

namespace rosin {

/// One step's contact as seen from the string.
template <class T>
struct load_line {
  T free_velocity_m_s{};  ///< of the string's surface if no force acted in this step
  T mobility_m_Ns{};      ///< y > 0
  T rod_velocity_m_s{};   ///< > 0 for a stroke in the positive direction
  T normal_force_N{};     ///< <= 0: the rod is off the string
  T step_s{};             ///< length of the step

  /// Surface speed less rod speed under a force.
  [[nodiscard]] constexpr T slip(T force_N) const noexcept {
    return free_velocity_m_s + mobility_m_Ns * force_N - rod_velocity_m_s;
  }
  /// The force under which the surface moves with the rod.
  [[nodiscard]] constexpr T sticking_force() const noexcept { return (rod_velocity_m_s - free_velocity_m_s) / mobility_m_Ns; }
};

/// The law's answer.
template <class T>
struct contact_force {
  T force_N{};
  T temperature_rise_K{};  ///< of the contact above its surroundings; 0 for laws that know of none
  bool slipping = false;
  bool converged = true;  ///< false: the contact equation was not solved to tolerance
};

/// A law of friction: one call a step, its own memory, no allocation, no exceptions. reset() is as good as new;
/// a law that resists motion returns f with f v_r <= 0.
template <class L>
concept FrictionLaw = std::copyable<L> && requires(L law, const load_line<typename L::scalar>& line) {
  typename L::scalar;
  { law(line) }
  noexcept->std::same_as<contact_force<typename L::scalar>>;
  { law.reset() }
  noexcept;
};

}  // namespace rosin
