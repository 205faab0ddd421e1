// tier: hosted
// SPDX-License-Identifier: MIT
//
// Bowed takes without what the sensors did to them, once plucks have told what that is: each channel's own response divided out
// in the frequency domain, crosstalk inverted, mains hum taken out, a curved characteristic straightened, another clock's samples
// read at the instants of the first. Recorded nominal newtons in and out. Effects on the string itself are not undone here.
//
#pragma once

#include <rosin/diagnose/scene_fit.hpp>
#include <rosin/diagnose/sensor_chain.hpp>

namespace rosin {

namespace detail {

/// Least-squares fit of harmonics of the mains, taken out. Weighed by a Hann window: what the string plays leaks little into it.
inline void take_out_hum(std::vector<double>& x, double frequency_Hz, int harmonics, double rate_Hz) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd basis(n, 2 * harmonics + 1);
  basis.col(2 * harmonics).setOnes();
  for (int h = 0; h < harmonics; ++h)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double turn = 2 * std::numbers::pi * frequency_Hz * (h + 1) * static_cast<double>(i) / rate_Hz;
      basis(i, 2 * h) = std::cos(turn), basis(i, 2 * h + 1) = std::sin(turn);
    }
  Eigen::Map<Eigen::VectorXd> data(x.data(), n);
  const Eigen::ArrayXd turn =
      Eigen::ArrayXd::LinSpaced(n, 0.5, static_cast<double>(n) - 0.5) * (std::numbers::pi / static_cast<double>(n));
  const Eigen::MatrixXd weighed = turn.sin().square().matrix().asDiagonal() * basis;
  Eigen::VectorXd amplitude = (basis.transpose() * weighed).ldlt().solve(weighed.transpose() * data);
  amplitude[2 * harmonics] = 0;
  data -= basis * amplitude;
}

}  // namespace detail

/// Whether nothing sits on the string and its ends are rigid. A second polarisation does not count: the bow moves one of them
/// only.
[[nodiscard]] inline bool string_is_plain(const pluck_guess& known, const std::vector<pluck_effect>& effects) {
  return !known.has_ends() && std::none_of(effects.begin(), effects.end(), [](const pluck_effect& e) {
    return e.at_end || e.name == "point-mass" || e.name == "point-damper";
  });
}

/// In place, near and far.
inline void undo_sensors(const scene_data& data, const scene_fit& fit, std::array<std::vector<double>, 2>& recorded,
                         double rate_Hz, double edge_Hz) {
  const pluck_scene scene = scene_of(data, fit);
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
  if (!scene.hum.empty()) {  // more harmonics than plucks need to tell, but none near what the string itself does
    const double mains_Hz = scene.hum.front().frequency_Hz;
    const int harmonics = std::clamp(static_cast<int>(0.6 * scene.string.fundamental_Hz / mains_Hz), 1, 12);
    for (auto& x : recorded) detail::take_out_hum(x, mains_Hz, harmonics, rate_Hz);
  }
  if (const double c = scene.crosstalk; c != 0)
    for (std::size_t i = 0; i < recorded[0].size(); ++i) {
      const std::array<double, 2> gain{std::exp(fit.value[pluck_layout::gain_near]), std::exp(fit.value[pluck_layout::gain_far])};
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

}  // namespace rosin
