// tier: hosted
// SPDX-License-Identifier: MIT
//
// What follows from a rig file: the values to calculate with, their standard deviations (a tolerance is a limit, taken as
// two of them), and every default that was used on the way, as a plain sentence each. Nothing is guessed in silence.
//
//     c = 2 L f0,  Z = T / c,  m = Z / c        (or, for a solid round wire, m = rho pi d^2 / 4 and T = m c^2)
//     B = E pi d^4 / 64
//
#pragma once

#include <rosin/acquire/rig.hpp>
#include <rosin/core/number_text.hpp>

#include <algorithm>
#include <cmath>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// A value and its standard deviation.
struct nominal {
  double value = 0, sd = 0;
};

struct rig_values {
  nominal fundamental_Hz;
  std::optional<nominal> length_m, tension_N, impedance_Ns_m, bending_stiffness_Nm2, position;
  std::optional<double> linear_density_kg_m, wave_speed_m_s;
  double quality = 1000, loss_internal_s = 0, loss_air_sqrt_Hz = 0;
  friction_model friction = friction_model::velocity_curve;
  std::vector<std::string> assumed;  ///< "impedance_Ns_m = 0.1749, from tension and fundamental"
};

namespace detail {

inline constexpr double default_position_tolerance = 0.005, default_tension_tolerance = 0.02,
                        default_fundamental_tolerance = 0.003, default_length_tolerance = 0.002,
                        default_stiffness_tolerance = 0.05, default_gain_tolerance = 0.05, default_force_tolerance = 0.03,
                        default_quality = 1000;

/// "key = 0.1749, why"
[[nodiscard]] inline std::string sentence(const std::string& key, double value, const std::string& why) {
  return key + " = " + number_text(value, "%.4g") + ", " + why;
}

/// The value given, or the default with the sentence that owns up to it.
[[nodiscard]] inline double given_or(const std::optional<double>& given, double fallback, const std::string& key, rig_values& out,
                                     const std::string& why = "none given") {
  if (!given) out.assumed.push_back(sentence(key, fallback, why));
  return given.value_or(fallback);
}

[[nodiscard]] inline std::optional<nominal> relative(const std::optional<double>& value, const std::optional<double>& tolerance,
                                                     double fallback, const std::string& key, rig_values& out) {
  if (!value) return std::nullopt;
  return nominal{*value, *value * given_or(tolerance, fallback, key + "_tolerance", out) / 2};
}

/// Mass per length of a solid round wire, where diameter and density are known.
[[nodiscard]] inline std::optional<double> wire_density(const string_section& s) noexcept {
  constexpr double pi = 3.14159265358979323846;
  if (!s.diameter_m || !s.density_kg_m3) return std::nullopt;
  return *s.density_kg_m3 * pi / 4 * *s.diameter_m * *s.diameter_m;
}

[[nodiscard]] inline std::optional<double> wire_stiffness(const string_section& s) noexcept {
  constexpr double pi = 3.14159265358979323846;
  if (!s.diameter_m || !s.youngs_modulus_Pa) return std::nullopt;
  return *s.youngs_modulus_Pa * pi / 64 * std::pow(*s.diameter_m, 4);
}

inline void derive_string(const string_section& s, rig_values& out) {
  out.fundamental_Hz = *relative(s.fundamental_Hz, s.fundamental_tolerance, default_fundamental_tolerance, "fundamental", out);
  out.length_m = relative(s.length_m, s.length_tolerance, default_length_tolerance, "length", out);
  out.tension_N = relative(s.tension_N, s.tension_tolerance, default_tension_tolerance, "tension", out);
  out.bending_stiffness_Nm2 =
      relative(s.bending_stiffness_Nm2, s.bending_stiffness_tolerance, default_stiffness_tolerance, "bending_stiffness", out);
  if (const auto stiffness = wire_stiffness(s); stiffness && !out.bending_stiffness_Nm2) {
    out.bending_stiffness_Nm2 = nominal{*stiffness, *stiffness * 0.1};
    out.assumed.push_back(sentence("bending_stiffness_Nm2", *stiffness, "from Young's modulus and diameter (solid wire)"));
  }
  if (out.length_m) out.wave_speed_m_s = 2 * out.length_m->value * s.fundamental_Hz;
}

/// Tension from the wire where it was not measured; impedance as given, or from tension and fundamental.
inline void derive_impedance(const string_section& s, rig_values& out) {
  if (!out.wave_speed_m_s) return;
  const double c = *out.wave_speed_m_s;
  if (const auto density = wire_density(s); density && !out.tension_N) {
    out.tension_N = nominal{*density * c * c, *density * c * c * default_tension_tolerance / 2};
    out.assumed.push_back(sentence("tension_N", out.tension_N->value, "from diameter, density, length and fundamental"));
  }
  if (s.impedance_Ns_m) {
    out.impedance_Ns_m = relative(s.impedance_Ns_m, s.impedance_tolerance, default_tension_tolerance, "impedance", out);
  } else if (out.tension_N) {
    const double pitch = out.fundamental_Hz.sd / s.fundamental_Hz, tension = out.tension_N->sd / out.tension_N->value;
    const double z = out.tension_N->value / c;
    out.impedance_Ns_m = nominal{z, z * std::hypot(pitch, tension)};
    out.assumed.push_back(sentence("impedance_Ns_m", z, "from tension and fundamental"));
  }
  if (out.impedance_Ns_m) out.linear_density_kg_m = out.impedance_Ns_m->value / c;
}

/// A gain's tolerance matters only where the gain does.
inline void note_channels_and_takes(const rig& r, rig_values& out) {
  for (const auto& c : r.channels)
    if (c.scale_assumed) out.assumed.push_back("channels." + c.name + ": its column is in SI units, no scale given");
  for (const auto& c : r.channels)
    if (c.quantity == quantity::termination_force && !c.gain_tolerance)
      out.assumed.push_back(sentence("channels." + c.name + ".gain_tolerance", default_gain_tolerance, "none given"));
  for (const auto& t : r.takes)
    if (t.force_N && !t.force_tolerance)
      out.assumed.push_back(sentence("force_tolerance of take " + t.name, default_force_tolerance, "none given"));
}

inline void note_model(const rig& r, rig_values& out) {
  if (!r.bow && std::any_of(r.takes.begin(), r.takes.end(), [](const take& t) { return t.kind == take_kind::bow; }))
    out.assumed.push_back("bow = a rigid rod, no [bow]");
  if (!r.near) out.assumed.push_back("terminations.near = rigid, none given");
  if (!r.far) out.assumed.push_back("terminations.far = rigid, none given");
  if (!r.model) out.assumed.push_back("model.physics = none, no [model]");
  if (r.model && r.model->friction) out.friction = *r.model->friction;
  else out.assumed.push_back("model.friction = velocity-curve, none given");
}

}  // namespace detail

[[nodiscard]] inline double gain_tolerance_of(const sensor_channel& c) noexcept {
  return c.gain_tolerance.value_or(detail::default_gain_tolerance);
}
[[nodiscard]] inline double force_tolerance_of(const take& t) noexcept {
  return t.force_tolerance.value_or(detail::default_force_tolerance);
}

/// All that follows from a rig file that passed its checks.
[[nodiscard]] inline rig_values values_of(const rig& r) {
  rig_values out;
  detail::derive_string(r.string, out);
  detail::derive_impedance(r.string, out);
  out.quality = detail::given_or(r.string.quality, detail::default_quality, "quality", out, "none given; a fit replaces it");
  out.loss_internal_s = r.string.loss_internal_s.value_or(0);
  out.loss_air_sqrt_Hz = r.string.loss_air_sqrt_Hz.value_or(0);
  if (r.contact_position)
    out.position =
        nominal{*r.contact_position,
                detail::given_or(r.position_tolerance, detail::default_position_tolerance, "position_tolerance", out) / 2};
  detail::note_channels_and_takes(r, out);
  detail::note_model(r, out);
  return out;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
