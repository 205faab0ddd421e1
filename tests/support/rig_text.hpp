// SPDX-License-Identifier: MIT
//
// A rig file in which every table and nearly every key occurs, and what the reader says of it when one thing is changed.
//
#pragma once

#include <rosin/adapt/rig_toml.hpp>

#include <string>
#include <string_view>

namespace test {

inline constexpr std::string_view rig_text = R"(schema = 1
title = "E string, glass rod, run 12"

[string]
length_m = 0.314
tension_N = 72.5
fundamental_Hz = 660
bending_stiffness_Nm2 = 4.7e-5
impedance_Ns_m = 0.175
quality = 1000

[channels]
near = { index = 0, newtons_per_full_scale = 1.65, gain_tolerance = 0.05 }
far  = { index = 1, newtons_per_full_scale = 1.96, ac_coupled_Hz = 0.5 }
magnet = { index = 2, quantity = "string-velocity", position = 0.30 }
sled = { index = 4, quantity = "bow-speed", metres_per_second_per_full_scale = 1 }

[contact]
position = 0.30

[torsion]
speed_ratio = 7.0
impedance_ratio = 3.5
q = 15

[terminations]
near = "fit"
far = { modes = [ { frequency_Hz = 460, q = 35, mass_kg = 0.12 } ] }

[model]
physics = ["bending-stiffness", "torsion"]
friction = "velocity-curve"

[friction]
constant = 0.35
terms = [ { coefficient = 0.4, speed_m_s = 0.01 }, { coefficient = 0.45, speed_m_s = 0.1 } ]

[simulate]
rate_Hz = 128000
duration_s = 0.5
bits = 16
noise_N = 3e-4
seed = 1

[[take]]
name = "pluck-1"
kind = "pluck"
file = "pluck-1.wav"
force_N = 1.0
force_tolerance = 0.03
contact_position = 0.25

[[take]]
name = "quiet"
kind = "quiet"
file = "quiet.wav"

[[take]]
name = "bow-1"
kind = "bow"
file = "bow-1.wav"
speed_m_s = 0.20
normal_force_N = 0.30
speed_profile_m_s = [[0, 0], [0.02, 0.2]]
hold_out = true
)";

/// The text with the first occurrence of one piece replaced.
inline std::string changed(std::string_view from, std::string_view to, std::string_view text = rig_text) {
  std::string out{text};
  const auto at = out.find(from);
  return at == std::string::npos ? "THE TEST IS WRONG: no " + std::string{from} : out.replace(at, from.size(), to);
}

/// One change to the rig file, and what has to be said of it: the whole message.
struct bad_key {
  std::string_view from, to, message;
};

inline std::string problems_of(std::string_view text) { return rosin::parse_rig(text, "rig.toml").error(); }

}  // namespace test

/// One check a row, so that a failure shows the row.
#define CHECK_BAD_KEYS(rows)                                                  \
  for (const auto& row : rows) {                                              \
    CAPTURE(row.from);                                                        \
    CAPTURE(row.to);                                                          \
    CHECK(test::problems_of(test::changed(row.from, row.to)) == row.message); \
  }
