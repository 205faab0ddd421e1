// tier: hosted
// SPDX-License-Identifier: MIT
//
// How finely a travelling-wave simulation is computed, and what of a rig it cannot do. The contact is solved at
// oversampling times the sample rate. The string's echoes run at a divisor of that rate, because they need no more than
// `band_Hz`: above it waves leave the contact and do not come back.
//
#pragma once

#include <string>

#include <rosin/simulate/modal_take.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct wave_settings {
  double sample_rate_Hz = 128000;   ///< of what comes out
  int oversampling = 8;             ///< steps of the contact per sample
  double band_Hz = 90e3;            ///< waves up to here return from the ends
  double pass_Hz = 0, stop_Hz = 0;  ///< of the low-pass before the samples; 0: 0.43 and 0.5 of the sample rate
  double ripple = 1e-5;

  [[nodiscard]] double step_s() const noexcept { return 1 / (sample_rate_Hz * oversampling); }
  /// The same samples from the modal reference.
  [[nodiscard]] modal_settings as_modal(double mode_limit_Hz = 250e3) const noexcept {
    return {sample_rate_Hz, oversampling, mode_limit_Hz, pass_Hz, stop_Hz, ripple};
  }
  [[nodiscard]] modal_low_pass low_pass() const { return as_modal().low_pass(); }
};

/// The first thing about the settings that cannot be; empty if nothing.
[[nodiscard]] inline std::string problem_with(const wave_settings& s) {
  if (!(s.sample_rate_Hz > 0 && s.oversampling >= 1)) return "settings: sample rate and oversampling must be above 0";
  const auto filter = s.low_pass();
  if (!(filter.pass_Hz() < filter.stop_Hz())) return "settings: the low-pass must pass below where it stops";
  if (!(s.band_Hz > 0)) return "settings: the band of the waves must be above 0";
  return {};
}

/// The same for the contact on a rig, beyond what problem_with(rig, position) says.
[[nodiscard]] inline std::string problem_with_contact(const modal_rig& rig, double position, const wave_settings& s) {
  const double f0 = rig.string.fundamental_Hz, rate = s.sample_rate_Hz * s.oversampling;
  if (!(4 * f0 < rate)) return "settings: the string's pitch is too high for the rate of the steps";
  const double bend = std::sqrt(rig.string.bending_stiffness_Nm2 / rig.string.tension_N);
  const double nearest = std::min(position, 1 - position) * rig.string.length_m;
  if (nearest < 2 * bend)
    return "contact: so near an end that the string bends rather than swings there; 2 sqrt(B / T) is the least distance";
  const double transit = nearest / rig.string.wave_speed_m_s() * rate;
  if (transit < 3) return "contact: the nearer end is less than three steps away; raise the rate or move the contact";
  return {};
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
