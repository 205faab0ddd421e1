// tier: hosted
// SPDX-License-Identifier: MIT
//
// Force and velocity under the bow of a string that carries loads and ends on supports that yield, once plucks have told what
// these are. All follows from the force on an end and the motion of that end, outwards to the bow, without solving for anything
// with V = Z Y F the end's motion, the j-th load on the way feels and returns
//
//     Z v(x_j) = F sinh(gamma x_j) + V cosh(gamma x_j) - sum_(i<j) g_i sinh(gamma (x_j - x_i)) + N g_j,    g_j = -(Z_s / Z) Z v(x_j),
//
// N = -i (k / kappa) / (2 G Z_w / Z) being its own near field,
//
// with d = x_b - x_j every load between end and bow changes what a plain string would say of the bow by
//
//     this side's force:  -g e^(gamma d),    the other side's:  -g e^(-gamma d),    this side's velocity:  -g sinh(gamma d) / (G Z_w).
//
// An end that resists turning is such an echo, too: with a and h of string_side.hpp it changes these by
//
//     G F (h e^(-i a) - 1) e^(gamma x_b),    G F (h e^(i a) - 1) e^(-gamma x_b),    F (h sinh(gamma x_b - i a) - sinh(gamma x_b)) / Z_w.
//
// Whole records, in the frequency domain. Stiffness enters as in bow_point_transfer.hpp; a near field is felt by its own load
// only.
//
#pragma once

#include <rosin/condition/held_record.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/string_side.hpp>
#include <rosin/reconstruct/end_motion.hpp>
#include <rosin/reconstruct/reconstructor.hpp>

#include <algorithm>

namespace rosin {

namespace detail {

/// What the loads of one side add to this side's force, to the other side's, and to the velocities, at one frequency.
struct load_echo {
  std::complex<double> own_force, other_force, velocity, near_field;  ///< the last: to both velocities
};

/// `loads`: on this side, outwards from the end, positions as travel times from it. `clamping`: of the end.
[[nodiscard]] inline load_echo echo_of_loads(const std::vector<load_on_side>& loads, double to_bow_s, const bow_point& at,
                                             double f_Hz, std::complex<double> force, std::complex<double> moved,
                                             double clamping = 0) {
  const side_waves waves = waves_at(f_Hz, at.stiffness_s2, propagation_rate(f_Hz, at.stiffness_s2, at.loss), clamping);
  load_echo out{};
  if (waves.ahead != 0) {
    const std::complex<double> turn = std::polar(waves.held, -waves.ahead), onwards = std::exp(waves.gamma * to_bow_s);
    out.own_force = waves.force_factor * force * (turn - 1.0) * onwards;
    out.other_force = waves.force_factor * force * (std::conj(turn) - 1.0) / onwards;
    out.velocity =
        force * (waves.sinh(to_bow_s) - std::sinh(waves.gamma * to_bow_s)) / (waves.impedance_ratio * at.impedance_Ns_m);
  }
  for (const auto& [place, g] : returned_by_loads(loads, waves, to_bow_s, force, moved)) {
    const auto onwards = std::exp(waves.gamma * (to_bow_s - place));
    out.own_force -= g * onwards;
    out.other_force -= g / onwards;
    out.velocity -= g * (onwards - 1.0 / onwards) / (2 * waves.force_factor * waves.impedance_ratio * at.impedance_Ns_m);
  }
  out.near_field = waves.dent / at.impedance_Ns_m * 0.5 * (out.own_force + out.other_force);
  return out;
}

/// Adds the echoes of all loads, and of ends that resist turning, to a motion that was reconstructed without them.
template <class = void>
void add_echoes(const pluck_scene& scene, const bow_point& at, const std::array<std::vector<double>, 2>& force_N,
                const std::array<std::vector<double>, 2>& moved_N, const band& limits, double rate_Hz,
                bow_motion<double>& motion) {
  const auto on_side = loads_by_side(scene.scatterers, at.delay_s);
  held_record record(force_N[0].size(), 8192);
  std::array<std::vector<std::complex<double>>, 4> change;
  for (auto& c : change) c.resize(record.bins());
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& mine = on_side[side];
    const double clamping = scene.ends[side].clamping;
    if (mine.empty() && clamping == 0) continue;
    const auto force = record.spectrum(force_N[side]);
    const auto moved = moved_N[side].empty() ? std::vector<std::complex<double>>(record.bins()) : record.spectrum(moved_N[side]);
    for (std::size_t k = 1; k < record.bins(); ++k) {
      const double f = record.frequency_Hz(k, rate_Hz);
      if (f >= limits.stop_Hz) break;
      const load_echo e = echo_of_loads(mine, at.delay_s[side], at, f, limits(f) * force[k], limits(f) * moved[k], clamping);
      change[side][k] += e.own_force, change[1 - side][k] += e.other_force;
      change[2 + side][k] += e.velocity + e.near_field, change[3 - side][k] += e.near_field;
    }
  }
  const std::array<std::vector<double>*, 4> rows{&motion.force_near_N, &motion.force_far_N, &motion.velocity_near_m_s,
                                                 &motion.velocity_far_m_s};
  for (std::size_t p = 0; p < 4; ++p) {
    const auto more = record.record(std::move(change[p]));
    for (std::size_t i = 0; i < more.size(); ++i) (*rows[p])[i] += more[i];
  }
}

}  // namespace detail

/// Z V of the ends whose modes move (newtons); empty for one that does not.
[[nodiscard]] inline std::array<std::vector<double>, 2> moved_ends(const pluck_scene& scene,
                                                                   const std::array<std::vector<double>, 2>& force_N,
                                                                   const band& limits, double rate_Hz) {
  std::array<std::vector<double>, 2> moved;
  for (std::size_t e = 0; e < 2; ++e)
    if (!scene.ends[e].modes.empty())
      moved[e] = motion_of_end(modal_termination{scene.ends[e].modes}, force_N[e], limits, rate_Hz).times_impedance_N;
  return moved;
}

/// Reconstruction with the loads and the yielding ends of a scene; forces in newtons. Of the ends modes and clamping count,
/// nothing else. `moved`: moved_ends().
template <class = void>
[[nodiscard]] bow_motion<double> reconstruct_loaded(const pluck_scene& scene, const bow_point& at,
                                                    const std::array<std::vector<double>, 2>& force_N,
                                                    const std::array<std::vector<double>, 2>& moved, const band& limits,
                                                    double rate_Hz) {
  bow_motion<double> motion;
  if (moved[0].empty() && moved[1].empty()) {
    motion = reconstructor<double>(at, limits, rate_Hz)(force_N[0], force_N[1]);
  } else {
    auto both = moved;
    for (auto& m : both) m.resize(force_N[0].size(), 0.0);
    motion = reconstructor<double, with_moving_ends<full_physics>>(
        at, limits, rate_Hz)(end_signals<double, with_moving_ends<full_physics>>{force_N[0], force_N[1], both[0], both[1]});
  }
  if (!scene.scatterers.empty() || scene.ends[0].clamping != 0 || scene.ends[1].clamping != 0)
    detail::add_echoes(scene, at, force_N, moved, limits, rate_Hz, motion);
  return motion;
}
ROSIN_INSTANTIATE(bow_motion<double> reconstruct_loaded(const pluck_scene&, const bow_point&,
                                                        const std::array<std::vector<double>, 2>&,
                                                        const std::array<std::vector<double>, 2>&, const band&, double))
template <class = void>
[[nodiscard]] bow_motion<double> reconstruct_loaded(const pluck_scene& scene, const bow_point& at,
                                                    const std::array<std::vector<double>, 2>& force_N, const band& limits,
                                                    double rate_Hz) {
  return reconstruct_loaded(scene, at, force_N, moved_ends(scene, force_N, limits, rate_Hz), limits, rate_Hz);
}

}  // namespace rosin
