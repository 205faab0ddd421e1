// tier: hosted
// SPDX-License-Identifier: MIT
//
// What wire and sensors of a scene make of forces that are there as samples, not as damped lines: the same factors as in
// scene_lines.hpp, in the frequency domain; the high-pass, whose memory is long, step by step.
//
#pragma once

#include <rosin/condition/ac_coupling.hpp>
#include <rosin/condition/held_record.hpp>
#include <rosin/diagnose/scene_lines.hpp>

#include <array>
#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// Multiplies a record by response(i w), but for its mean; its ends are held in the padding.
template <class Response>
void filter_record(std::vector<double>& x, double rate_Hz, const Response& response) {
  if (x.empty()) return;
  held_record record(x.size(), 4096);
  auto bins = record.spectrum(x);
  for (std::size_t k = 1; k < bins.size(); ++k)
    bins[k] *= response(std::complex<double>{0, 2 * std::numbers::pi * record.frequency_Hz(k, rate_Hz)});
  x = record.record(std::move(bins));
}

/// Divides a channel by its sensor's response, above `edge_Hz` by that at the edge.
inline void divide_by_sensor(std::vector<double>& x, const sensor_response& sensor, double rate_Hz, double edge_Hz) {
  const double edge = 2 * std::numbers::pi * edge_Hz;
  filter_record(x, rate_Hz, [&](std::complex<double> s) { return 1.0 / sensor({0, std::min(edge, s.imag())}); });
}

/// What a sensor felt, as far up as its own ringing leaves more of it than of the noise.
inline void unring(std::vector<double>& x, sensor_response sensor, double rate_Hz) {
  sensor.corner_Hz = sensor.delay_s = 0;
  divide_by_sensor(x, sensor, rate_Hz, std::min(0.45 * rate_Hz, 2 * sensor.resonance_Hz));
}

}  // namespace detail

/// Forces on {near, far} that a sudden release would have made, from then on; by the wire's width and the time that it takes to
/// let go.
inline void pass_wire(std::array<std::vector<double>, 2>& force_N, const pluck_scene& scene, double rate_Hz) {
  if (!(scene.release_duration_s > 0 || scene.width > 0)) return;
  for (auto& x : force_N)
    detail::filter_record(x, rate_Hz, [&](std::complex<double> s) {
      return detail::wire_factor(scene, s + 1.0);
    });  // beside the zero of its denominator
}

/// Forces on {near, far}, nothing before, as the channels record them but for their gains: ringing, delay, high-pass, leakage.
inline void pass_sensors(std::array<std::vector<double>, 2>& force_N, const pluck_scene& scene, double rate_Hz) {
  for (std::size_t c = 0; c < 2; ++c) {
    sensor_response own = scene.sensors[c];
    const double corner_Hz = std::exchange(own.corner_Hz, 0.0);
    if (own.resonance_Hz > 0 || own.delay_s != 0) detail::filter_record(force_N[c], rate_Hz, own);
    pass_ac_coupled(std::span(force_N[c]), corner_Hz, rate_Hz);
  }
  if (scene.crosstalk == 0) return;
  for (std::size_t i = 0; i < force_N[0].size(); ++i) {
    const double near = force_N[0][i], far = force_N[1][i];
    force_N[0][i] = near + scene.crosstalk * far, force_N[1][i] = far + scene.crosstalk * near;
  }
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
