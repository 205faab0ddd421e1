// SPDX-License-Identifier: MIT
//
// Plucks for the tests of diagnosis: of a modal string (nothing of the model that is fitted), or of a scene itself.
//
#pragma once

#include <rosin/calibrate/pluck_fit.hpp>
#include <rosin/diagnose/scene_plucks.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_pluck.hpp>

#include <random>

namespace test {

inline const rosin::modal_rig plucked_rig{.string = {.length_m = 0.314,
                                                     .tension_N = 72.5,
                                                     .fundamental_Hz = 659.69,
                                                     .bending_stiffness_Nm2 = 4.7e-5,
                                                     .loss = {.quality = 900}}};

/// Recorded by 16-bit converters with 0.3 mN of noise.
inline rosin::pluck_take recorded(const rosin::modal_take& made, double force_N, std::uint64_t seed, double ac_coupled_Hz = 0) {
  rosin::pluck_take take;
  take.name = "pluck-" + std::to_string(seed);
  take.rate_Hz = made.sample_rate_Hz;
  take.strength_N = force_N;
  take.position = 0.302;
  const rosin::converter sensor{
      .gain = 1, .newtons_per_full_scale = 1.65, .noise_N = 0.3e-3, .ac_coupled_Hz = ac_coupled_Hz, .bits = 16};
  take.force_N = {rosin::convert(made.force_near_N, take.rate_Hz, sensor, 2 * seed).newtons(),
                  rosin::convert(made.force_far_N, take.rate_Hz, sensor, 2 * seed + 1).newtons()};
  return take;
}
inline rosin::pluck_take modal_pluck(double force_N, std::uint64_t seed, double release_duration_s = 0, double position = 0.3) {
  return recorded(*rosin::simulate_pluck(plucked_rig, {.position = position,
                                                       .force_N = force_N,
                                                       .release_s = 0.004,
                                                       .release_duration_s = release_duration_s,
                                                       .duration_s = 0.06}),
                  force_N, seed);
}

/// Plucks as strong as these, each by made(strength).
inline std::vector<rosin::pluck_take> recorded_plucks(const std::vector<double>& strengths_N, const auto& made) {
  std::vector<rosin::pluck_take> out;
  for (const double force_N : strengths_N) out.push_back(recorded(*made(force_N), force_N, out.size()));
  return out;
}
/// The last of them, set aside.
inline std::vector<rosin::pluck_take> last_of(std::vector<rosin::pluck_take>& takes) {
  std::vector<rosin::pluck_take> out{takes.back()};
  takes.pop_back();
  return out;
}

/// A pluck of a scene, from its own lines: for what has to come back exactly.
inline rosin::pluck_take scene_pluck(const rosin::pluck_layout& layout, const std::vector<rosin::pluck_effect>& effects,
                                     const Eigen::VectorXd& v, std::size_t which, double noise_N, std::uint64_t seed) {
  constexpr double rate = 128000;
  const rosin::scene_plucks model(layout, {0, 0}, effects);
  rosin::pluck_take take;
  take.name = "scene-" + std::to_string(which);
  take.rate_Hz = rate, take.strength_N = 1, take.position = 0.3;
  const std::size_t frames = 8000;
  std::mt19937_64 random{seed};
  std::normal_distribution<double> noise;
  for (auto& x : take.force_N) x.assign(frames, 0.0);
  const auto first = static_cast<std::size_t>(std::ceil(model.release_s(v, which) * rate));
  for (std::size_t part = 0; part < 2; ++part) {
    const std::size_t begin = part == 0 ? 0 : first, end = part == 0 ? first : frames;
    const auto lines = model.lines(v, which, part, static_cast<double>(begin) / rate, {60e3, 63e3}, 160);
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t c = 0; c < 2; ++c)
        for (const auto& line : lines)
          take.force_N[c][i] += (line.residue[c] * std::exp(line.pole * (static_cast<double>(i - begin) / rate))).real();
  }
  for (auto& x : take.force_N)
    for (double& y : x) y += noise_N * noise(random);
  return take;
}

/// Layout and values of two plucks of the string above, and room for the parameters of effects.
inline rosin::pluck_layout two_plucks(const rosin::pluck_options& options) {
  rosin::pluck_take a, b;
  a.name = "scene-0", b.name = "scene-1", a.position = b.position = 0.3;
  return rosin::pluck_layout({a, b}, options);
}
inline Eigen::VectorXd values_of(const rosin::pluck_layout& l, const std::vector<double>& added = {}) {
  Eigen::VectorXd v = Eigen::VectorXd::Zero(l.size() + static_cast<Eigen::Index>(added.size()));
  v[0] = 659.69, v[1] = 6.49e-5, v[2] = 1.0 / 900, v[5] = -1, v[l.position(0)] = 0.301;
  for (std::size_t t = 0; t < 2; ++t) v[l.at(t, 0)] = 0.004 + 1e-6 * static_cast<double>(t), v[l.at(t, 1)] = t == 0 ? 0 : -0.7;
  for (std::size_t i = 0; i < added.size(); ++i) v[l.size() + static_cast<Eigen::Index>(i)] = added[i];
  return v;
}

}  // namespace test
