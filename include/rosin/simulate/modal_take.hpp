// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a simulated take consists of, and how finely it is computed. Sample n of every signal belongs to the
// instant n / sample_rate_Hz, and every signal has been through the same low-pass without delay.
//
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <rosin/simulate/modal_low_pass.hpp>
#include <rosin/simulate/modal_string.hpp>
#include <rosin/simulate/stroke_energy.hpp>

namespace rosin {

/// Fineness of the simulation. Zero for an edge of the low-pass: 0.43 and 0.5 of the sample rate.
struct modal_settings {
  double sample_rate_Hz = 128000;
  int oversampling = 8;          ///< steps of the contact per sample
  double mode_limit_Hz = 250e3;  ///< modes above it answer quasi-statically
  double pass_Hz = 0;
  double stop_Hz = 0;
  double ripple = 1e-5;

  [[nodiscard]] modal_low_pass low_pass() const {
    return {pass_Hz > 0 ? pass_Hz : 0.43 * sample_rate_Hz, stop_Hz > 0 ? stop_Hz : 0.5 * sample_rate_Hz, ripple};
  }
};

/// What the sensors would record, in newtons before any gain or noise, and the truth beside it.
struct modal_take {
  double sample_rate_Hz = 0;
  std::vector<double> force_near_N{};          ///< of the string on the near termination
  std::vector<double> force_far_N{};           ///< of the string on the far termination
  std::vector<double> contact_force_N{};       ///< of rod or wire on the string
  std::vector<double> centre_velocity_m_s{};   ///< of the string's centre line at the contact
  std::vector<double> torsion_velocity_m_s{};  ///< of its surface by torsion; the surface moves with the sum
  std::vector<double> rod_velocity_m_s{};      ///< bowed takes only
  std::vector<double> temperature_rise_K{};    ///< of the contact, where the friction law has one
  std::size_t unconverged = 0;                 ///< steps whose contact equation was not solved to tolerance
  std::size_t slips = 0;                       ///< times the contact went from sticking to slipping
  double slipping = 0;  ///< share of the steps that slipped of the second half, or of that up to where the rod was lifted; 0 to 1
  std::optional<stroke_energy> energy{};  ///< of strokes, where it was asked for

  [[nodiscard]] std::size_t size() const noexcept { return force_near_N.size(); }
};

/// What a bowed string does once the start is over.
enum class bowed_motion { sticking, stick_slip, sliding };

/// By the second half of the take (of the stroke, if the rod was lifted): no slip at all, both, or hardly any sticking.
[[nodiscard]] inline bowed_motion motion_of(const modal_take& take) noexcept {
  if (!(take.slipping > 0)) return bowed_motion::sticking;
  return take.slipping < 0.95 ? bowed_motion::stick_slip : bowed_motion::sliding;
}

/// The first thing about the rig that cannot be simulated; empty if nothing.
[[nodiscard]] inline std::string problem_with(const modal_rig& rig, double position) {
  const auto& s = rig.string;
  if (!(s.length_m > 0 && s.tension_N > 0 && s.fundamental_Hz > 0)) return "string: length, tension and pitch must be above 0";
  if (!(s.bending_stiffness_Nm2 >= 0)) return "string: bending stiffness must be 0 or above";
  if (!(s.loss.inverse_q(s.fundamental_Hz) >= 0 && s.loss.inverse_q(s.fundamental_Hz) < 1)) return "string: Q must be above 1";
  if (rig.torsion.present() && !(rig.torsion.quality > 1)) return "torsion: Q must be above 1";
  if (!(position > 0 && position < 1)) return "contact: position must lie between 0 and 1";
  return {};
}

/// The same for a take's length.
[[nodiscard]] inline std::string problem_with_duration(double duration_s, const modal_settings& s) {
  const double samples = duration_s * s.sample_rate_Hz;
  if (!(samples >= 1 && samples * s.oversampling <= 1e9)) return "take: it must last for a sample, and for 1e9 steps at most";
  return {};
}

/// The same for the settings.
[[nodiscard]] inline std::string problem_with(const modal_settings& s) {
  if (!(s.sample_rate_Hz > 0 && s.oversampling >= 1)) return "settings: sample rate and oversampling must be above 0";
  const auto filter = s.low_pass();
  if (!(filter.pass_Hz() < filter.stop_Hz())) return "settings: the low-pass must pass below where it stops";
  if (!(s.mode_limit_Hz >= filter.stop_Hz())) return "settings: the modes must reach to the low-pass' stop";
  return {};
}

}  // namespace rosin
