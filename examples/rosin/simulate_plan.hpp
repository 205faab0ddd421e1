// SPDX-License-Identifier: MIT
//
// From a rig file to the rig that is simulated: what really is, as against what the file declares. Gains and the strength of
// the wires are drawn within their tolerances; with [simulate] nominal_scatter the string and the place of the contact
// as well. Every number drawn has a random source of its own, made of the seed and its name: a take more or less
// does not change the others.
//
#pragma once

#include "simulate_friction.hpp"

#include <rosin/simulate/burdened_signals.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/profiled_rod.hpp>

namespace tool {

/// A channel of the recordings as it is. Recorded value = gain times true value, by the declared scale.
struct true_channel {
  rosin::sensor_channel declared;
  double gain = 1;
  double noise_share = 0;  ///< standard deviation of the noise / full scale
  std::vector<rosin::hum_line> hum{};
};

/// As the rig file has it, unsteady.
struct moving_rod : rosin::profiled_rod {
  double ripple_Hz = 0, speed_ripple = 0, force_ripple = 0;  ///< relative
  [[nodiscard]] rosin::rod_state operator()(double t) const noexcept;
};

struct true_take {
  rosin::take declared;
  double position = 0;
  rosin::modal_pluck pluck{};        ///< kind pluck
  moving_rod rod{};                  ///< kind bow
  std::array<double, 2> offset_N{};  ///< of the two forces, as recorded
};

struct simulation_plan {
  rosin::modal_rig rig{};
  rosin::rig_burden burden{};        ///< terminations that move, and what a diagnosis has found
  double tension_drift = 0;          ///< tension in the bowed takes / in the others - 1
  std::vector<std::string> effects;  ///< of a diagnosis
  chosen_friction friction{};
  std::vector<true_channel> channels;  ///< by index
  std::vector<true_take> takes;
  rosin::modal_settings settings{};
  double duration_s = 0.36, noise_N = 3e-4;
  int bits = 16;  ///< 0: float
  std::uint64_t seed = 1;
  std::vector<std::string> assumed, notes;
};

/// Fails where the rig file asks for something that cannot be simulated; `seed` overrides the rig file's.
[[nodiscard]] rosin::outcome<simulation_plan> plan_simulation(const rosin::rig& rig, std::optional<std::uint64_t> seed);

/// The same string under another tension.
[[nodiscard]] rosin::modal_rig stretched(rosin::modal_rig rig, double tension_drift);

/// The random source that belongs to a seed and a name.
[[nodiscard]] std::uint64_t seed_for(std::uint64_t seed, const std::string& name);

}  // namespace tool
