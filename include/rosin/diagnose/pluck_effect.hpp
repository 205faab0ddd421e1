// tier: hosted
// SPDX-License-Identifier: MIT
//
// One effect of the catalogue as the fit of plucks sees it: a name, where it may be, its parameters with bounds, and what it
// writes into a scene. Where the fit is to begin is a list of starting points: a score test (pluck_score.hpp) finds the best of
// them.
//
#pragma once

#include <rosin/calibrate/pluck_layout.hpp>
#include <rosin/diagnose/pluck_scene.hpp>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace rosin {

/// What the effects' starting points depend on.
struct string_facts {
  double fundamental_Hz = 0, rate_Hz = 0, highest_Hz = 0;
  double impedance_Ns_m = 0;  ///< 0: unknown; masses and resistances are then relative to Z
  double length_m = 0;        ///< 0: unknown
  std::size_t takes = 0;
};

/// A parameter, in the unit of its name, within [low, high]. Positive quantities that span decades are fitted as logarithms.
struct effect_parameter {
  std::string name;
  double low = 0, high = 0;
  double step = 1e-6;  ///< for numerical derivatives; relative for logarithms
  bool logarithmic = false;
  int take = -1;          ///< the only take that it concerns; -1: all
  bool by_score = false;  ///< found by score steps (pluck_effect::undo)
  bool late = false;      ///< a correction: freed when everything else has settled
};

inline effect_parameter correction(std::string name, double low, double high, double step) {
  return {.name = std::move(name), .low = low, .high = high, .step = step, .late = true};
}

inline effect_parameter by_score_steps(std::string name, double low, double high, double step) {
  return {.name = std::move(name), .low = low, .high = high, .step = step, .by_score = true};
}

/// What a fit leaves of both channels of a take.
struct take_residual {
  std::array<Eigen::VectorXd, 2> residual;
  double begin_s = 0, rate_Hz = 0;  ///< from the take's beginning
  std::size_t take = 0;
  std::vector<double> own_Hz;  ///< the string's partials
};

struct pluck_effect {
  std::string name;     ///< as in the format "diagnosis"
  int place = -1;       ///< 0 near, 1 far, for effects of one end or channel
  bool at_end = false;  ///< place is an end of the string, not a channel
  std::vector<effect_parameter> parameters{};
  std::vector<std::vector<double>> starts{};  ///< physical values
  int strength = 0;  ///< index of the parameter that the effect vanishes with, small ones in proportion; -1: none does
  std::function<void(pluck_scene&, const double* values, int take)> apply{};
  /// What is not linear works on the recordings: takes out of them what the effect (one parameter, not 0) has put in, by the
  /// fit so far and the scene that it makes.
  std::function<void(std::vector<pluck_take>&, const pluck_scene&, const pluck_layout&, const Eigen::VectorXd& v, double value)>
      undo{};
  /// With it: the linear string that comes nearest in a take, so that what is taken out stays small.
  std::function<void(pluck_scene&, const pluck_layout&, const Eigen::VectorXd& v, std::size_t take, double value)> retune{};
  /// Nuisances that have to go along when the effect enters the model.
  std::function<void(const pluck_layout&, Eigen::VectorXd& v)> rebase{};
  /// The search then begins where what a fit leaves tells of it, not at `starts`.
  std::function<std::vector<std::vector<double>>(const take_residual&)> seek{};
  /// With it: whether it is what its name says at these (physical) values, or does what something else would do as well.
  std::function<bool(const std::vector<double>&)> is_itself{};
  /// Whether at these (physical) values it is no more than any rig has: it stays in the model and has no name.
  std::function<bool(const std::vector<double>&)> is_ordinary{};
  double horizon_periods = 1e9;  ///< the model of the effect holds for so long
  std::string variant{};         ///< one of several models of the same effect
  std::string beside{};          ///< id of an effect without which this one is the same as another
  /// index of a parameter that makes less and less of the effect, though not in proportion; -1: none does
  int shrinks_with = -1;

  [[nodiscard]] std::string id() const {
    static constexpr const char* places[] = {"near", "far"};
    return (place < 0 ? name : name + "@" + places[place]) + (variant.empty() ? "" : " " + variant);
  }
};

/// What of a catalogue may be added to effects that are there already.
[[nodiscard]] inline std::vector<pluck_effect> still_to_add(const std::vector<pluck_effect>& catalogue,
                                                            const std::vector<pluck_effect>& already) {
  std::vector<pluck_effect> out;
  for (const pluck_effect& e : catalogue) {
    const bool there = std::any_of(already.begin(), already.end(),
                                   [&](const pluck_effect& h) { return h.name == e.name && h.place == e.place; });
    const bool makes_sense = e.beside.empty() || std::any_of(already.begin(), already.end(),
                                                             [&](const pluck_effect& h) { return h.id() == e.beside; });
    if (!there && makes_sense) out.push_back(e);
  }
  return out;
}

}  // namespace rosin
