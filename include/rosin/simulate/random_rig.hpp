// tier: hosted
// SPDX-License-Identifier: MIT
//
// Rigs drawn at random, for proofs on more than one string: a violin's E string and its neighbours, force sensors whose
// sensitivity is off by a few per cent, and a laboratory notebook whose values are off as such values are. A seed
// means the same rig everywhere. Everything that is off is drawn from a normal distribution cut at two
// standard deviations; everything else evenly from its range.
//
#pragma once

#include <array>
#include <string>
#include <variant>

#include <rosin/friction/thermal_plastic.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/friction/yield_curve_design.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_pluck.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What the notebook says of a rig.
struct declared_rig {
  string_parameters string{};  ///< its loss is not declared
  modal_torsion torsion{};
  double position = 0;
  std::array<double, 3> pluck_N{1.0, 0.5, 0.75};
};

/// A rig as it is, and as it is declared.
struct random_rig {
  std::uint64_t seed = 0;
  modal_rig rig{};
  double position = 0;
  two_exponential_curve<double> steady_friction{};  ///< measured in steady sliding, whichever law acts
  std::variant<velocity_curve<two_exponential_curve<double>>, thermal_plastic<double>> law{};
  std::array<modal_pluck, 3> plucks{};
  std::array<steady_rod, 2> strokes{};
  double stroke_s = 0.36;
  std::array<double, 2> gain{1, 1};  ///< near, far: true over declared sensitivity
  double noise_N = 0;
  double peak_share = 0.7;  ///< loudest sample of all takes / full scale
  int bits = 16;
  declared_rig declared{};

  [[nodiscard]] bool thermal() const noexcept { return law.index() == 1; }
};

namespace detail {

/// Relative or absolute error of a declared value: normal, no more than two standard deviations.
[[nodiscard]] inline double slip_of_the_pen(gaussian_source& source, double standard_deviation) {
  double error = source();
  while (std::abs(error) > 2) error = source();
  return error * standard_deviation;
}

inline void draw_string(random_rig& r, gaussian_source& source) {
  r.rig.string = {.length_m = source.uniform(0.30, 0.335),
                  .tension_N = source.uniform(60, 80),
                  .fundamental_Hz = source.uniform(590, 700),
                  .bending_stiffness_Nm2 = source.uniform(3.5e-5, 6.5e-5),
                  .loss = {.quality = source.uniform(800, 1500)}};
  r.rig.torsion = {source.uniform(6.4, 7.9), source.uniform(2.9, 4.1), source.uniform(12, 20)};
  r.position = source.uniform(0.1, 0.4);
}

/// A velocity curve or, with even chances, the thermal law that shows the same curve in steady sliding.
inline void draw_friction(random_rig& r, gaussian_source& source) {
  r.steady_friction = {source.uniform(0.3, 0.45), source.uniform(0.01, 0.03), source.uniform(0.35, 0.5),
                       source.uniform(0.08, 0.2), source.uniform(0.3, 0.4)};
  r.law = velocity_curve<two_exponential_curve<double>>{r.steady_friction};
  const bool thermal = source.uniform() < 0.5;
  const contact_heat_parameters<double> heat{.layer_m = source.uniform(1e-6, 5e-6),
                                             .area_per_newton_m2 = source.uniform(0.7e-7, 1.5e-7)};
  if (!thermal) return;
  const auto strength = design_yield_curve(r.steady_friction, heat.without_string(), r.strokes[0].normal_force_N);
  if (strength) r.law = thermal_plastic<double>{*strength, heat};
}

inline void draw_takes(random_rig& r, gaussian_source& source) {
  for (std::size_t i = 0; i < r.plucks.size(); ++i)
    r.plucks[i] = {.position = r.position,
                   .force_N = r.declared.pluck_N[i] * (1 + slip_of_the_pen(source, 0.015)),
                   .release_s = source.uniform(0.0040, 0.0042)};
  for (auto& stroke : r.strokes)
    stroke = {.speed_m_s = source.uniform(0.1, 0.3),
              .normal_force_N = source.uniform(0.25, 0.5),
              .rise_s = source.uniform(0.005, 0.02)};
}

inline void draw_notebook(random_rig& r, gaussian_source& source) {
  r.declared.string = r.rig.string;
  r.declared.string.loss = {};
  r.declared.string.tension_N *= 1 + slip_of_the_pen(source, 0.01);
  r.declared.string.fundamental_Hz *= 1 + slip_of_the_pen(source, 0.001);
  r.declared.string.length_m += slip_of_the_pen(source, 0.0003);
  r.declared.string.bending_stiffness_Nm2 *= 1 + slip_of_the_pen(source, 0.02);
  r.declared.torsion = r.rig.torsion;
  r.declared.position = r.position + slip_of_the_pen(source, 0.002);
  for (auto& g : r.gain) g = 1 + slip_of_the_pen(source, 0.02);
  r.noise_N = source.uniform(0.3e-3, 0.5e-3);
  r.peak_share = source.uniform(0.6, 0.9);
}

}  // namespace detail

/// The rig that belongs to a seed.
[[nodiscard]] inline random_rig draw_rig(std::uint64_t seed) {
  random_rig r{.seed = seed};
  gaussian_source source{seed};
  detail::draw_string(r, source);
  detail::draw_takes(r, source);
  detail::draw_friction(r, source);
  detail::draw_notebook(r, source);
  return r;
}

/// A take of a rig, with the truth that goes with it.
struct recorded_take {
  std::string name{};  ///< pluck-1 ... pluck-3, bow-1, bow-2
  bool bowed = false;
  modal_take truth{};
  std::array<converted_channel, 2> channels{};  ///< near, far

  /// A bowed take in which the string does not slip shows nothing of friction.
  [[nodiscard]] bool usable() const noexcept { return !bowed || motion_of(truth) == bowed_motion::stick_slip; }
};

struct rig_recordings {
  double sample_rate_Hz = 0;
  std::vector<recorded_take> takes{};
};

namespace detail {

/// One range for each channel in all takes, as a laboratory sets it.
inline void convert_takes(const random_rig& r, rig_recordings& recordings) {
  for (std::size_t c = 0; c < 2; ++c) {
    const auto force = [c](const recorded_take& t) {
      return std::span<const double>{c == 0 ? t.truth.force_near_N : t.truth.force_far_N};
    };
    double peak = 0;
    for (const auto& take : recordings.takes)
      for (const double f : force(take)) peak = std::max(peak, std::abs(r.gain[c] * f));
    const converter channel{
        .gain = r.gain[c], .newtons_per_full_scale = peak / r.peak_share, .noise_N = r.noise_N, .bits = r.bits};
    for (std::size_t i = 0; i < recordings.takes.size(); ++i) {
      auto& take = recordings.takes[i];
      take.channels[c] = convert(force(take), recordings.sample_rate_Hz, channel, r.seed * 1000 + 10 * i + c);
    }
  }
}

}  // namespace detail

/// Plays and records all takes of a rig.
[[nodiscard]] inline outcome<rig_recordings> record(const random_rig& r, const modal_settings& settings = {}) {
  rig_recordings recordings{.sample_rate_Hz = settings.sample_rate_Hz};
  for (std::size_t i = 0; i < r.plucks.size(); ++i) {
    auto take = simulate_pluck(r.rig, r.plucks[i], settings);
    if (!take) return failure{take.error()};
    recordings.takes.push_back({"pluck-" + std::to_string(i + 1), false, *std::move(take), {}});
  }
  for (std::size_t i = 0; i < r.strokes.size(); ++i) {
    const modal_stroke stroke{.position = r.position, .duration_s = r.stroke_s};
    auto take = std::visit([&](const auto& law) { return simulate_stroke(r.rig, law, r.strokes[i], stroke, settings); }, r.law);
    if (!take) return failure{take.error()};
    recordings.takes.push_back({"bow-" + std::to_string(i + 1), true, *std::move(take), {}});
  }
  detail::convert_takes(r, recordings);
  return recordings;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
