// SPDX-License-Identifier: MIT
//
// A whole rig diagnosed: plucks first (string, ends, sensors), then the strokes (tension, contact).
//
#pragma once

#include "rig_input.hpp"

#include <rosin/diagnose/contact_take.hpp>
#include <rosin/diagnose/mismatch_map.hpp>
#include <rosin/propagate/band.hpp>

#include <array>
#include <functional>

namespace rosin {
struct pluck_diagnosis;
struct odd_pluck;
struct rattle;
}  // namespace rosin

namespace tool {

struct diagnosed_value {
  std::string name;
  double value = 0, sd = 0;
};

/// What holds the truth in 95 of 100 cases; no mass, place or the like that cannot be.
[[nodiscard]] std::array<double, 2> interval_of(const diagnosed_value& v);

/// One effect that the declared model lacks.
struct missing_effect {
  std::string effect;
  std::string end, channel;  ///< "near", "far" or empty
  std::optional<double> position;
  double probability = 1;
  std::vector<std::string> indistinguishable_from;
  std::vector<diagnosed_value> parameters;
  std::string statement;
};

struct ranked_model {
  std::vector<std::string> effects;
  double log10_evidence = 0;
  std::optional<double> left{};  ///< what it leaves of the takes set aside, in the metric of its data; where that was looked at
};

/// One take's residual in both channels, from so many seconds after its beginning on.
struct residual_series {
  double begin_s = 0;
  std::array<std::vector<double>, 2> force_N;
};

/// A pluck's force as both ends have it by the declared model, and the release that it should be.
struct pluck_force_picture {
  double begin_s = 0;
  std::vector<double> near_N, far_N, step_N;
  double parting_N = 0, parting_noise_N = 0, shape_N = 0, shape_noise_N = 0;  ///< rms: between the versions; their mean, the step
};

/// What the declared model and the corrected one leave of the pluck in which they part most, over its first periods or where it
/// goes astray.
struct residual_picture {
  std::string take;
  double rate_Hz = 0, fundamental_Hz = 0;
  rosin::band limits;               ///< all of it was seen through
  std::array<double, 2> noise_N{};  ///< standard deviation in that band
  std::array<double, 2> noise_N_per_root_Hz{};
  residual_series before, after;
  std::optional<rosin::mismatch_map> map{};   ///< of what the declared model leaves
  std::array<rosin::echo_times, 2> echoes{};  ///< at the near and the far end
  std::optional<pluck_force_picture> force{};
  std::string kind{};  ///< whether both versions of the force agree on the mismatch: a name_of(mismatch_class), or empty
  std::string stretch = "over its first periods",
              bar = "The bar marks where it is largest; over the stretch that was fitted it is";  ///< what the captions say
};

/// One partial as a pickup heard it, and where the declared law and the corrected one have it.
struct pickup_partial {
  int number = 0;
  double frequency_Hz = 0, frequency_sd = 0, decay_per_s = 0, decay_sd = 0;
  double declared_Hz = 0, corrected_Hz = 0, declared_per_s = 0, corrected_per_s = 0;
};

/// The take of a single pickup in which simulation and recording part most.
struct pickup_picture {
  std::string take, channel;
  double rate_Hz = 0, begin_s = 0, noise = 0, fundamental_Hz = 0;
  std::vector<double> before, after;  ///< residuals
  std::vector<pickup_partial> partials;
};

/// What the declared contact and the corrected one leave of the stroke in which it shows most.
struct contact_picture {
  std::string take, statistic;                      ///< "stick-fluctuation" or "friction-residual"
  std::vector<rosin::contact_trace> before, after;  ///< one of each; after: none where nothing was found
  std::array<double, 2> shown_s{};                  ///< the stretch where most is left
  std::vector<double> cycle_before, cycle_after;    ///< rms left in each tenth of a stick, or of a slip, over all of the take
  double noise = 0;
};

/// What shows that a contact is not as the model has it.
struct open_contact {
  std::string statistic, take;  ///< a metric of the format; the take is empty where all of them show it
  double size = 0, floor = 0;
};

struct rig_diagnosis {
  std::string title, verdict;
  std::vector<missing_effect> missing;
  std::vector<ranked_model> ranking;
  std::vector<diagnosed_value> calibration;
  std::string metric = "pluck-residual";
  std::vector<std::string> held_out;
  double before = 0, noise_floor = 0;
  std::optional<double> after;
  // Where it shows.
  std::string take, channel;
  std::optional<std::array<double, 2>> time_s, band_Hz;
  std::optional<double> position;
  /// what is left of an unexplained mismatch: "on the string at 0.62 +- 0.01 of its length", "at the near end", "in the far
  /// channel"
  std::string acts;
  std::optional<open_contact> left_in_strokes{};  ///< what these show beyond all that was found in the plucks
  double residual_over_noise = 0;
  std::string kind;         ///< "sensor-or-string", "common-mode", "contact"; empty where that cannot be told
  std::optional<int> echo;  ///< the last wave of the pluck to arrive before time_s; 1: the direct one
  std::optional<residual_picture> residual;
  std::optional<contact_picture> contact;
  std::vector<std::string> assumed, warnings;
  std::optional<pickup_picture> pickup;  ///< of a rig without two force channels
};

inline constexpr std::size_t diagnosis_steps = 4;
/// `without`: effects that the catalogue is not to know, by name. No result depends on the number of threads. `step` is called when
/// plucks, strokes, tension have been seen to.
[[nodiscard]] rosin::outcome<rig_diagnosis> diagnose(
    const rosin::rig& rig, provenance& from, const std::vector<std::string>& without = {}, int threads = 1,
    const std::function<void()>& step = [] {});
/// The same for a rig that has not two force channels: plucks heard by pickups or microphones.
[[nodiscard]] rosin::outcome<rig_diagnosis> diagnose_pickups_of(const rosin::rig& rig, provenance& from,
                                                                const std::vector<std::string>& without = {});
/// What an effect means, with its values.
[[nodiscard]] std::string statement_of(const missing_effect& m);
/// A parameter of the fit in the names and units of the format; the doubt in nominal values joins the standard deviation.
[[nodiscard]] diagnosed_value in_si(const std::string& name, double value, double sd, const rosin::rig_values& values,
                                    double fundamental_Hz);
[[nodiscard]] std::optional<residual_picture> residuals_of(const rosin::pluck_diagnosis& plucks);
[[nodiscard]] residual_picture residuals_of(const rosin::odd_pluck& odd);
/// The same of one that met an obstacle.
[[nodiscard]] residual_picture residuals_of(const rosin::odd_pluck& odd, const rosin::rattle& rattle);
[[nodiscard]] json to_json(const rig_diagnosis& d, const provenance& from);
/// A page: the sentence, what is left before and after, parameters, runners-up, what could not be done. Needs gnuplot.
[[nodiscard]] exit_code write_diagnosis_report(const std::string& path, bool force, const rig_diagnosis& d,
                                               const provenance& from);
[[nodiscard]] std::string sentence(const rig_diagnosis& d);
/// What a kind of mismatch means.
[[nodiscard]] std::string kind_in_words(const std::string& kind);

/// What the plucks that a rig file announces can tell apart, whether they have been made or not.
[[nodiscard]] rosin::outcome<json> isolability_of(const rosin::rig& rig, double rate_Hz, double noise_N);
[[nodiscard]] std::string isolability_text(const json& j);

}  // namespace tool
