// SPDX-License-Identifier: MIT
//
// The two halves of a diagnosis: what plucks say of string, ends, wire and sensors; and strokes, reconstructed with that.
//
#pragma once

#include "diagnose_rig.hpp"

#include <rosin/acquire/rig_values.hpp>
#include <rosin/diagnose/contact_effects.hpp>
#include <rosin/diagnose/rattle_effect.hpp>
#include <rosin/diagnose/tension_drift.hpp>
#include <rosin/diagnose/width_and_drift.hpp>
#include <rosin/reconstruct/uncertainty.hpp>

namespace tool {

/// Names in a diagnosis's calibration of what the plucks leave in each channel, rms, in its nominal newtons.
inline constexpr std::array<const char*, 2> channel_noise{"noise_near_N", "noise_far_N"};

/// One bowed take as the plucks' calibration and what they tell of the sensors make it.
struct diagnosed_stroke {
  std::string name;
  double rate_Hz = 0, speed_m_s = 0, normal_force_N = 0;
  rosin::calibration calibration;
  std::array<std::vector<double>, 2> recorded_N, force_N;
  std::vector<double> mean_N, mean_m_s;
  rosin::bow_motion<double> motion;
  rosin::reconstruction_uncertainty sd;
  double force_sd_N = 0, velocity_sd_m_s = 0, delta = 0;  ///< in the middle of the take; Eq. (12)
  double level_sd_N = 0;                                  ///< of the mean force, where it was lost and is estimated
  std::optional<double> own_place{};                      ///< if that is not where the plucks were
  double stretch = 0;                                     ///< by which its motion raises the tension, in the mean, relatively
  bool hold_out = false;                                  ///< never fitted, only predicted
};

/// The plucks to fit and to keep aside, what is known before, and what the declared model already holds.
struct plucks_to_diagnose {
  std::vector<rosin::pluck_take> takes, held;
  rosin::pluck_guess guess;
  rosin::pluck_options options;
  std::vector<std::string> warnings;
  bool marked = true;  ///< the rig file says what is held out; else it is the last of several
};
[[nodiscard]] rosin::outcome<plucks_to_diagnose> plucks_of(const rosin::rig& rig, const rosin::rig_values& values,
                                                           provenance& from);

/// What the plucks tell; where one of them contradicts the others, `odd` holds that one and what these tell.
struct plucks_told {
  rosin::pluck_diagnosis found;
  std::optional<rosin::odd_pluck> odd;

  [[nodiscard]] const rosin::pluck_diagnosis& sound() const { return odd ? odd->others : found; }
};
[[nodiscard]] rosin::outcome<plucks_told> diagnose_plucks_of(const rosin::rig& rig, const rosin::rig_values& values,
                                                             provenance& from, std::vector<std::string>& warnings,
                                                             const std::vector<std::string>& without = {}, int threads = 1);

/// A pluck that contradicts the others is what the diagnosis then is about; true if what makes it odd is found, and the catalogue
/// knows it by name. An obstacle is looked for where the string's impedance is known.
bool add_odd(const rosin::odd_pluck& odd, const rosin::rig_values& values, const std::function<bool(const char*)>& knows,
             rig_diagnosis& d);
/// Samples that the checks found lost in any take; such a take is in no fit.
void name_dropouts(const rosin::rig& rig, const rosin::pluck_diagnosis& plucks, provenance& from, rig_diagnosis& d);
/// How far from its declared place (fraction of the length) a pluck may be found without a word.
[[nodiscard]] double tolerated_offset(const rosin::rig_values& values);
/// What had to be taken for granted of the plucks besides what the rig file declares.
void assume_of_plucks(const rosin::pluck_diagnosis& plucks, rig_diagnosis& d);
/// Plucks that were made clearly elsewhere than declared.
void name_pluck_position(const rosin::rig_values& values, const rosin::pluck_diagnosis& plucks, rig_diagnosis& d);

/// Bowed takes (all, or the one named) with the string, the ends and the sensors that the plucks tell of; what cannot be used is
/// said in `warnings`. Band: as given, or 0.30 to 0.45 of the sampling rate.
[[nodiscard]] std::vector<diagnosed_stroke> reconstruct_strokes(const rosin::rig& rig, const rosin::rig_values& values,
                                                                const rosin::pluck_diagnosis& plucks, double tension_drift,
                                                                provenance& from, std::vector<std::string>& warnings,
                                                                const std::string& only = {},
                                                                std::optional<rosin::band> band = {});
/// Eq. (12) as noise alone makes it.
[[nodiscard]] double parting_by_noise(const diagnosed_stroke& s);
/// Force and motion of a stroke under a contact of some width, in place of a point's: those of both its places, up to the
/// frequency that is returned; the versions part as a point's do. Nothing is changed where the string's length is unknown.
[[nodiscard]] std::optional<double> see_as_wide(const rosin::rig& rig, const rosin::pluck_diagnosis& plucks, double width_m,
                                                diagnosed_stroke& s);
[[nodiscard]] rosin::tension_drift drift_of(const std::vector<diagnosed_stroke>& strokes, const rosin::pluck_diagnosis& plucks);
/// The mean force that AC-coupled sensors lost, as far as friction is usually known, put into what the strokes are examined with.
void add_lost_levels(const rosin::rig& rig, const rosin::pluck_diagnosis& plucks, std::vector<diagnosed_stroke>& strokes);
/// E A of a string that its motion stretches, as the plucks tell it; 0 where it is not stretched.
[[nodiscard]] double axial_stiffness_of(const rosin::pluck_diagnosis& plucks);
/// Nothing sits on the string and its ends are rigid, as far as plucks tell.
[[nodiscard]] bool is_plain(const rosin::pluck_diagnosis& plucks);
/// The contact as the rig file declares it.
[[nodiscard]] rosin::contact_model declared_contact(const rosin::rig& rig);
/// What is said of rods that are still gathering speed, and of bows that are set on late or taken off early.
[[nodiscard]] std::vector<std::string> approaches_of(const rosin::rig& rig, const std::vector<diagnosed_stroke>& strokes,
                                                     const rosin::pluck_diagnosis& plucks);
[[nodiscard]] rosin::contact_findings contact_of(const rosin::rig& rig, const std::vector<diagnosed_stroke>& strokes,
                                                 const rosin::pluck_diagnosis& plucks, const rosin::contact_model& model);
/// A width and a drift of the tension at once, where the strokes' versions part and torsion is declared.
[[nodiscard]] std::optional<rosin::width_and_drift> width_and_drift_of(const rosin::rig& rig,
                                                                       const std::vector<diagnosed_stroke>& strokes,
                                                                       const rosin::pluck_diagnosis& plucks);

/// One effect of the contact after the other, under strokes whose tension is the plucks' times 1 + tension_drift; true if the
/// contact is as the model then has it. Where one was found in what sticks, that has to move by at most half of what it did, or
/// by no more than the reconstruction leaves unsure; else none is named. `held`: strokes that are only predicted: what was found in
/// the others is judged by them.
bool examine_contact(const rosin::rig& rig, const std::vector<diagnosed_stroke>& strokes,
                     const std::vector<diagnosed_stroke>& held, const rosin::pluck_diagnosis& plucks, double tension_drift,
                     const std::vector<std::string>& without, rig_diagnosis& d);

}  // namespace tool
