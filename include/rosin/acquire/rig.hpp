// tier: hosted
// SPDX-License-Identifier: MIT
//
// A rig as its owner describes it (rig.toml, schema 1): one string, its terminations, its sensors and the takes
// recorded with them. Nothing is computed here and nothing filled in: a key that was left out is an empty optional.
// What follows from the keys, and which defaults were used for it, stands in rig_values.hpp.
//
// Every tolerance is a limit and is taken as two standard deviations. Those of [string] and of channels and forces are
// relative, that of a position is a fraction of the string's length. Positions count from the near end.
//
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What a channel measures; its SI unit is N, m/s, m, Pa, N, m/s. An unused channel is recorded but holds nothing of use.
enum class quantity { termination_force, string_velocity, string_displacement, sound, normal_force, bow_speed, unused };
inline constexpr std::array quantity_names{"termination-force", "string-velocity", "string-displacement", "sound", "normal-force",
                                           "bow-speed",         "unused"};

enum class take_kind { pluck, quiet, bow };
inline constexpr std::array take_kind_names{"pluck", "quiet", "bow"};

enum class friction_model { velocity_curve, thermal, elasto_plastic };
inline constexpr std::array friction_model_names{"velocity-curve", "thermal", "elasto-plastic"};

[[nodiscard]] inline std::string name_of(quantity what) { return quantity_names.at(static_cast<std::size_t>(what)); }
[[nodiscard]] inline std::string name_of(take_kind what) { return take_kind_names.at(static_cast<std::size_t>(what)); }
[[nodiscard]] inline std::string name_of(friction_model what) { return friction_model_names.at(static_cast<std::size_t>(what)); }

/// [string]
struct string_section {
  double fundamental_Hz = 0;  ///< always there
  std::optional<double> length_m, tension_N, bending_stiffness_Nm2, impedance_Ns_m;
  std::optional<double> diameter_m, density_kg_m3, youngs_modulus_Pa;  ///< of a solid round wire
  std::optional<double> quality, loss_internal_s, loss_air_sqrt_Hz;    ///< see loss_law
  std::optional<double> length_tolerance, tension_tolerance, fundamental_tolerance;
  std::optional<double> bending_stiffness_tolerance, impedance_tolerance;
};

/// One entry of [channels].
struct sensor_channel {
  std::string name;
  int index = 0;       ///< column of the recording; -1 where `column` names it
  std::string column;  ///< of a table, by its name (column = "..." or variable = "..."); empty where `index` tells it
  rosin::quantity quantity = rosin::quantity::termination_force;
  std::optional<double> per_full_scale;  ///< SI units of the quantity at full scale; empty: uncalibrated
  bool scale_assumed = false;            ///< per_full_scale is 1 because tables are in SI units, nobody wrote it
  std::optional<double> gain_tolerance, ac_coupled_Hz, position;
  int line = 0;  ///< of the rig file, for messages
};

/// [files]: what tables of numbers do not tell themselves.
struct files_section {
  std::optional<double> rate_Hz;
  std::optional<int> time_column;  ///< from 0; in s
};

enum class bow_kind { rod, hair };
inline constexpr std::array bow_kind_names{"rod", "hair"};

/// [bow]: what is drawn across the string. All but the kind is part of the declared model where it is given.
struct bow_section {
  bow_kind kind = bow_kind::rod;
  std::optional<double> width_m, tilt;  ///< tilt: 0 even normal force, 1 none at the near edge
  std::optional<double> hair_stiffness_N_m, hair_mass_kg, hair_resistance_Ns_m;  ///< of the whole width
};

/// [torsion]
struct torsion_section {
  double speed_ratio = 0;      ///< torsional / transverse wave speed
  double impedance_ratio = 0;  ///< torsional, referred to the surface / transverse
  double q = 0;
};

struct termination_mode {
  double frequency_Hz = 0, q = 0, mass_kg = 0;
};
struct admittance_point {
  double frequency_Hz = 0, re_m_sN = 0, im_m_sN = 0;
};

/// One end of [terminations].
struct termination {
  enum class form { rigid, fit, modes, table };
  form kind = form::rigid;
  std::vector<termination_mode> modes;       ///< form::modes
  std::string file;                          ///< form::table, as written in the rig file
  std::vector<admittance_point> admittance;  ///< form::table, ascending in frequency
};

/// [model]: what the simulation that is compared with the recordings already contains.
struct model_section {
  std::vector<std::string> physics;  ///< names of the catalogue of effects
  std::optional<friction_model> friction;
};

/// One exponential of a velocity curve: coefficient * exp(-|v| / speed).
struct friction_term {
  double coefficient = 0, speed_m_s = 0;
};

/// [friction]: parameters of the law; which of them are used is the law's affair.
struct friction_section {
  std::vector<friction_term> terms;  ///< mu(v) = constant + sum of the terms
  std::optional<double> constant;
  std::optional<double> contact_radius_m, layer_thickness_m, ambient_C;                    ///< thermal
  std::optional<double> bristle_stiffness_N_m, bristle_damping_Ns_m, break_away_fraction;  ///< elasto-plastic
  std::optional<double> static_coefficient, dynamic_coefficient, stribeck_speed_m_s, viscous_Ns_m;
};

/// Break points (time in s, value) of a profile; straight between them, constant outside.
using profile = std::vector<std::pair<double, double>>;

/// One [[take]].
struct take {
  std::string name;
  take_kind kind = take_kind::quiet;
  std::string file;                                          ///< as written, relative to the rig's folder
  std::optional<double> force_N, force_tolerance, strength;  ///< pluck
  std::optional<double> speed_m_s, normal_force_N;    ///< bow, once steady; empty: a channel measures it (stroke_motion.hpp)
  profile speed_profile_m_s, normal_force_profile_N;  ///< bow, empty where unknown
  profile position_profile;                           ///< bow, empty where it stays at one place of the string
  std::optional<double> contact_position, start_s;    ///< start_s: release or onset, for simulate
  std::optional<double> rate_Hz;                      ///< of a table that does not tell it
  std::optional<std::pair<double, double>> steady_s;  ///< what whoever recorded it called steady: a hint
  bool position_unknown = false;
  bool hold_out = false;  ///< never fitted, only predicted
  int line = 0;           ///< of the rig file, for messages
};

/// [simulate]: how a recording is to be made instead of read.
struct simulate_section {
  std::optional<double> rate_Hz, duration_s, noise_N;
  std::optional<int> bits;  ///< 16, 24 or 32; 0: float
  std::optional<std::int64_t> seed;
  bool nominal_scatter = false;  ///< the true string differs from the declared one, within the tolerances
};

struct rig {
  std::string file, folder;  ///< path of rig.toml and of the folder that holds it
  std::optional<std::string> title;
  string_section string;
  std::vector<sensor_channel> channels;  ///< by index
  std::optional<double> contact_position, position_tolerance;
  std::optional<torsion_section> torsion;
  std::optional<termination> near, far;
  std::optional<model_section> model;
  std::optional<friction_section> friction;
  std::optional<bow_section> bow;  ///< empty: a rigid rod
  files_section files;
  std::optional<simulate_section> simulate;
  std::vector<take> takes;

  [[nodiscard]] const sensor_channel* channel(const std::string& name) const noexcept {
    for (const auto& c : channels)
      if (c.name == name) return &c;
    return nullptr;
  }
  /// A channel that measures this in its SI unit.
  [[nodiscard]] const sensor_channel* channel_of(rosin::quantity what) const noexcept {
    for (const auto& c : channels)
      if (c.quantity == what && c.per_full_scale) return &c;
    return nullptr;
  }
  [[nodiscard]] const take* find_take(const std::string& name) const noexcept {
    for (const auto& t : takes)
      if (t.name == name) return &t;
    return nullptr;
  }
  /// Both terminations carry a force transducer: all that reconstruction needs.
  [[nodiscard]] bool has_both_forces() const noexcept { return channel("near") != nullptr && channel("far") != nullptr; }
  /// Where this take was plucked or bowed; empty where nobody knows, or the bow travels along the string.
  [[nodiscard]] std::optional<double> position_of(const take& t) const noexcept {
    if (t.position_unknown || !t.position_profile.empty()) return std::nullopt;
    return t.contact_position ? t.contact_position : contact_position;
  }
  /// Path of a file named in the rig file.
  [[nodiscard]] std::string path_of(const std::string& relative) const {
    return folder.empty() ? relative : folder + "/" + relative;
  }
};

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
