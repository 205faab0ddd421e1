// tier: hosted
// SPDX-License-Identifier: MIT
//
// What a diagnosis of plucks says, and how takes that were not fitted judge it. What they do not bear out is dropped. Explained is
// what leaves on them no more than a quarter of the noise beyond it, or 12 % of what there was and six times the noise (of what
// leaves mere noise of the fitted takes, six times the noise is asked alone; of two effects or more always twice it). A mismatch
// needs no name: it is also where they are off by more than 0.6 of the noise, and where what rings is noisier than what was held.
// What does not explain is a part of the answer where it leaves less than half of what there was; several together where they leave
// less than a twentieth, or twice the noise: what it takes more than one effect to come near is something else. They judge the
// likeliest of the models that were not taken as well.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_prediction.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One model that was tried.
struct pluck_hypothesis {
  std::vector<std::string> ids;  ///< effects, with their place
  double log_evidence = 0;       ///< relative to the best, natural logarithm
  std::optional<double> left{};  ///< rms residual / rms recorded, on takes that were not fitted; of the likeliest few
  scene_fit fit{};
};

struct pluck_diagnosis {
  scene_data data;
  pluck_fit_result declared;  ///< the fit of the declared model
  scene_fit base, best;       ///< the same over the horizon of the best; and with what was found
  std::vector<pluck_hypothesis> ranking;
  std::vector<std::string> alternatives;  ///< to the last effect found: within 5 nats, cannot be told from it
  std::vector<double> found_gain;         ///< tempered gain of ln L of each effect found
  pluck_mismatch mismatch;
  bool mismatched = false, explained = true;
  double before = 0, after = 0, floor = 0;  ///< rms residual / rms recorded, on held-out takes where there are any
  std::vector<std::string> held_out;
  double slow_noise =
      0;  ///< at the pitch, power over that of white noise, where slow noise was taken out (slow_noise.hpp); 0: none

  /// Whether an effect that was found is no more than any rig has, or cannot be told from what is. It has no name.
  [[nodiscard]] bool is_ordinary(std::size_t which) const {
    if (best.is_ordinary(which)) return true;
    return which + 1 == best.effects.size() && std::any_of(ranking.begin(), ranking.end(), [&](const pluck_hypothesis& h) {
             return h.fit.effects.size() == best.effects.size() && h.fit.is_ordinary(which) &&
                    std::find(alternatives.begin(), alternatives.end(), h.ids.back()) != alternatives.end();
           });
  }
  [[nodiscard]] bool has_ordinary_effects_only() const {
    for (std::size_t i = 0; i < best.effects.size(); ++i)
      if (!is_ordinary(i)) return false;
    return true;
  }
};

namespace detail {

/// Of a pluck, rms: no law of loss, for one, is exact to less. Relaxations that make it causal leave it flat within a hundredth, of which a
/// short series leaves some.
[[nodiscard]] inline double least_told(const scene_data& data) {
  return data.options.causality || data.options.uneven_loss ? 6e-4 : 3e-4;
}

/// What is real shows in takes that were not fitted, too. Where the loss is causal, made by relaxations that nobody knows one by one,
/// what is less than such a law may be off by is not real.
template <class = void>
void drop_what_is_not_predicted(pluck_diagnosis& d, const std::vector<pluck_take>& held, double noise) {
  constexpr double beyond_doubt = 200, least = 3;
  const auto is_real = [&] {
    const bool clear = d.found_gain[d.best.effects.size() - 1] >= beyond_doubt, by_loss = d.data.options.causality;
    if (clear && !by_loss) return true;
    const held_out_worth worth = held_out_gain(d.data, d.best, held, noise);
    return (clear || worth.gain >= least) && !(by_loss && worth.taken < least_told(d.data));
  };
  while (!held.empty() && !d.best.effects.empty() && !is_real()) {
    const bool was_brief = d.best.effects.back().horizon_periods < 1e8;  // what is left holds for as long as was declared
    const scene_fit less = without(d.best, d.best.effects.size() - 1);
    const double horizon =
        was_brief ? std::min(d.declared.horizon_periods, d.data.most_periods_with(less.effects)) : d.best.horizon_periods;
    d.best = fit_scene(d.data, less.effects, less.value, {{1000, horizon, true, freedom::all}}, {noise, noise});
    d.found_gain.resize(d.best.effects.size());
    d.alternatives.clear();
  }
  if (d.best.effects.empty()) d.base = d.best;
  d.mismatched = d.mismatched && !d.best.effects.empty();
}
ROSIN_INSTANTIATE(void drop_what_is_not_predicted(pluck_diagnosis&, const std::vector<pluck_take>&, double))

/// What the likeliest models leave of takes that were not fitted, wrong ones with as many parameters among them.
template <class = void>
void judge_ranking(pluck_diagnosis& d, const std::vector<pluck_take>& judged, double noise) {
  constexpr std::size_t most = 4;
  for (std::size_t i = 0; i < std::min(most, d.ranking.size()); ++i) {
    auto& h = d.ranking[i];
    double power = 0;
    for (const pluck_take& take : judged) power += std::pow(predicted(d.data, h.fit, take, noise)[0], 2);
    h.left = std::sqrt(power / static_cast<double>(judged.size()));
  }
}

/// Of the noise: who may take several names has to leave less.
inline constexpr double most_left_by_several = 2;

/// What is left once the noise's share is taken off, rms.
[[nodiscard]] inline double beyond(double floor, double x) { return std::sqrt(std::max(0.0, x * x - floor * floor)); }

/// Before and after on takes that were not fitted, and whether that is an explanation. `noise_seen`: before the releases as well;
/// much noise that nothing else bears out may be what the model leaves.
template <class = void>
void judge(pluck_diagnosis& d, const std::vector<pluck_take>& judged, double noise, bool noise_seen, bool modulated) {
  constexpr double much_noise = 0.05;
  const double most_left = d.best.effects.size() > 1 ? most_left_by_several : 6;  // of the floor
  const bool brief = d.best.falls_short();
  if (brief) d.base.horizon_periods = d.best.horizon_periods = 1e9;
  scene_fit plain = d.base;
  plain.horizon_periods = d.best.horizon_periods;
  for (const pluck_take& take : judged) {
    const auto b = predicted(d.data, plain, take, noise), a = predicted(d.data, d.best, take, noise);
    d.before += b[0] * b[0], d.after += a[0] * a[0], d.floor += a[1] * a[1];
    d.held_out.push_back(take.name);
  }
  for (double* x : {&d.before, &d.after, &d.floor}) *x = std::sqrt(*x / static_cast<double>(judged.size()));
  const double excess = beyond(d.floor, d.after), was = beyond(d.floor, d.before), left = d.best.quality.inflation();
  const bool doubtful = !noise_seen && d.floor > much_noise, known_ends = d.data.layout.has_ends();  // never to the last digit
  const bool complete = !doubtful && !brief &&
                        ((left == 1.0 && !modulated && excess < most_left * d.floor) ||
                         excess < std::max(0.25 * d.floor, std::min(0.12 * was, most_left * d.floor)));
  d.mismatched = d.mismatched || (left > 1.5 && was > least_told(d.data) && !(known_ends && was <= 0.25 * d.floor)) ||
                 modulated || doubtful || brief ||
                 was > std::max(0.6 * d.floor, d.data.options.causality ? least_told(d.data) : 0.0);
  d.explained = !d.mismatched || (complete && !d.best.effects.empty());
  d.mismatched = d.mismatched && !(d.explained && d.has_ordinary_effects_only());
}
ROSIN_INSTANTIATE(void judge(pluck_diagnosis&, const std::vector<pluck_take>&, double, bool, bool))

/// What does not explain is no part of the answer where it leaves too much. Last of all: by a model without it, what it does would
/// pass for noise.
inline void drop_what_is_no_part(pluck_diagnosis& d) {
  if (d.explained) return;
  const double excess = beyond(d.floor, d.after), was = beyond(d.floor, d.before);
  const bool stand_in = d.best.effects.size() > 1 && excess > std::max(most_left_by_several * d.floor, 0.05 * was);
  if (excess <= 0.5 * was && !stand_in) return;
  const double horizon = d.best.horizon_periods;
  d.best = d.base, d.best.horizon_periods = horizon;
  d.found_gain.clear(), d.alternatives.clear(), d.after = d.before;
}

}  // namespace detail

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
