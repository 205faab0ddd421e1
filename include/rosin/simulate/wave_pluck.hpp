// tier: hosted
// SPDX-License-Identifier: MIT
//
// A pluck by a breaking wire on the travelling-wave string. All is linear, so what rings is the answer of a string at rest to the
// force that is taken away, -F0 S(t), beside what the ends bear while the wire holds: with tau = T / L and the compliances C of
// ends that move
//
//     F_near = F0 ((1 - x) + tau C_far) / (1 + tau (C_near + C_far)),      F_far = F0 - F_near.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/simulate/modal_pluck.hpp>
#include <rosin/simulate/wave_stroke.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The force that the wire takes away, as a law that asks the string nothing. A release at once runs over the step around it, so
/// that its time is exact.
template <class T = double>
struct breaking_wire {
  using scalar = T;
  double force_N = 1, release_s = 0.004, release_duration_s = 0;
  std::size_t step = 0;

  contact_force<T> operator()(const load_line<T>& line) noexcept {
    constexpr double pi = 3.14159265358979323846;
    const double h = static_cast<double>(line.step_s), into = static_cast<double>(step++) * h - release_s;
    const bool at_once = !(release_duration_s > h);
    const double share = std::clamp(at_once ? into / h + 0.5 : into / release_duration_s, 0.0, 1.0);
    return {.force_N = static_cast<T>(-force_N * (at_once ? share : (1 - std::cos(pi * share)) / 2))};
  }
  void reset() noexcept { step = 0; }
};

namespace detail {

/// Deflection of an end for 1 N on it.
[[nodiscard]] inline double compliance_m_N(const modal_termination& end, double impedance_Ns_m) noexcept {
  double sum = 0;
  for (const auto& m : end.modes) sum += m.per_mass_per_s / impedance_Ns_m / std::pow(2 * std::numbers::pi * m.frequency_Hz, 2);
  return sum;
}

}  // namespace detail

/// Simulates a pluck by waves, without torsion: the wire does not roll the string. The take has the form of simulate_pluck()'s.
/// Fails where rig, pluck, settings or ends make no sense.
template <class T = double>
[[nodiscard]] outcome<modal_take> simulate_wave_pluck(const modal_rig& rig, const modal_pluck& pluck,
                                                      const wave_settings& settings = {},
                                                      const std::array<modal_termination, 2>& ends = {}) {
  if (!(pluck.release_s > 0 && pluck.release_duration_s >= 0 && std::isfinite(pluck.force_N)))
    return failure{"pluck: it is released after the take has begun, by a finite force, in no negative time"};
  auto still = rig;
  still.torsion = {};
  auto take = simulate_wave_stroke<T>(still, breaking_wire<T>{pluck.force_N, pluck.release_s, pluck.release_duration_s},
                                      steady_rod{0, 0}, {pluck.position, pluck.duration_s}, settings, ends);
  if (!take) return take;
  const double z = rig.string.impedance_Ns_m(), tilt = rig.string.tension_N / rig.string.length_m;
  const double near = tilt * detail::compliance_m_N(ends[0], z), far = tilt * detail::compliance_m_N(ends[1], z);
  const double share = ((1 - pluck.position) + far) / (1 + near + far);
  for (double& f : take->contact_force_N) f += pluck.force_N;
  for (double& f : take->force_near_N) f += share * pluck.force_N;
  for (double& f : take->force_far_N) f += (1 - share) * pluck.force_N;
  return take;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
