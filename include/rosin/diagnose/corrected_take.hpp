// tier: hosted
// SPDX-License-Identifier: MIT
//
// Bowed takes without what the sensors did to them, once plucks have told what that is: each channel's own response divided out
// in the frequency domain, crosstalk inverted, mains hum taken out (in the phase that the disagreement of both ends tells), a curved
// characteristic straightened, another clock's samples read at the instants of the first. Recorded nominal newtons in and out.
// Effects on the string itself are not undone here.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/scene_fit.hpp>
#include <rosin/diagnose/sensor_chain.hpp>
#include <rosin/math/spectrum_line.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// A line of the hum as plucks have it, whatever its phase: frequency, and both channels' amplitudes against one another.
struct hum_line {
  double frequency_Hz = 0, size_N = 0;
  std::array<std::complex<double>, 2> shape{};  ///< of length 1
};

template <class = void>
[[nodiscard]] std::vector<hum_line> hum_of_plucks(const scene_data& data, const scene_fit& fit) {
  const scene_plucks plucks(data.layout, data.guess.ac_coupled_Hz, fit.effects);
  std::vector<std::vector<hum_phasor>> takes;
  for (int t = 0; t < static_cast<int>(data.layout.takes()); ++t) takes.push_back(plucks.scene(fit.value, t).hum);
  std::vector<hum_line> out;
  for (std::size_t l = 0; !takes.empty() && l < takes[0].size(); ++l) {
    Eigen::Matrix2cd power = Eigen::Matrix2cd::Zero();
    for (const auto& take : takes) {
      const Eigen::Vector2cd a(take[l].amplitude_N[0], take[l].amplitude_N[1]);
      power += a * a.adjoint() / static_cast<double>(takes.size());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2cd> main(power);
    const double size = std::sqrt(std::max(0.0, main.eigenvalues()[1]));
    if (size > 0) out.push_back({takes[0][l].frequency_Hz, size, {main.eigenvectors()(0, 1), main.eigenvectors()(1, 1)}});
  }
  return out;
}

/// Takes a line of the hum out of a stroke. What the bow does to a string is in both ends' forces in one proportion,
/// F_1 sin(w tau_1) = F_2 sin(w tau_2), at such low frequencies often more than the hum itself, which is not in that proportion. It
/// is no larger than it was.
inline void take_out_line(std::array<std::vector<double>, 2>& x, const hum_line& line, const pluck_scene& scene,
                          const std::array<double, 2>& gain, const std::array<double, 2>& delay_s, double rate_Hz) {
  constexpr double at_most = 1.3;
  const double w = 2 * std::numbers::pi * line.frequency_Hz;
  const auto balance = [&](std::size_t c) { return std::sin(w * delay_s[c]) / scene.sensors[c]({0, w}); };
  std::complex<double> parts = 0, would = 0;
  for (const std::size_t c : {0U, 1U}) {
    const auto weight = (c == 0 ? 1.0 : -1.0) * (balance(c) + scene.crosstalk * balance(1 - c)) / gain[c];
    parts += weight * phasor_at(hann_windowed(x[c]), line.frequency_Hz, rate_Hz), would += weight * line.shape[c];
  }
  if (would == 0.0) return;
  std::complex<double> size = parts / would;
  size *= std::min(1.0, at_most * line.size_N / std::max(1e-300, std::abs(size)));
  for (const std::size_t c : {0U, 1U})
    for (std::size_t i = 0; i < x[c].size(); ++i)
      x[c][i] -= (size * line.shape[c] * std::polar(1.0, w * static_cast<double>(i) / rate_Hz)).real();
}

}  // namespace detail

/// Whether nothing sits on the string and its ends are rigid. A second polarisation does not count: the bow moves one of them
/// only.
[[nodiscard]] inline bool string_is_plain(const pluck_guess& known, const std::vector<pluck_effect>& effects) {
  return !known.has_ends() && std::none_of(effects.begin(), effects.end(), [](const pluck_effect& e) {
    return e.at_end || e.name == "point-mass" || e.name == "point-damper";
  });
}

/// In place, near and far; `delay_s`: from the ends to where the string is bowed.
template <class = void>
void undo_sensors(const scene_data& data, const scene_fit& fit, std::array<std::vector<double>, 2>& recorded,
                  const std::array<double, 2>& delay_s, double rate_Hz, double edge_Hz) {
  const pluck_scene scene = scene_of(data, fit);
  const std::array<double, 2> gain{std::exp(fit.value[pluck_layout::gain_near]), std::exp(fit.value[pluck_layout::gain_far])};
  Eigen::Index at = data.layout.size();
  for (const pluck_effect& e : fit.effects) {
    if ((e.name == "sensor-nonlinearity" || e.name == "clock-drift") && e.undo && fit.value[at] != 0) {
      std::vector<pluck_take> one(1);
      one[0].force_N = recorded, one[0].rate_Hz = rate_Hz;
      e.undo(one, scene, data.layout, fit.value, fit.value[at]);
      recorded = one[0].force_N;
    }
    at += static_cast<Eigen::Index>(e.parameters.size());
  }
  for (const auto& line : detail::hum_of_plucks(data, fit)) detail::take_out_line(recorded, line, scene, gain, delay_s, rate_Hz);
  if (const double c = scene.crosstalk; c != 0)
    for (std::size_t i = 0; i < recorded[0].size(); ++i) {
      const double near = recorded[0][i] / gain[0], far = recorded[1][i] / gain[1];
      recorded[0][i] = gain[0] * (near - c * far) / (1 - c * c);
      recorded[1][i] = gain[1] * (far - c * near) / (1 - c * c);
    }
  for (std::size_t c = 0; c < 2; ++c) {
    sensor_response sensor = scene.sensors[c];
    sensor.delay_s -= scene.sensors[0].delay_s;  // the near channel's clock counts
    if (sensor.corner_Hz > 0) restore_ac_coupled(std::span(recorded[c]), sensor.corner_Hz, rate_Hz);
    sensor.corner_Hz = 0;
    if (sensor.resonance_Hz > 0 || sensor.delay_s != 0) detail::divide_by_sensor(recorded[c], sensor, rate_Hz, edge_Hz);
  }
}
ROSIN_INSTANTIATE(void undo_sensors(const scene_data&, const scene_fit&, std::array<std::vector<double>, 2>&,
                                    const std::array<double, 2>&, double, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
