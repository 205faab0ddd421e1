// tier: hosted
// SPDX-License-Identifier: MIT
//
// Effects that were found one after the other may stand in one another's place: what a later one makes needless is given up, what
// another one explains better is exchanged.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_candidates.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// A fit's effects and values without one of them.
template <class = void>
scene_fit without(const scene_fit& fit, std::size_t which) {
  scene_fit out = fit;
  const Eigen::Index at = fit.first_of(which);
  const auto gone = static_cast<Eigen::Index>(fit.effects[which].parameters.size()), rest = fit.value.size() - at - gone;
  out.value.resize(at + rest);
  out.value << fit.value.head(at), fit.value.tail(rest);
  out.effects.erase(out.effects.begin() + static_cast<std::ptrdiff_t>(which));
  return out;
}
ROSIN_INSTANTIATE(scene_fit without(const scene_fit&, std::size_t))

}  // namespace detail

/// Each effect in turn is taken out, and stays out where the evidence is higher or it is not is_worth(fit without it, fit,
/// which); what best takes its place stays if it gains `nats`.
[[nodiscard]] scene_fit exchanged(const scene_data& data, scene_fit fit, const std::vector<pluck_effect>& all, double nats,
                                  std::array<double, 2> noise, const auto& is_worth) {
  std::size_t count = fit.effects.size();
  for (std::size_t tried = 0, k = 0; tried < count && count > 1; ++tried, k = (k + 1) % count) {
    scene_fit rest = detail::without(fit, k);
    rest = fit_scene(data, rest.effects, rest.value, {{1000, fit.horizon_periods, true, data.compared()}}, noise);
    if (!(detail::cost_of(rest, noise) < 1e299)) continue;
    if (detail::price_of(rest, noise) < detail::price_of(fit, noise) || !is_worth(rest, fit, k)) {
      fit = fit_scene(data, rest.effects, rest.value, {{1000, fit.horizon_periods, true, freedom::all}}, noise);
      --count, tried = 0, k = 0;
      continue;
    }
    const auto fits = one_more_effect(data, rest, still_to_add(all, rest.effects), rest.quality.residual_ratio[0] > 0.05, noise);
    if (fits.empty() || fits.front().horizon_periods != fit.horizon_periods) continue;
    const double temper = std::max(1.0, fits.front().quality.inflation());
    if (0.5 * (detail::price_of(fit, noise) - detail::price_of(fits.front(), noise)) / temper > nats)
      fit = fits.front(), tried = 0, k = 0;
  }
  return fit;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
