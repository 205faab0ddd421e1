// tier: hosted
// SPDX-License-Identifier: MIT
//
// One side of a string as the force F on its end tells it, place by place, with the loads on the way and the end's own motion V =
// Y F. Its waves have
//
//     Z_w v(x) = F sinh(gamma x) + Z V (r cosh(gamma x) + i b sinh(gamma x)) - sum_(x_i < x) (g_i / G) sinh(gamma (x - x_i)),
//     f(x) / G = F cosh(gamma x) + Z V (r sinh(gamma x) + i b cosh(gamma x)) - sum_(x_i < x) (g_i / G) cosh(gamma (x - x_i)),
//
// r = (Z_w / Z) / G and b = q rho K / (w G) as in bow_point_transfer.hpp, x being the travel time from the end, g_i what the i-th
// load returns (loaded_motion.hpp), and f G times what a constant impedance would make of the waves. A plain side is sinh and
// cosh. Where the end resists turning, waves are ahead there by a phase a (pluck_scene.hpp), and the end feels 1 / h = cos a + (k
// / kappa) sin a of their force: h F sinh(gamma x - i a) for F sinh(gamma x). One that moves as well is taken to answer V as a
// pinned end does: off by a share K of what V does.
//
#pragma once

#include <rosin/diagnose/pluck_scene.hpp>
#include <rosin/math/plain_complex.hpp>
#include <rosin/propagate/dispersion.hpp>

#include <algorithm>
#include <array>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

namespace rosin {

namespace detail {

using load_on_side = std::pair<double, scatterer>;  ///< travel time from the end, and what is there

/// A string's waves at one frequency.
struct side_waves {
  double omega = 0;
  std::complex<double> gamma;  ///< per second of travel
  double impedance_ratio = 1;  ///< Z_w / Z
  double force_factor = 1;     ///< G
  std::complex<double> dent;   ///< the near field under a load, Z v / g
  std::complex<double> bent;   ///< i b, the near field of an end that moves
  double ahead = 0, held = 1;  ///< a and h, of an end that resists turning

  /// Of gamma x - i a.
  [[nodiscard]] plain::hyperbolic at(double place_s) const {
    return plain::hyperbolic(gamma * place_s - std::complex<double>(0, ahead));
  }
  [[nodiscard]] std::complex<double> sinh(double place_s) const { return held * at(place_s).sinh; }
};
[[nodiscard]] inline side_waves waves_at(double f_Hz, double stiffness_s2, std::complex<double> gamma, double clamping = 0) {
  const double w = 2 * std::numbers::pi * f_Hz, G = rosin::force_factor(w, stiffness_s2),
               wave = wave_impedance_ratio(w, stiffness_s2);
  const double rho = near_field_ratio(w, stiffness_s2),
               bent = w > 0 ? phase_rate(w, stiffness_s2) * rho * stiffness_ratio(w, stiffness_s2) / (w * G) : 0;
  const double ahead = clamping > 0 && stiffness_s2 > 0 ? phase_ahead(phase_rate(w, stiffness_s2), stiffness_s2, clamping) : 0;
  return {w, gamma, wave, G, {0, -rho / (2 * wave * G)}, {0, bent}, ahead, 1 / (std::cos(ahead) + rho * std::sin(ahead))};
}

/// What every load nearer than `place_s` returns, outwards from the end; F and Z V at the end.
[[nodiscard]] inline std::vector<std::pair<double, std::complex<double>>> returned_by_loads(
    const std::vector<load_on_side>& loads, const side_waves& s, double place_s, std::complex<double> force,
    std::complex<double> moved) {
  std::vector<std::pair<double, std::complex<double>>> returned;
  for (const auto& [place, load] : loads) {
    if (place >= place_s) break;
    std::complex<double> zv = force * s.sinh(place) / s.impedance_ratio + moved * plain::hyperbolic(s.gamma * place).cosh;
    for (const auto& [before, g] : returned)
      zv -= g * plain::hyperbolic(s.gamma * (place - before)).sinh / (s.force_factor * s.impedance_ratio);
    const std::complex<double> z = load.impedance({0, s.omega});
    returned.emplace_back(place, -z * zv / (1.0 + z * s.dent));
  }
  return returned;
}

/// Loads of both sides of a contact, each seen from its end.
[[nodiscard]] inline std::array<std::vector<load_on_side>, 2> loads_by_side(const std::vector<scatterer>& loads,
                                                                            const std::array<double, 2>& delay_s) {
  const double whole = delay_s[0] + delay_s[1];
  std::array<std::vector<load_on_side>, 2> out;
  for (const scatterer& load : loads) {
    const double place = load.position * whole;
    if (place < delay_s[0]) out[0].emplace_back(place, load);
    else out[1].emplace_back(whole - place, load);
  }
  for (auto& side : out) std::sort(side.begin(), side.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return out;
}

}  // namespace detail

struct string_side {
  std::vector<detail::load_on_side> loads{};
  std::vector<admittance_mode> end_modes{};
  double clamping = 0;  ///< of the end: for waves_at()

  /// Z_w v and f / G, per newton on the end.
  struct state {
    std::complex<double> velocity, force;
  };
  [[nodiscard]] state at(double place_s, const detail::side_waves& s) const {
    const plain::hyperbolic own = s.at(place_s), pinned = s.ahead == 0 ? own : plain::hyperbolic(s.gamma * place_s);
    state out{s.held * own.sinh, s.held * own.cosh};
    std::complex<double> moved = 0;
    for (const admittance_mode& m : end_modes) moved += m({0, s.omega});
    const std::complex<double> lead = moved * (s.impedance_ratio / s.force_factor), bent = moved * s.bent;
    out.velocity += lead * pinned.cosh + bent * pinned.sinh;
    out.force += lead * pinned.sinh + bent * pinned.cosh;
    for (const auto& [place, g] : detail::returned_by_loads(loads, s, place_s, 1, moved)) {
      const plain::hyperbolic onwards(s.gamma * (place_s - place));
      out.velocity -= g * onwards.sinh / s.force_factor;
      out.force -= g * onwards.cosh / s.force_factor;
    }
    return out;
  }
};

/// Both sides of a contact on a scene's string. Of the ends modes and clamping count, nothing else, as in loaded_motion.hpp.
[[nodiscard]] inline std::array<string_side, 2> sides_of(const pluck_scene& scene, const std::array<double, 2>& delay_s) {
  auto loads = detail::loads_by_side(scene.scatterers, delay_s);
  return {string_side{std::move(loads[0]), scene.ends[0].modes, scene.ends[0].clamping},
          string_side{std::move(loads[1]), scene.ends[1].modes, scene.ends[1].clamping}};
}

}  // namespace rosin
