// SPDX-License-Identifier: MIT
//
// One bowed take of a rig turned into force and velocity under the bow, with everything that is to be said about it.
//
#pragma once

#include "calibration_file.hpp"
#include "corrected_model.hpp"
#include "reconstruct_process.hpp"

#include <rosin/calibrate/free_decay.hpp>
#include <rosin/condition/ac_coupling.hpp>
#include <rosin/reconstruct/dc_level.hpp>
#include <rosin/reconstruct/stroke_doubts.hpp>
#include <rosin/torsion/torsion_response.hpp>

namespace tool {

struct take_options {
  double pass_Hz = 0, stop_Hz = 0;  ///< 0: the default
  bool fine_tune = true, paper = false, frequency_domain = false;
  std::optional<corrected_model> model{};  ///< of a diagnosis
};

/// A further channel against the result.
struct channel_comparison {
  std::string channel, what;
  double scale = 1, delta = 0, correlation = 0;  ///< channel = scale * result, Eq. (12) after that
};

struct take_reconstruction {
  std::string rig, take, title;
  double rate_Hz = 0, sampled_s = 0;
  rosin::band limits{0, 0};
  take_options how;
  calibration_set calibration;
  rosin::calibration before;  ///< fine tuning
  processed result;
  /// What goes into the file, as long as the take, NaN where unknown: of the domain that was asked for.
  std::vector<double> force_N, velocity_m_s, force_near_N, force_far_N, velocity_near_m_s, velocity_far_m_s, force_sd_N,
      velocity_sd_m_s;
  std::vector<double> torsion_m_s;  ///< empty where [torsion] is not declared
  rosin::sample_range known{0, 0};
  double delta_force = 0, delta_velocity = 0;
  std::optional<double> domains_differ;  ///< Delta between time and frequency domain, where both are known
  std::vector<double> rod_m_s;           ///< empty where the speed is unknown; from the sled's channel where there is one
  std::string rod_from, normal_from;
  std::optional<double> normal_force_N;
  bool ac_coupled = false;
  rosin::dc_estimate dc;
  std::string dc_from;                     ///< "thermal-law" or "usual-friction"
  std::optional<std::size_t> lifted;       ///< sample from which on the bow is off
  std::optional<rosin::free_decay> decay;  ///< of the string after that
  std::vector<std::pair<std::size_t, std::size_t>> slips;
  std::size_t steady_begin = 0, steady_end = 0;  ///< where the motion is most nearly periodic
  double period_s = 0;
  std::vector<channel_comparison> comparisons;
  std::vector<double> magnet_m_s;  ///< of a channel that measures the velocity at the contact, scaled to the result
  std::vector<std::string> assumed, warnings;
  bool contradicts_itself = false;  ///< some of the warnings say what cannot be so

  [[nodiscard]] double time_s(std::size_t i) const { return static_cast<double>(i) / rate_Hz; }
  /// What is known while the bow is on.
  [[nodiscard]] rosin::sample_range bowed() const { return {known.begin, std::min(known.end, lifted.value_or(known.end))}; }
  [[nodiscard]] double slips_per_period() const;
};

[[nodiscard]] rosin::outcome<take_reconstruction> reconstruct_take(const rosin::rig& rig, const rosin::take& take,
                                                                   const checked_take& read, const calibration_set& calibration,
                                                                   const take_options& how);

/// The level that AC-coupled sensors lost: by a fitted law of friction where that knows zero, otherwise by what friction usually
/// is.
void estimate_level(const rosin::rig& rig, take_reconstruction& r);

/// Whether the bow was lifted, and what the string's free decay after that says of pitch and loss.
void find_free_decay(take_reconstruction& r);
/// The same in a sentence; how far the pitch is from the plucks', in cents, and how sure that is.
[[nodiscard]] std::string decay_text(const take_reconstruction& r);
[[nodiscard]] json decay_json(const take_reconstruction& r);

/// The table of the format "reconstruction", with its comment lines.
[[nodiscard]] rosin::table table_of(const take_reconstruction& r, const provenance& from);
[[nodiscard]] json to_json(const take_reconstruction& r, const provenance& from);
/// What was found, line by line: what it is, what it came to.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> facts_of(const take_reconstruction& r);
/// What counts as slipping.
[[nodiscard]] std::string slipping_means(const take_reconstruction& r);
[[nodiscard]] std::string summary_of(const take_reconstruction& r);

}  // namespace tool
