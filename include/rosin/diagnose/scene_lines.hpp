// tier: hosted
// SPDX-License-Identifier: MIT
//
// The damped lines of a scene, as its two channels record a pluck of 1 N from the instant of release on. Factors that a pole s
// meets:
//
//     wire lets go over d:   (1/2) (1 + e^{-s d}) a^2 / (a^2 + s^2),  a = pi / d     (transform of -F'(t)/F0)
//     wire of width w:       sin(k w / 2) / (k w / 2)
//     second polarisation:   the same string at f (1 + detuning), coupling times as strong; the sum has the static force of 1 N
//     sensor:                H_c(s); and the sensor's own pole s_r rings with  -2 Res[H_c, s_r] H_string(s_r) / s_r
//     crosstalk:             near + fraction far, far + fraction near
//
#pragma once

#include <rosin/diagnose/string_poles.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// What the wire makes of a pole.
inline std::complex<double> wire_factor(const pluck_scene& scene, std::complex<double> s) {
  std::complex<double> factor = 1;
  if (const double d = scene.release_duration_s; d > 0) {
    const double a = std::numbers::pi / d;
    factor *= 0.5 * (1.0 + std::exp(-s * d)) * (a * a) * plain::reciprocal(a * a + s * s);
  }
  if (scene.width > 0) {
    const double w = std::abs(s.imag()), half = phase_rate(w, std::max(scene.string.stiffness_s2(), 0.0)) /
                                                (4 * scene.string.fundamental_Hz) * scene.width;
    if (half > 1e-9) factor *= std::sin(half) / half;
  }
  return factor;
}

/// The string by itself: forces on the ends, no wire, no sensors.
template <class = void>
std::vector<damped_line> string_lines(const pluck_scene& scene, double position, int most,
                                      const std::vector<std::complex<double>>& poles, double highest_Hz) {
  if (scene.plain_string()) return pluck_lines(scene.string, position, 0, {highest_Hz, highest_Hz}, most);
  std::vector<damped_line> lines = decay_lines(scene, position, poles);
  for (damped_line& line : lines) {
    const double f = std::abs(line.pole.imag()) / (2 * std::numbers::pi);
    if (f == 0) continue;
    const std::complex<double> turn(1, scene.string.convention * scene.string.loss.inverse_q(f) / 2);
    for (auto& r : line.residue) r *= turn;
  }
  return lines;
}

/// Frequency of a partial under a tension that moves f0 by the factor 1 + detuning, relative to what it was: stiffness is not
/// moved.
inline double stretched(const ringing_string& string, double frequency_Hz, double detuning) {
  const double x = std::pow(frequency_Hz / string.fundamental_Hz, 2), b = std::max(0.0, string.inharmonicity);
  const double n2 = 2 * x / (1 + std::sqrt(1 + 4 * b * x)), d = 1 + detuning;  // x = n^2 (1 + b n^2)
  return std::sqrt((d * d + b * n2) / (1 + b * n2));
}

inline void add_polarisation(const pluck_scene& scene, std::vector<damped_line>& lines) {
  const double c = scene.coupling, weight = 1 / (1 + c);
  if (c == 0) return;
  const std::size_t count = lines.size();
  for (std::size_t i = 0; i < count; ++i) {
    damped_line other = lines[i];
    const double by_tension = stretched(scene.string, std::abs(other.pole.imag()) / (2 * std::numbers::pi), scene.detuning);
    other.pole *= by_tension + scene.detuned_alike * (1 + scene.detuning - by_tension);
    for (auto& r : lines[i].residue) r *= weight;
    for (auto& r : other.residue) r *= weight * c;
    lines.push_back(other);
  }
}

/// The sensors' own ringing, from the string's closed-form response at their poles.
template <class = void>
void add_sensor_ringing(const pluck_scene& scene, double position, std::vector<damped_line>& lines) {
  for (std::size_t c = 0; c < 2; ++c) {
    const sensor_response& sensor = scene.sensors[c];
    if (!(sensor.resonance_Hz > 0) || sensor.q <= 0.5) continue;
    const std::complex<double> s = sensor.pole();
    const loop_response loop = close_loop(scene, position, s);
    const double w = 2 * std::numbers::pi * sensor.resonance_Hz;
    sensor_response rest = sensor;
    rest.resonance_Hz = 0;
    const std::complex<double> residue = w * w / (s - std::conj(s)) * rest(s) * wire_factor(scene, s);
    damped_line own{s, {}};
    own.residue[c] = -2.0 * residue * loop.times_determinant[c] / loop.determinant / s;
    lines.push_back(own);
  }
}

}  // namespace detail

/// What wire, polarisation and sensors make of the string's own lines (detail::string_lines).
template <class = void>
[[nodiscard]] std::vector<damped_line> recorded_lines(std::vector<damped_line> lines, const pluck_scene& scene, double position,
                                                      const band& limits) {
  detail::add_polarisation(scene, lines);
  for (damped_line& line : lines) {
    const std::complex<double> wire = detail::wire_factor(scene, line.pole);
    for (std::size_t c = 0; c < 2; ++c) line.residue[c] *= wire * scene.sensors[c](line.pole);
  }
  detail::add_sensor_ringing(scene, position, lines);
  for (damped_line& line : lines) {
    const auto [near, far] = line.residue;
    const std::complex<double> weight = band_weight(limits, line.pole);
    line.residue = {weight * (near + scene.crosstalk * far), weight * (far + scene.crosstalk * near)};
  }
  return lines;
}

/// All of it. `poles`: of the scene's string (string_poles.hpp); not needed where it is plain.
template <class = void>
[[nodiscard]] std::vector<damped_line> scene_lines(const pluck_scene& scene, double position, const band& limits, int most,
                                                   const std::vector<std::complex<double>>& poles) {
  return recorded_lines(detail::string_lines(scene, position, most, poles, limits.stop_Hz), scene, position, limits);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
