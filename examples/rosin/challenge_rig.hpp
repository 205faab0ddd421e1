// SPDX-License-Identifier: MIT
//
// A rig in which physics is hidden: drawn from a seed, simulated step by step, written as a folder that owns up to none of it.
//
#pragma once

#include "provenance.hpp"

#include <rosin/friction/creep.hpp>
#include <rosin/simulate/burdened_sensors.hpp>
#include <rosin/simulate/burdened_take.hpp>
#include <rosin/simulate/random_rig.hpp>

#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tool {

/// One effect that is there and not owned up to.
struct hidden_effect {
  std::string name;
  std::string end, channel;  ///< "near", "far" or empty
  std::map<std::string, double> parameters;
};

/// Samples that a recorder loses from all channels of one take.
struct lost_samples {
  std::size_t pluck = 0, first = 0, count = 0;
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
  double release_duration_s = 0, pluck_width_m = 0, contact_width_m = 0;
  int contact_places = 2;
  double detuning = 0, pluck_angle_rad = 0, sensor_angle_rad = 0;
  double ripple_Hz = 0, speed_ripple = 0, force_ripple = 0;
  double bristles_N_m = 0;  ///< elasto-plastic friction
  std::optional<rosin::creep_parameters<double>> creeps;
  lost_samples lost;
  bool declares_stiffness = true, declares_torsion = true;
};

struct challenge_choice {
  std::uint64_t seed = 1;
  int effects = 1;                  ///< 0 to 2
  double strength = 1;              ///< 1: as strong as in a bad laboratory
  double noise_dB = 0;              ///< 0: drawn; else peak of the loudest pluck over the noise's standard deviation
  std::vector<std::string> wanted;  ///< these, and of `effects` no others while they are as many
  std::vector<double> pitch_Hz{};   ///< of the strings, lowest and highest; none: 280 to 870
  double loss_scatter = 0;          ///< of ln 1/Q of the modes, each by itself
};

inline double evenly_in_log(rosin::gaussian_source& s, double low, double high) {
  return low * std::pow(high / low, s.uniform());
}
inline double with_sign(rosin::gaussian_source& s, double x) { return s.uniform() < 0.5 ? -x : x; }
inline std::size_t side(rosin::gaussian_source& s) { return s.uniform() < 0.5 ? 0 : 1; }
inline const char* name_of_side(std::size_t c) { return c == 0 ? "near" : "far"; }

/// Anywhere but where the bow is and the very ends.
inline double place(rosin::gaussian_source& s, const challenge_rig& r) {
  for (;;) {
    const double x = s.uniform(0.08, 0.92);
    if (std::abs(x - r.base.position) > 0.04) return x;
  }
}

/// The same effect, or two of which a contact has one.
[[nodiscard]] bool exclude_each_other(const std::string& one, const std::string& other);
/// Names that can be hidden, in the order of the catalogue.
[[nodiscard]] const std::vector<std::string>& hideable();
/// And these, where they are asked for.
[[nodiscard]] const std::vector<std::string>& hideable_on_request();
/// One of these, hidden; nothing if it is none.
[[nodiscard]] std::optional<hidden_effect> hidden_on_request(const std::string& name, challenge_rig& rig,
                                                             rosin::gaussian_source& source, double strength);
[[nodiscard]] challenge_rig draw_challenge(const challenge_choice& choice);
/// Plays all takes and writes folder/rig.toml with its recordings, and the strokes' true_forces unless `truth` is empty; a reason
/// if that cannot be done.
[[nodiscard]] std::optional<rosin::failure> write_challenge(const challenge_rig& rig, const std::filesystem::path& folder,
                                                            bool force, const std::filesystem::path& truth);
/// Where force and velocity under the bow of one stroke are: a table as `rosin compare` reads it.
[[nodiscard]] std::filesystem::path true_forces(const std::filesystem::path& truth, const std::string& rig,
                                                const std::string& take);
[[nodiscard]] json truth_of(const challenge_rig& rig);

}  // namespace tool
