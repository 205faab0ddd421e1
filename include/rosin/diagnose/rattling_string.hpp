// tier: hosted
// SPDX-License-Identifier: MIT
//
// A string whose every pluck meets an obstacle leaves no clean one to tell the string by. But a force at one place gives both ends
// their share of one unknown, so that what lies across those shares (mismatch_place.hpp) is the string's and the pluck's alone:
//
//     A(1-x)* r_far - A(x)* r_near,     whatever the force at x may be.
//
// The declared string is fitted by that, from the first periods to so many as the place is searched in: place, then parameters, in
// turn. Of a string between rigid ends no resonance is left across, but a few waves that pass, so losses are hardly told: what is known
// of parameters beforehand goes along.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/mismatch_place.hpp>
#include <rosin/diagnose/pluck_prediction.hpp>

#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// So much of the decay is looked at.
inline constexpr double rattling_periods = 24;

/// How far parameters may be from what a rig file makes of them, as standard deviations, where the fit of plucks assumes nothing.
[[nodiscard]] inline nuisance_doubt doubt_of(const scene_plucks& model, Eigen::Index p, const Eigen::VectorXd& v,
                                             const Eigen::VectorXd& declared, double place, const scene_data& data) {
  constexpr double pitch = 0.005, period_share = 0.01, at_Hz = 2000;
  if (p >= model.plain_size()) return {0, 0};
  const auto [known, sd] = model.prior(p, data.takes, data.guess);
  if (sd > 0) return {v[p] - known, sd};
  const double off = v[p] - declared[p];
  if (p == pluck_layout::fundamental) return {off, pitch * declared[p]};
  if (p == pluck_layout::inverse_quality) return {off, declared[p]};
  if (p == pluck_layout::internal_loss) return {off, declared[pluck_layout::inverse_quality] / at_Hz};
  if (p == pluck_layout::air_loss) return {off, declared[pluck_layout::inverse_quality] * std::sqrt(at_Hz)};
  if (p == model.position(0)) return {v[p] - place, data.guess.position_tolerance};
  if (p == model.at(0, pluck_layout::release)) return {off, period_share / declared[pluck_layout::fundamental]};
  return {0, 0};
}

/// What is left across the shares of the likeliest place, and the step that lessens it.
struct across_a_place {
  acting_place place;
  double over_noise = 0;  ///< rms
  std::vector<Eigen::Index> parameters;
  Eigen::VectorXd step, sd;
};

/// A take whose string, release and place were begun with somehow.
struct begun_take {
  const scene_data& data;  ///< of the take by itself
  Eigen::VectorXd declared;
  double place = 0.5;  ///< as it is known
  freedom free = freedom::all;
  std::array<double, 2> noise_N{};
  std::array<double, 2> within{0, 1};  ///< where something acts
};

/// `over`: by how much noise, and all that the model does not yet tell, exceeds the noise.
template <class = void>
across_a_place look_across(const begun_take& take, const scene_fit& fit, double periods, double over) {
  const auto problem = take.data.problem(fit.effects, fit.value, {1000, periods, true, take.free}, {1, 1});
  auto left = left_by(problem, fit.value, 0);
  for (const Eigen::Index p : left.parameters)
    left.doubts.push_back(doubt_of(problem.model(), p, fit.value, take.declared, take.place, take.data));
  const place_search search(scene_of(take.data, fit), {pluck_layout::gain(fit.value, 0), pluck_layout::gain(fit.value, 1)},
                            problem.limits(), left, {over * take.noise_N[0], over * take.noise_N[1]});
  across_a_place out{search.on_string(take.within[0], take.within[1]), 0, left.parameters, {}, {}};
  out.over_noise = over * std::sqrt(search.misfit(out.place));
  out.step = -search.nuisances(out.place);
  out.sd = search.covariance(out.place).diagonal().cwiseMax(0).cwiseSqrt();
  for (std::size_t k = 0; k < left.doubts.size(); ++k)  // no farther at once than what is known of it allows
    if (left.doubts[k].sd > 0)
      out.step *= std::min(1.0, left.doubts[k].sd / std::max(1e-300, std::abs(out.step[static_cast<Eigen::Index>(k)])));
  return out;
}

/// From a fit that has begun to one with as little left across as can be. `over`: of what it begins with.
template <class = void>
across_a_place descend_across(const begun_take& take, scene_fit& fit, double periods, double over, double settled) {
  constexpr int most_rounds = 20;
  constexpr double least_share = 0.02;
  const scene_plucks model(take.data.layout, take.data.guess.ac_coupled_Hz, fit.effects, take.free);
  const double highest_Hz = take.data.options.limits_for(take.data.takes[0].rate_Hz).stop_Hz;
  across_a_place here = look_across(take, fit, periods, over);
  double share = 1, gain = 1;
  for (int round = 0; round < most_rounds && share > least_share && gain > settled; ++round) {
    scene_fit next = fit;
    next.value(here.parameters) += share * here.step;
    share /= 2;
    if (!model.plausible(next.value, take.declared, highest_Hz)) continue;
    auto there = look_across(take, next, periods, std::max(1.0, here.over_noise));
    if (!(there.over_noise < here.over_noise)) continue;
    gain = 1 - there.over_noise / here.over_noise;
    fit = std::move(next), here = std::move(there), share = std::min(1.0, 4 * share);
  }
  return here;
}

/// By the first periods, then by all. From three places of the pluck, where its place is free, and in either half of the string, as
/// long as more than noise is left: few samples of a short string precede its first contact, and a force has a mirror image.
template <class = void>
across_a_place descend_from_places(begun_take take, scene_fit& fit) {
  constexpr double as_good_as_noise = 1.5, much = 100, roughly = 1e-2, well = 1e-4;
  const Eigen::Index at = take.data.layout.position(0);
  const scene_fit begun = fit;
  const auto by_few = [&](scene_fit& some) {
    const double over = descend_across(take, some, 3, much, roughly).over_noise;
    return descend_across(take, some, 8, std::max(1.0, over), roughly).over_noise;
  };
  double least = by_few(fit);
  for (const double side : {0.0, -1.0, 1.0})
    for (const double half : {0.0, 0.5}) {
      if (least < as_good_as_noise || (side != 0 && take.free == freedom::release_only)) break;
      scene_fit other = begun;
      if (side != 0) other.value[at] = take.place + side * take.data.guess.position_tolerance;
      take.within = {half, half + 0.5};
      if (const double left = by_few(other); left < least) least = left, fit = std::move(other);
    }
  take.within = {0, 1};
  return descend_across(take, fit, rattling_periods, std::max(1.0, least), well);
}
ROSIN_INSTANTIATE(across_a_place descend_from_places(begun_take, scene_fit&))

/// The string as declared, release and strength from what precedes the first contact.
template <class = void>
std::optional<scene_fit> begun_as_declared(const scene_data& data) {
  scene_fit fit;
  fit.value = data.layout.initial(data.takes, data.guess, data.guess.fundamental_Hz, {0}, {data.takes[0].position});
  fit.horizon_periods = 0.45;
  const auto seen = see(data, fit, data.takes[0], fit.horizon_periods);
  if (!seen) return std::nullopt;
  fit.value = seen->fit.value;
  return fit;
}

}  // namespace detail

/// The declared string fitted to the only take of `data`, whatever a force at one place does to it; nothing where that leaves more than
/// noise, or where too little precedes the release to tell the noise.
template <class = void>
[[nodiscard]] std::optional<scene_fit> fit_past_a_force(const scene_data& data) {
  auto fit = detail::begun_as_declared(data);
  if (!fit) return std::nullopt;
  const detail::seen_noise still = detail::noise_before_release(data, *fit);
  if (!(still.samples > 0)) return std::nullopt;
  const auto found = detail::descend_from_places({data, fit->value, data.takes[0].position, freedom::all, still.rms_N}, *fit);
  constexpr double most_over_noise = 5;
  if (!(found.over_noise < most_over_noise)) return std::nullopt;
  fit->horizon_periods = detail::rattling_periods;
  detail::conclude(*fit, data, data.problem({}, fit->value, {1000, fit->horizon_periods, true, freedom::all}, still.rms_N));
  fit->quality.noise = still.rms_N;
  fit->covariance.setZero(), fit->sd.setZero();
  fit->sd(found.parameters) = found.sd;
  fit->covariance.diagonal() = fit->sd.cwiseAbs2();
  return fit;
}
ROSIN_INSTANTIATE(std::optional<scene_fit> fit_past_a_force(const scene_data&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
