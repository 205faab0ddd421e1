// SPDX-License-Identifier: MIT
//
// A rig in which physics is hidden: drawn from a seed, simulated step by step, written as a folder that owns up to none of it.
//
#pragma once

#include "provenance.hpp"

#include <rosin/simulate/burdened_sensors.hpp>
#include <rosin/simulate/burdened_take.hpp>
#include <rosin/simulate/random_rig.hpp>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace tool {

/// One effect that is there and not owned up to.
struct hidden_effect {
  std::string name;
  std::string end, channel;  ///< "near", "far" or empty
  std::map<std::string, double> parameters;
};

struct challenge_rig {
  std::string name;
  rosin::random_rig base;  ///< string, notebook, gains, plain takes
  std::vector<hidden_effect> effects;
  rosin::modal_rig bowed;  ///< the string as it is under the bow
  rosin::string_burden burden;
  rosin::sensor_faults faults;
  rosin::yielding_rod rod;
  std::array<rosin::converter, 2> converters;
  double release_duration_s = 0, contact_width_m = 0;
  double detuning = 0, pluck_angle_rad = 0, sensor_angle_rad = 0;
  double ripple_Hz = 0, speed_ripple = 0, force_ripple = 0;
  double bristles_N_m = 0;  ///< elasto-plastic friction
  bool declares_stiffness = true, declares_torsion = true;
};

struct challenge_choice {
  std::uint64_t seed = 1;
  int effects = 1;           ///< 0 to 2
  double strength = 1;       ///< 1: as strong as in a bad laboratory
  double noise_dB = 0;       ///< 0: drawn; else peak of the loudest pluck over the noise's standard deviation
  std::string only;          ///< this effect and no other
};

/// Names that can be hidden, in the order of the catalogue.
[[nodiscard]] const std::vector<std::string>& hideable();
/// And these, where they are asked for.
[[nodiscard]] const std::vector<std::string>& hideable_on_request();
[[nodiscard]] challenge_rig draw_challenge(const challenge_choice& choice);
/// Plays all takes and writes folder/rig.toml with its recordings; a reason if that cannot be done.
[[nodiscard]] std::optional<rosin::failure> write_challenge(const challenge_rig& rig, const std::filesystem::path& folder, bool force);
[[nodiscard]] json truth_of(const challenge_rig& rig);

}  // namespace tool
