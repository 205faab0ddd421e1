// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the plucks of a rig say of physics that was left out. The declared model is fitted first; then effects of the catalogue are
// added as long as it is worth it (pluck_search.hpp). What is real gains 3 on takes that were set aside as well, where it does not
// gain very much in all. Of takes that were not fitted next to nothing is free (pluck_prediction.hpp).
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/clock_drift_effect.hpp>
#include <rosin/diagnose/loosened_plucks.hpp>
#include <rosin/diagnose/nonlinear_effects.hpp>
#include <rosin/diagnose/pluck_search.hpp>
#include <rosin/diagnose/slow_noise.hpp>
#include <rosin/diagnose/sympathetic_effect.hpp>

#include <tuple>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// The declared model by itself: a string between ends that are rigid, or that move as is known.
template <class = void>
[[nodiscard]] outcome<pluck_fit_result> fit_declared(const std::vector<pluck_take>& takes, const pluck_guess& guess,
                                                     const pluck_options& options) {
  pluck_options all = options;
  all.own_losses = 0, all.asks_own_losses = options.own_losses > 0;
  constexpr double most_residual = 0.95;  // a heavy bead leaves little of the declared string
  if (!guess.has_ends()) return fit_plucks(takes, guess, all, most_residual);
  end_options held;
  held.free_ends = {false, false}, held.most_residual = most_residual;
  auto fit = fit_ends(takes, guess, all, held);
  if (!fit) return failure{fit.error()};
  return std::move(fit->plucks);
}

/// The same in the layout of a diagnosis. What is loosened is not free where something strong would bend it.
template <class Real = double>
[[nodiscard]] outcome<pluck_fit_result> fit_declared_loosely(const std::vector<pluck_take>& takes, const pluck_guess& guess,
                                                             const pluck_options& options) {
  pluck_options strict = options;
  strict.uneven_loss = strict.own_places = false;
  auto fit = fit_declared(takes, guess, strict);
  const bool loose = options.uneven_loss || options.own_places;
  if (fit && loose && fit->residual_ratio[0] < most_loosened)
    if (auto other = fit_declared(takes, guess, options)) fit = std::move(other);
  if (!fit) return fit;
  pluck_options free = options;
  free.causality = fit->layout.is_free(pluck_layout::causality);
  const pluck_layout layout(takes, free, guess.ends);
  const auto places = places_in(layout, fit->layout, fit->value.size());
  Eigen::MatrixX<Real> covariance = Eigen::MatrixX<Real>::Zero(layout.size(), layout.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = 0; k < places.size(); ++k)
      covariance(places[i], places[k]) = fit->covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
  fit->value = carried_over(layout, fit->layout, fit->value), fit->sd = carried_over(layout, fit->layout, fit->sd);
  fit->covariance = std::move(covariance), fit->layout = layout;
  if (fit->loss_scatter > 0) {
    fit->value[layout.loss_scatter()] = fit->loss_scatter;
    const auto count = std::min<std::size_t>(fit->own_losses.size(), static_cast<std::size_t>(layout.own_losses()));
    for (std::size_t n = 0; n < count; ++n) fit->value[layout.first_of_own() + static_cast<Eigen::Index>(n)] = fit->own_losses[n];
  }
  return fit;
}

/// Effects that the declared model, as it was fitted, does not contain.
using effects_for = std::function<std::vector<pluck_effect>(const pluck_fit_result&)>;

/// Whether loss that disperses accounts for most of what these effects leave (pluck_fit.hpp).
template <class = void>
[[nodiscard]] bool leaves_causal_loss(const scene_data& data, const scene_fit& found, std::array<double, 2> noise) {
  if (data.options.causality || found.quality.inflation() == 1) return false;
  scene_data freed = data;
  freed.options.causality = true;
  freed.layout = pluck_layout(data.takes, freed.options, data.guess.ends);
  const scene_fit tried =
      fit_scene(freed, found.effects, found.value, {{1000, found.horizon_periods, true, freed.compared()}}, noise);
  return is_causal(tried.value[pluck_layout::causality], tried.sd[pluck_layout::causality]) &&
         tried.quality.inflation() - 1 < (found.quality.inflation() - 1) / 3;
}

/// What was found leaves so much that loss that disperses may have hidden what else there is: then the search begins anew with it.
[[nodiscard]] inline bool is_far_off(const pluck_diagnosis& d, const scene_fit& found) {
  constexpr double far_off = 30;
  return !d.data.options.causality && found.quality.inflation() > far_off;
}
[[nodiscard]] inline bool is_due_to_causal_loss(const pluck_diagnosis& other, const scene_fit& without) {
  constexpr double most_left = 1.0 / 9, most_sd = 0.25;  // what is left of strong effects makes for doubt
  return other.explained &&
         is_causal(other.best.value[pluck_layout::causality], other.best.sd[pluck_layout::causality], most_sd) &&
         other.best.quality.inflation() - 1 < most_left * (without.quality.inflation() - 1);
}

/// One effect, of what nothing slight could be, and little beside it: no model of an effect is exact.
[[nodiscard]] inline bool tells_one_effect(const pluck_diagnosis& d, const scene_fit& found) {
  constexpr double little = 10;
  return d.explained && found.effects.size() == 1 && found.quality.inflation() < little &&
         d.base.quality.residual_ratio[0] > most_loosened;
}

/// Of recordings as they are. Where the first effect leaves more than `stop_above` (inflation), no other is sought.
template <class = void>
[[nodiscard]] outcome<pluck_diagnosis> diagnose_as_recorded(const std::vector<pluck_take>& takes,
                                                            const std::vector<pluck_take>& held, const pluck_guess& guess,
                                                            pluck_options options, const effects_for& catalogue_for,
                                                            int most_effects, double least_temper = 1,
                                                            double stop_above = 1e300) {
  constexpr double clearly_less = 0.9;  // of what the first effect leaves
  auto declared = fit_declared_loosely(takes, guess, options);
  if (!declared) return failure{declared.error()};
  options.causality = declared->layout.is_free(pluck_layout::causality);
  pluck_diagnosis d{{takes, guess, options, declared->layout}, *declared, {}, {}, {}, {}, {}, {}, false, true, 0, 0, 0, {}};
  d.data.least_temper = least_temper;
  double least_noise = 0;
  search_memory memory{.stop_above = stop_above};
  std::tie(d, least_noise) = searched(d, catalogue_for(*declared), most_effects, memory);
  drop_what_is_not_predicted(d, held, least_noise);
  const seen_noise still = noise_before_release(d.data, d.best);
  const bool modulated = is_noisier(d.best.quality.noise, still, least_temper > 1);
  const double noise = modulated ? rms_of(still.rms_N) : least_noise;
  d.mismatch = locate(d.data, d.base, noise);
  const auto& judged = held.empty() ? takes : held;
  const scene_fit found = d.best;
  judge(d, judged, noise, still.samples > 0, modulated);
  if (memory.is_hopeless(found)) return d;
  const bool surely = leaves_causal_loss(d.data, found, {noise, noise});
  if (surely || is_far_off(d, found)) {
    options.causality = true;
    auto other = diagnose_as_recorded(takes, held, guess, options, catalogue_for, most_effects, least_temper,
                                      surely ? 1e300 : clearly_less * memory.first_leaves());
    if (surely || (other && is_due_to_causal_loss(*other, found))) return other;
  }
  if (const auto looser = tells_one_effect(d, found) ? std::nullopt : what_to_loosen(d.data, found, {noise, noise})) {
    auto other = diagnose_as_recorded(takes, held, guess, *looser, catalogue_for, most_effects, least_temper);
    if (other && other->best.quality.inflation() < found.quality.inflation()) return other;
  }
  if (d.mismatched) judge_ranking(d, judged, noise);
  return d;
}

/// Without what is no part of the answer, and with the place where the rest acts: if that is a channel, it is looked at there.
template <class = void>
[[nodiscard]] pluck_diagnosis concluded(pluck_diagnosis d) {
  drop_what_is_no_part(d);
  if (d.explained) return d;
  const auto place = place_of_residual(d.data, d.best, d.mismatch.take);
  const bool near = place && place->on == acting::near_channel, far = place && place->on == acting::far_channel;
  if (near || far) {
    const double over_noise = d.mismatch.residual_over_noise;
    d.mismatch = locate(d.data, d.base, 1, {near, far});
    d.mismatch.residual_over_noise = over_noise;
  }
  d.mismatch.place = place;
  return d;
}

}  // namespace detail

/// `catalogue_for`: effects that the declared model does not contain. Takes in `held` are predicted only. Where the recordings have
/// noise that is slow (slow_noise.hpp), they are looked at again without it.
template <class = void>
[[nodiscard]] outcome<pluck_diagnosis> diagnose_plucks(const std::vector<pluck_take>& takes, const std::vector<pluck_take>& held,
                                                       const pluck_guess& guess, const pluck_options& options,
                                                       const detail::effects_for& catalogue_for, int most_effects = 3) {
  auto d = detail::diagnose_as_recorded(takes, held, guess, options, catalogue_for, most_effects);
  if (!d) return d;
  const auto cleaned = d->mismatched ? without_slow_noise(*d, held) : std::nullopt;
  if (!cleaned) return detail::concluded(*std::move(d));
  auto again =
      detail::diagnose_as_recorded(cleaned->takes, cleaned->held, guess, options, catalogue_for, most_effects, cleaned->over);
  if (!again) return detail::concluded(*std::move(d));
  again->slow_noise = cleaned->over;
  return detail::concluded(*std::move(again));
}
ROSIN_INSTANTIATE(outcome<pluck_diagnosis> diagnose_plucks(const std::vector<pluck_take>&, const std::vector<pluck_take>&,
                                                           const pluck_guess&, const pluck_options&, const detail::effects_for&,
                                                           int))

/// The catalogue without what the declared model already contains.
template <class = void>
[[nodiscard]] std::vector<pluck_effect> catalogue_without(const std::vector<std::string>& physics, const string_facts& facts,
                                                          const band& limits) {
  std::vector<pluck_effect> all = pluck_effects(facts);
  for (const int channel : {0, 1})
    for (const bending where : {bending::behind_ringing, bending::before_ringing})
      all.push_back(sensor_nonlinearity_effect(facts, channel, where));
  all.push_back(clock_drift_effect(facts));
  for (const int end : {0, 1}) all.push_back(sympathetic_string_effect(facts, end));
  if (facts.impedance_Ns_m > 0 && facts.length_m > 0) {
    all.push_back(tension_modulation_effect(facts, limits));
    for (const int channel : {0, 1}) all.push_back(phantom_partials_effect(facts, limits, channel));
  }
  std::erase_if(all, [&](const pluck_effect& e) { return std::find(physics.begin(), physics.end(), e.name) != physics.end(); });
  return all;
}
ROSIN_INSTANTIATE(std::vector<pluck_effect> catalogue_without(const std::vector<std::string>&, const string_facts&, const band&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
