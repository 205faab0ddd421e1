// tier: hosted
// SPDX-License-Identifier: MIT
//
// The catalogue, as far as plucks tell of it: string, ends, wire, sensors (docs/explain/catalogue.md). Each entry is a scene
// that is a little different. A new effect is one function here, or in a header of its own, and one line in pluck_effects().
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/hum_effect.hpp>
#include <rosin/diagnose/wire_effects.hpp>

#include <algorithm>
#include <cmath>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

inline std::vector<double> geometric(double from, double to, double ratio) {
  std::vector<double> out;
  for (double x = from; x <= to; x *= ratio) out.push_back(x);
  return out;
}
/// What yields between string and load: at most what a hundredth of the string's length would.
inline double most_bond_s(const string_facts& s) { return 0.01 / (2 * s.fundamental_Hz); }
/// How late a load or a support may answer.
inline constexpr double most_lag_s = 1e-5;
/// Relative to Z where the impedance is unknown.
inline double unit_of(const string_facts& s) { return s.impedance_Ns_m > 0 ? s.impedance_Ns_m : 1.0; }

}  // namespace detail

/// B: only where the model lacks it; the string's own inharmonicity b = pi^2 B / (T L^2) is freed.
inline pluck_effect bending_stiffness_effect(const string_facts&) {
  return {.name = "bending-stiffness",
          .parameters = {{"inharmonicity", -1e-6, 0.01, 1e-8}},
          .starts = {{1e-6}},
          .apply = [](pluck_scene& s, const double* v, int) { s.string.inharmonicity += v[0]; }};
}

/// 1/Q = 1/Q0 + loss f.
inline pluck_effect internal_loss_effect(const string_facts&) {
  return {.name = "frequency-dependent-loss",
          .parameters = {{"loss_internal_s", 0, 3e-5, 1e-11}},
          .starts = {{1e-8}},
          .apply = [](pluck_scene& s, const double* v, int) { s.string.loss.internal_s += v[0]; }};
}

/// 1/Q = 1/Q0 + loss / sqrt(f) + drag / f: the boundary layer's part, and that of slow viscous flow, eta / m (Valette 1995).
inline pluck_effect air_loss_effect(const string_facts& f) {
  return {
      .name = "air-loss",
      .parameters = {{"loss_air_sqrt_Hz", 0, 1, 1e-6}, correction("loss_drag_Hz", 0, 0.01 * f.fundamental_Hz, 1e-5)},
      .starts = {{1e-3, 0}},
      .apply = [](pluck_scene& s, const double* v, int) { s.string.loss.air_sqrt_Hz += v[0], s.string.loss.drag_Hz += v[1]; }};
}

/// A second plane of vibration. Whether stiffness goes with its pitch depends on what detunes it: supports do not ask for it, a
/// string that is not round does.
inline pluck_effect polarisation_effect(const string_facts&) {
  pluck_effect e{
      .name = "second-polarization",
      .parameters = {{"detuning", -0.03, 0.03, 1e-7}, {"coupling", -0.9, 0.9, 1e-5}, correction("alike", -1, 2, 1e-3)},
      .strength = 1,
      .apply = [](pluck_scene& s, const double* v, int) { s.detuning = v[0], s.coupling = v[1], s.detuned_alike = v[2]; }};
  for (const double d : detail::geometric(1e-4, 0.021, 1.15))
    for (const double sign : {-1.0, 1.0}) e.starts.push_back({sign * d, 1e-3, 0});
  return e;
}

/// A bead, a winding's end.
inline pluck_effect point_mass_effect(const string_facts& f) {
  const double Z = detail::unit_of(f), bond = detail::most_bond_s(f);
  pluck_effect e{.name = "point-mass",
                 .parameters = {{"position", 0.003, 0.997, 1e-6},
                                {"mass_kg", 0, 1e-2 * Z, 1e-9 * Z},
                                correction("bond_s", -bond, bond, 1e-9),
                                correction("loaded_loss", -1, 2, 1e-3)},
                 .strength = 1,
                 .apply = [Z](pluck_scene& s, const double* v, int) {
                   s.scatterers.push_back({v[0], v[1] / Z, 0, 0, v[2]});
                   s.loaded_loss = std::clamp(s.loaded_loss + v[3], -1.0, 2.0);
                 }};
  for (int i = 1; i < 96; ++i) e.starts.push_back({i / 96.0, 3e-8 * Z, 0, 0});
  return e;
}

/// A finger, felt.
inline pluck_effect point_damper_effect(const string_facts& f) {
  const double Z = detail::unit_of(f), lag = detail::most_lag_s;
  pluck_effect e{.name = "point-damper",
                 .parameters = {{"position", 0.003, 0.997, 1e-6},
                                {"resistance_Ns_m", 0, 50 * Z, 1e-6 * Z},
                                correction("lag_s", -lag, lag, 1e-9)},
                 .strength = 1,
                 .apply = [Z](pluck_scene& s, const double* v, int) {
                   s.scatterers.push_back({v[0], 0, v[1] / Z, 0, 0, v[2]});
                 }};
  for (int i = 1; i < 64; ++i) e.starts.push_back({i / 64.0, 1e-5 * Z, 0});
  return e;
}

/// A damped mass on a spring under the string's end. Late or not, at its frequency it moves in phase with the force: the lag is
/// that of mass and spring, 1/Y = R + (M s + K / s) exp(s lag) = exp(s lag) ((M - R lag) s + R + K / s) to first order.
inline pluck_effect support_resonance_effect(const string_facts& f, int end) {
  const double Z = detail::unit_of(f), lag = detail::most_lag_s;
  pluck_effect e{.name = "support-resonance",
                 .place = end,
                 .at_end = true,
                 .parameters = {{"frequency_Hz", 2, f.highest_Hz, 1e-6, true},
                                {"q", 0.6, 3000, 1e-5, true},
                                {"per_mass_per_kg", 0, 1e5 / Z, 1e-4 / Z},
                                correction("lag_s", -lag, lag, 1e-9)},
                 .strength = 2,
                 .apply = [Z, end](pluck_scene& s, const double* v, int) {
                   // of the mass; the rest is what the resistance lags
                   const double share = std::max(0.5, 1 - 2 * std::numbers::pi * v[0] * v[3] / v[1]);
                   s.ends[static_cast<std::size_t>(end)].modes.push_back(
                       {v[0] / std::sqrt(share), v[1] * std::sqrt(share), v[2] * Z / share});
                   s.ends[static_cast<std::size_t>(end)].lag_s += v[3];
                 }};
  for (const double q : {6.0, 25.0, 100.0})
    for (const double x : detail::geometric(std::min(100.0, 0.3 * f.fundamental_Hz), 0.8 * f.highest_Hz, 1 + 0.7 / q))
      e.starts.push_back({x, q, 1e-2 / Z, 0});
  return e;
}

/// An end that takes energy at all frequencies alike: a damper, and beside it the spring without which nothing would hold the
/// string under the wire (K / R is 2 pi corner).
inline pluck_effect resistive_end_effect(const string_facts& f, int end) {
  const double Z = detail::unit_of(f), lag = detail::most_lag_s;
  pluck_effect e{.name = "resistive-end",
                 .place = end,
                 .at_end = true,
                 .parameters = {{"conductance_m_sN", 1e-7 / Z, 0.5 / Z, 1e-5, true},
                                {"corner_Hz", 1e-3 * f.fundamental_Hz, 2 * f.fundamental_Hz, 1e-4, true},
                                correction("lag_s", -lag, lag, 1e-9)},
                 .strength = -1,
                 .apply = [Z, end](pluck_scene& s, const double* v, int) {
                   yielding_end& there = s.ends[static_cast<std::size_t>(end)];
                   there.modes.push_back(overdamped_mode(v[0] * Z, v[1]));
                   there.lag_s += v[2];
                 }};
  for (const double relative : detail::geometric(3e-6, 0.05, 5))
    for (const double slow : {0.01, 0.1}) e.starts.push_back({relative / Z, slow * f.fundamental_Hz, 0});
  e.shrinks_with = 0;
  return e;
}

/// An end that is a mass without a spring.
inline pluck_effect massive_end_effect(const string_facts& f, int end) {
  const double Z = detail::unit_of(f);
  return {.name = "massive-end",
          .place = end,
          .at_end = true,
          .parameters = {{"per_mass_per_kg", 0, 1e4 / Z, 1e-4 / Z}},
          .starts = {{1e-2 / Z}},
          .apply = [Z, end](pluck_scene& s, const double* v, int) {
            s.ends[static_cast<std::size_t>(end)].per_free_mass_per_s += v[0] * Z;
          }};
}

/// An end that holds the string against turning (a knife's edge does not, a vice does), or both alike (`end` -1). For slow motion
/// the string is but shorter, for less slow motion less stiff, since with d = sqrt(B / T), c for the clamping and q for the wave
/// number
///
///     phase ahead = c (q d) - (2 c - 3/2 c^2 + 1/3 c^3) (q d)^3 + ...
///
/// so that pitch, stiffness and place go along.
template <class Real = double>
pluck_effect clamped_end_effect(const string_facts&, int end) {
  pluck_effect e{.name = "clamped-end",
                 .place = end,
                 .at_end = true,
                 .parameters = {{"clamping", 0, 1, 1e-6}},
                 .starts = {{0.2}, {0.45}, {0.7}, {1.0}},
                 .apply = [end](pluck_scene& s, const double* v, int) {
                   for (int side = 0; side < 2 && s.string.inharmonicity > 0; ++side)
                     if (double& clamping = s.ends[static_cast<std::size_t>(side)].clamping; end < 0 || side == end)
                       clamping = std::min(1.0, clamping + v[0]);
                 }};
  e.rebase = [end](const pluck_layout& layout, Eigen::VectorX<Real>& v) {
    const double c = v[v.size() - 1], reach = shortened_by(layout.string(v), 1), ends = end < 0 ? 2 : 1;  // of the old length
    const double less = c * reach, whole = 1 / (1 + ends * less), softer = 2 * ends * reach * c * (2 - c * (1.5 - c / 3));
    v[pluck_layout::fundamental] *= whole;
    for (std::size_t p = 0; p < layout.positions().size(); ++p) {
      double& x = v[pluck_layout::first_position + static_cast<Eigen::Index>(p)];
      x = (x + (end == 1 ? 0 : less)) * whole;
    }
    v[pluck_layout::inharmonicity] *= whole * whole * (1 + softer);
  };
  if (end < 0) e.variant = "both";
  return e;
}
ROSIN_INSTANTIATE(pluck_effect clamped_end_effect(const string_facts&, int))

/// Both channels pass a first-order high-pass. What the held string gave was taken for part of the offset.
template <class Real = double>
pluck_effect ac_coupling_effect(const string_facts&) {
  pluck_effect e{.name = "ac-coupling",
                 .parameters = {{"cutoff_Hz", 0.005, 200, 1e-5, true}},
                 .starts = {{0.02}, {0.1}, {0.5}, {2}, {8}, {25}, {70}},
                 .strength = -1,
                 .apply = [](pluck_scene& s, const double* v, int) { s.sensors[0].corner_Hz = s.sensors[1].corner_Hz = v[0]; }};
  e.shrinks_with = 0;
  e.rebase = [](const pluck_layout& layout, Eigen::VectorX<Real>& v) {
    for (std::size_t t = 0; t < layout.takes(); ++t)
      for (std::size_t c = 0; c < 2; ++c)
        v[layout.at(t, pluck_layout::offset_near + static_cast<int>(c))] += std::exp(v[layout.at(t, pluck_layout::strength)]) *
                                                                            pluck_layout::gain(v, c) *
                                                                            static_forces(v[layout.position(t)])[c];
  };
  return e;
}
ROSIN_INSTANTIATE(pluck_effect ac_coupling_effect(const string_facts&))

/// The transducer's own resonance.
inline pluck_effect sensor_resonance_effect(const string_facts& f, int channel) {
  pluck_effect e{.name = "sensor-resonance",
                 .place = channel,
                 .parameters = {{"frequency_Hz", 300, 1.5 * f.rate_Hz, 1e-6, true}, {"q", 0.55, 500, 1e-5, true}},
                 .strength = -1,
                 .apply = [channel](pluck_scene& s, const double* v, int) {
                   s.sensors[static_cast<std::size_t>(channel)].resonance_Hz = v[0];
                   s.sensors[static_cast<std::size_t>(channel)].q = v[1];
                 }};
  // Seen from below it lifts by (f / w0)^2 and delays by 1 / (Q w0): where the delay is more, it is as good as a skew.
  const double seen_to_Hz = 0.25 * f.rate_Hz;
  e.is_itself = [seen_to_Hz](const std::vector<double>& v) { return v[0] < seen_to_Hz || v[1] > v[0] / seen_to_Hz; };
  for (const double q : {4.0, 12.0, 40.0})
    for (const double x : detail::geometric(0.02 * f.rate_Hz, 0.8 * f.rate_Hz, 1 + 0.5 / q)) e.starts.push_back({x, q});
  return e;
}

/// The far channel comes late.
inline pluck_effect skew_effect(const string_facts&) {
  return {.name = "channel-skew",
          .parameters = {{"skew_s", -2e-3, 2e-3, 1e-11}},
          .starts = {{1e-9}},
          .apply = [](pluck_scene& s, const double* v, int) {
            s.sensors[0].delay_s -= v[0] / 2;
            s.sensors[1].delay_s += v[0] / 2;
          }};
}

/// A part of each channel in the other.
inline pluck_effect crosstalk_effect(const string_facts&) {
  return {.name = "channel-crosstalk",
          .parameters = {{"fraction", -0.5, 0.5, 1e-7}},
          .starts = {{1e-5}},
          .apply = [](pluck_scene& s, const double* v, int) { s.crosstalk = v[0]; }};
}

/// All of them, in the order of the format. `physics`: names that the declared model already contains.
template <class = void>
[[nodiscard]] std::vector<pluck_effect> pluck_effects(const string_facts& f) {
  std::vector<pluck_effect> all{
      bending_stiffness_effect(f), internal_loss_effect(f), air_loss_effect(f), polarisation_effect(f), point_mass_effect(f),
      point_damper_effect(f),      ac_coupling_effect(f),   skew_effect(f),     crosstalk_effect(f),    slow_release_effect(f),
      pluck_width_effect(f),       hum_effect(f, 50),       hum_effect(f, 60)};
  for (const int place : {0, 1}) {
    all.push_back(support_resonance_effect(f, place));
    all.push_back(resistive_end_effect(f, place));
    all.push_back(massive_end_effect(f, place));
    all.push_back(clamped_end_effect(f, place));
    all.push_back(sensor_resonance_effect(f, place));
  }
  all.push_back(clamped_end_effect(f, -1));
  if (f.takes > 1) all.push_back(slow_release_effect(f, true));
  return all;
}
ROSIN_INSTANTIATE(std::vector<pluck_effect> pluck_effects(const string_facts&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
