// tier: hosted
// SPDX-License-Identifier: MIT
//
// Effects of plucks that are not linear, as what has to be taken out of a recording to make it so.
//
// A sensor with output = f + a f^2 is inverted, f = (sqrt(1 + 4 a y) - 1) / (2 a), where it bends: behind its own ringing or
// before it. A string that is stretched by its own motion (stretching_pluck.hpp) is simulated twice, with and without, and the
// difference taken out, as the sensors record it. A sensor that also feels the tension itself records  f + s (1 / 2L) integral
// y'^2 dx:  sums and differences of partials, which players know as phantoms.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_effect.hpp>
#include <rosin/diagnose/sensor_chain.hpp>
#include <rosin/diagnose/stretching_pluck.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// f, where y = f + a f^2.
[[nodiscard]] inline double straightened(double y, double a) { return (std::sqrt(std::max(0.0, 1 + 4 * a * y)) - 1) / (2 * a); }

/// What a channel felt before its high-pass. The lost constant is such that f, where felt = f + a f^2, has no mean in the later
/// half: a string that rings swings about zero. (A bowed one does not: there the curvature is undone about a level that is off by
/// the mean force.)
inline void bring_back_level(std::vector<double>& felt, double a, double corner_Hz, double rate_Hz) {
  restore_ac_coupled(std::span(felt), corner_Hz, rate_Hz);
  const auto later = felt.begin() + static_cast<std::ptrdiff_t>(felt.size() / 2);
  for (int round = 0; round < 3; ++round) {
    double mean = 0;
    for (auto x = later; x != felt.end(); ++x) mean += straightened(*x, a);
    mean /= static_cast<double>(std::max<std::ptrdiff_t>(1, felt.end() - later));
    for (double& x : felt) x -= mean;
  }
}

}  // namespace detail

/// Where a sensor that rings as well is curved.
enum class bending { behind_ringing, before_ringing };

namespace detail {

/// What comes behind the bend of a channel: leakage, high-pass, and the ringing of a sensor that bends first.
[[nodiscard]] inline pluck_scene behind_the_bend(const pluck_scene& scene, std::size_t channel, bending where) {
  pluck_scene behind;
  behind.crosstalk = scene.crosstalk;
  for (std::size_t c = 0; c < 2; ++c) behind.sensors[c].corner_Hz = scene.sensors[c].corner_Hz;
  if (where == bending::before_ringing)
    behind.sensors[channel].resonance_Hz = scene.sensors[channel].resonance_Hz,
    behind.sensors[channel].q = scene.sensors[channel].q;
  return behind;
}

/// A channel as it was there, in newtons; a: of the bend that is to be undone.
[[nodiscard]] inline std::vector<double> at_the_bend(const pluck_take& take, const pluck_scene& behind, std::size_t channel,
                                                     const std::array<double, 2>& gain, double a) {
  const std::vector<double>&own = take.force_N[channel], &other = take.force_N[1 - channel];
  const double leaks = behind.crosstalk;
  std::vector<double> felt(own.size());
  for (std::size_t i = 0; i < felt.size(); ++i)
    felt[i] = (own[i] / gain[channel] - leaks * other[i] / gain[1 - channel]) / (1 - leaks * leaks);
  const sensor_response& sensor = behind.sensors[channel];
  if (sensor.corner_Hz > 0) bring_back_level(felt, a, sensor.corner_Hz, take.rate_Hz);
  if (sensor.resonance_Hz > 0) unring(felt, sensor, take.rate_Hz);
  return felt;
}

}  // namespace detail

/// output = f + a f^2 in one channel. What comes behind that a f^2 passes, too.
template <class Real = double>
pluck_effect sensor_nonlinearity_effect(const string_facts&, int channel, bending where = bending::behind_ringing) {
  pluck_effect e{.name = "sensor-nonlinearity",
                 .place = channel,
                 .parameters = {by_score_steps("quadratic_per_N", -0.6, 0.6, 1e-4)},
                 .starts = {{0}},
                 .strength = -3};
  if (where == bending::before_ringing)
    e.variant = "before it rings", e.beside = channel == 0 ? "sensor-resonance@near" : "sensor-resonance@far";
  e.undo = [channel, where](std::vector<pluck_take>& takes, const pluck_scene& scene, const pluck_layout&,
                            const Eigen::VectorX<Real>& v, double a) {
    const auto own = static_cast<std::size_t>(channel);
    const std::array<double, 2> gain{pluck_layout::gain(v, 0), pluck_layout::gain(v, 1)};
    const pluck_scene behind = detail::behind_the_bend(scene, own, where);
    for (pluck_take& take : takes) {
      const std::vector<double> felt = detail::at_the_bend(take, behind, own, gain, a);
      std::array<std::vector<double>, 2> excess{std::vector<double>(felt.size()), std::vector<double>(felt.size())};
      for (std::size_t i = 0; i < felt.size(); ++i) excess[own][i] = felt[i] - detail::straightened(felt[i], a);
      pass_sensors(excess, behind, take.rate_Hz);
      for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t i = 0; i < felt.size(); ++i) take.force_N[c][i] -= gain[c] * excess[c][i];
    }
  };
  return e;
}
ROSIN_INSTANTIATE(pluck_effect sensor_nonlinearity_effect(const string_facts&, int, bending))

/// Large motion stretches the string. Needs the tension in newtons. The string that rings in the mean is part of the scene; what
/// is taken out is by how much the stretched one differs from it.
template <class Real = double>
pluck_effect tension_modulation_effect(const string_facts& f, const band& limits) {
  pluck_effect e{
      .name = "tension-modulation", .parameters = {{"axial_stiffness_N", 0, 3e6, 20}}, .starts = {{0}}, .strength = -3};
  constexpr double most_periods = 10;
  e.horizon_periods = most_periods;
  const double tension = f.impedance_Ns_m * 2 * f.length_m * f.fundamental_Hz, horizon_s = most_periods / f.fundamental_Hz;
  const auto raised = [=](const pluck_layout& layout, const Eigen::VectorX<Real>& v, std::size_t t, double axial_N) {
    return mean_stretch(layout.string(v), v[layout.position(t)], std::exp(v[layout.at(t, pluck_layout::strength)]) / tension,
                        axial_N / (4 * tension), 0.6 * most_periods);
  };
  e.retune = [=](pluck_scene& s, const pluck_layout& layout, const Eigen::VectorX<Real>& v, std::size_t t, double axial_N) {
    s.string = tightened(s.string, raised(layout, v, t, axial_N));
  };
  e.undo = [=](std::vector<pluck_take>& takes, const pluck_scene& scene, const pluck_layout& layout,
               const Eigen::VectorX<Real>& v, double axial_N) {
    const ringing_string slack = relaxed(scene.string, raised(layout, v, 0, axial_N));  // as other effects make it, at rest
    const nearest_pinned pinned(scene, slack);
    std::vector<string_load> loads;
    for (const scatterer& s : scene.scatterers)
      loads.push_back({pinned.place(s.position), s.resistance, std::max(0.0, s.mass_s)});
    const band all{limits.stop_Hz, limits.stop_Hz};
    const second_plane other{scene.detuning, scene.coupling};
    stretching_pluck string(pinned.string, 0.5, 1, all, 400, other, loads);
    const auto mean_pluck = [&](std::size_t t, double newtons) {
      const nearest_pinned mean(scene, tightened(slack, raised(layout, v, t, axial_N)));
      return stretching_pluck(mean.string, mean.place(v[layout.position(t)]), newtons / tension, all, 400, other);
    };
    for (std::size_t t = 0; t < takes.size(); ++t) {
      const double rate = takes[t].rate_Hz, released = v[layout.at(t, pluck_layout::release)] * rate,
                   newtons = std::exp(v[layout.at(t, pluck_layout::strength)]);
      // on the record's own samples: nothing is interpolated
      const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(released)));
      if (first >= takes[t].force_N[0].size()) continue;
      const std::size_t count =
          std::min(takes[t].force_N[0].size() - first, static_cast<std::size_t>(horizon_s * rate * 1.1) + 8);
      const double wait_s = std::min(1.0, static_cast<double>(first) - released) / rate;
      // of what the hardest plucks have taken out right within 0.02, of all that they are within 3e-4
      const auto steps = static_cast<std::size_t>(std::ceil(120e3 / rate));
      string.pluck_at(pinned.place(v[layout.position(t)]), newtons / tension);
      auto excess = string.run(axial_N / (4 * tension), wait_s, 1 / rate, steps, count);
      // the mean tension exactly, as the scene has it; where loads make it be stepped, by the same steps
      const auto plain = loads.empty() ? mean_pluck(t, newtons).run(0, wait_s, 1 / rate, 1, count)
                                       : string.run(0, wait_s, 1 / rate, steps, count, raised(layout, v, t, axial_N));
      // a channel may have it before the string
      const double early_s = std::max({0.0, -scene.sensors[0].delay_s, -scene.sensors[1].delay_s});
      const std::size_t lead = std::min(first, static_cast<std::size_t>(std::ceil(early_s * rate)));
      for (std::size_t c = 0; c < 2; ++c) {
        for (std::size_t i = 0; i < count; ++i) excess[c][i] -= plain[c][i];
        excess[c].insert(excess[c].begin(), lead, 0.0);
      }
      pass_wire(excess, scene, rate);
      pass_sensors(excess, scene, rate);
      for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t i = 0; i < excess[c].size(); ++i)
          takes[t].force_N[c][first - lead + i] -= newtons * pluck_layout::gain(v, c) * excess[c][i];
    }
  };
  return e;
}
ROSIN_INSTANTIATE(pluck_effect tension_modulation_effect(const string_facts&, const band&))

/// A channel that feels the tension, too: what it reads per unit of strain. The tension is the same all along the string: the
/// partials are below its longitudinal modes.
template <class Real = double>
pluck_effect phantom_partials_effect(const string_facts& f, const band& limits, int channel) {
  const double tension = f.impedance_Ns_m * 2 * f.length_m * f.fundamental_Hz;
  pluck_effect e{.name = "phantom-partials",
                 .place = channel,
                 .parameters = {by_score_steps("sensed_axial_stiffness_N", -3e6, 3e6, 1e-3 * tension)},
                 .starts = {{0}},
                 .strength = -3};
  e.undo = [=](std::vector<pluck_take>& takes, const pluck_scene& scene, const pluck_layout& layout,
               const Eigen::VectorX<Real>& v, double sensed_N) {
    for (std::size_t t = 0; t < takes.size(); ++t) {
      const std::size_t size = takes[t].force_N[0].size();
      const double rate = takes[t].rate_Hz, released = v[layout.at(t, pluck_layout::release)] * rate,
                   newtons = std::exp(v[layout.at(t, pluck_layout::strength)]);
      const auto first = std::min(size, static_cast<std::size_t>(std::max(0.0, std::ceil(released))));
      const nearest_pinned pinned(scene, scene.string);
      const stretching_pluck string(pinned.string, pinned.place(v[layout.position(t)]), newtons / tension,
                                    {limits.stop_Hz, limits.stop_Hz}, 120, {scene.detuning, scene.coupling});
      const std::vector<double> strain =
          string.unstretched_strain(std::min(1.0, static_cast<double>(first) - released) / rate, 1 / rate, size - first);
      std::array<std::vector<double>, 2> felt{std::vector<double>(size), std::vector<double>(size)};
      auto& own = felt[static_cast<std::size_t>(channel)];
      std::fill_n(own.begin(), first, sensed_N * string.held_strain());
      for (std::size_t i = first; i < size; ++i) own[i] = sensed_N * strain[i - first];
      pass_sensors(felt, scene, rate);
      for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t i = 0; i < size; ++i) takes[t].force_N[c][i] -= pluck_layout::gain(v, c) * felt[c][i];
    }
  };
  return e;
}
ROSIN_INSTANTIATE(pluck_effect phantom_partials_effect(const string_facts&, const band&, int))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
