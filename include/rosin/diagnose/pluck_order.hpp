// tier: hosted
// SPDX-License-Identifier: MIT
//
// Of several fits, each with another effect of the catalogue: which is the best? The cheapest, by what it leaves and by what its
// parameters cost; once more from the first periods on, where it leaves more than noise.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/scene_fit.hpp>
#include <rosin/math/at_once.hpp>

#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin::detail {

/// Cost of a fit where the channels are weighed alike; infinite where it failed.
inline double cost_of(const scene_fit& f, const std::array<double, 2>& noise) {
  double cost = 0;
  for (std::size_t c = 0; c < 2; ++c) cost += f.quality.power[c] / (noise[c] * noise[c]);
  return std::isfinite(cost) ? cost : 1e300;
}

/// -2 ln of the evidence but for a constant (Schwarz): what a fit leaves, and what its effects' parameters cost, in the units of
/// what is left. Corrections cost nothing, losses of the modes' own what their scatter makes of them.
inline double price_of(const scene_fit& f, const std::array<double, 2>& noise) {
  double parameters = 0, samples = 1;
  for (const pluck_effect& e : f.effects)
    for (const effect_parameter& p : e.parameters) parameters += p.late ? 0 : 1;
  for (const double n : f.quality.samples) samples += n;
  const double cost = cost_of(f, noise);
  return cost + (parameters * std::log(samples) + f.losses_price) * cost / samples;
}

/// An effect whose model holds for a short time only stays if over that time it is the best, and worth anything.
template <class = void>
void prefer_over_one_horizon(const scene_data& data, const scene_fit& already, std::vector<scene_fit>& fits,
                             std::array<double, 2> noise) {
  const auto brief = std::find_if(fits.begin(), fits.end(), [](const scene_fit& f) { return f.horizon_periods < 1e8; });
  if (brief == fits.end()) return;
  constexpr double worth_anything = 28, apart = 6;
  const double cost = cost_of(*brief, noise);
  const auto is_no_better = [&](const scene_fit& than, double by) {
    const scene_fit other =
        fit_scene(data, than.effects, than.value, {{1000, brief->horizon_periods, true, data.compared()}}, noise);
    return cost_of(other, noise) < cost + by;
  };
  bool goes = already.horizon_periods >= 1e8 && is_no_better(already, worth_anything);
  for (auto f = fits.begin(); !goes && f != fits.end(); ++f) goes = f->horizon_periods >= 1e8 && is_no_better(*f, apart);
  if (goes) fits.erase(brief);
  else std::rotate(fits.begin(), brief, brief + 1);
}

/// The values of a fit whose last effect sits on the string, with it at its mirror image, which moves the partials by as much.
inline std::optional<Eigen::VectorXd> mirrored(const scene_fit& fit) {
  const auto& parameters = fit.effects.back().parameters;
  if (parameters.empty() || parameters[0].name != "position") return std::nullopt;
  Eigen::VectorXd v = fit.value;
  double& x = v[v.size() - static_cast<Eigen::Index>(parameters.size())];
  x = 1 - x;
  return v;
}

/// An effect that leaves more than noise once more from the first periods on, in small steps, and from its mirror image: over all of
/// the record the fit may have come to rest with partials a little off.
template <class Real = double>
scene_fit rewound(const scene_data& data, scene_fit fit, std::array<double, 2> noise) {
  std::vector<fit_stage> stages;
  for (double periods = 1.5; periods < std::min(100.0, fit.horizon_periods); periods *= 2)
    stages.push_back({1000, periods, true});
  stages.push_back({1000, fit.horizon_periods, true, freedom::all});
  std::vector<Eigen::VectorX<Real>> from{fit.value};
  if (auto other = mirrored(fit)) from.push_back(*std::move(other));
  std::vector<scene_fit> again(from.size());
  at_once(from.size(), data.options.threads,
          [&](std::size_t i) { again[i] = fit_scene(data, fit.effects, from[i], stages, noise); });
  for (scene_fit& other : again)
    if (cost_of(other, noise) < cost_of(fit, noise)) fit = std::move(other);
  return fit;
}
ROSIN_INSTANTIATE(scene_fit rewound(const scene_data&, scene_fit, std::array<double, 2>))

/// The best first; that one once more from the first periods on where it leaves more than noise.
template <class = void>
void put_in_order(const scene_data& data, const scene_fit& already, std::vector<scene_fit>& fits, std::array<double, 2> noise) {
  std::sort(fits.begin(), fits.end(), [&](const auto& a, const auto& b) { return price_of(a, noise) < price_of(b, noise); });
  if (!fits.empty() && fits.front().quality.inflation() > 1.5 && !fits.front().effects.back().seek)
    fits.front() = rewound(data, std::move(fits.front()), noise);
  prefer_over_one_horizon(data, already, fits, noise);
}

}  // namespace rosin::detail

#include <rosin/core/macros_back.ipp>
