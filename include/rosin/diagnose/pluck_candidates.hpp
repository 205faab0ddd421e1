// tier: hosted
// SPDX-License-Identifier: MIT
//
// Which effect of the catalogue, added to what is in the model already, explains most of what the plucks hold besides?
//
// Every starting point of every effect is put to a score test, which costs a millisecond; the best few of each effect are fitted
// over the first periods; and the best few of these over all of the record. Where the model is far off, the score is taken over the
// first three and eight periods: there an effect is still where it began, and the biased pitch has not spread it over everything.
//
#pragma once

#include <rosin/diagnose/pluck_effects.hpp>
#include <rosin/diagnose/pluck_score.hpp>
#include <rosin/diagnose/scene_fit.hpp>

namespace rosin {

namespace detail {

struct scored_start {
  std::vector<double> values;  ///< physical
  double gain = 0;
};

/// Cost of a fit where the channels are weighed alike; infinite where it failed.
inline double cost_of(const scene_fit& f, const std::array<double, 2>& noise) {
  double cost = 0;
  for (std::size_t c = 0; c < 2; ++c) cost += f.quality.power[c] / (noise[c] * noise[c]);
  return std::isfinite(cost) ? cost : 1e300;
}

/// The starting points of one effect at which the score peaks, the highest first.
inline std::vector<scored_start> best_starts(const pluck_score& test, const scene_plucks& with, const pluck_effect& e, std::size_t most) {
  std::vector<scored_start> all;
  for (const auto& start : e.starts) {
    const score_result s = test(with, start);
    scored_start one{start, s.gain};
    if (e.strength >= 0) {
      const auto i = static_cast<std::size_t>(e.strength);
      const effect_parameter& p = e.parameters[i];
      if (p.low >= 0 && s.mix <= 0) one.gain = 0;
      one.values[i] = std::clamp(start[i] * s.mix, p.low, p.high);
    } else if (s.mix < 0.2) {
      one.gain = 0;
    }
    all.push_back(one);
  }
  std::vector<scored_start> peaks;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].gain > 3 && (i == 0 || all[i].gain >= all[i - 1].gain) && (i + 1 == all.size() || all[i].gain > all[i + 1].gain)) peaks.push_back(all[i]);
  std::sort(peaks.begin(), peaks.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  if (peaks.size() > most) peaks.resize(most);
  return peaks;
}

/// Marks the effects with the highest gains: only these are worth a fit.
inline void note_foremost(const std::vector<double>& gains, std::size_t most, std::vector<bool>& foremost) {
  std::vector<std::size_t> order(gains.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return gains[a] > gains[b]; });
  for (std::size_t k = 0; k < std::min(most, order.size()); ++k)
    if (gains[order[k]] > 0) foremost[order[k]] = true;
}

inline Eigen::VectorXd extended(const Eigen::VectorXd& value, const pluck_effect& e, const std::vector<double>& start) {
  Eigen::VectorXd v(value.size() + static_cast<Eigen::Index>(start.size()));
  v.head(value.size()) = value;
  for (std::size_t i = 0; i < start.size(); ++i) v[value.size() + static_cast<Eigen::Index>(i)] = to_fitted(e.parameters[i], start[i]);
  return v;
}

inline std::vector<pluck_effect> with_one_more(std::vector<pluck_effect> effects, const pluck_effect& e) {
  effects.push_back(e);
  return effects;
}

/// An effect whose model holds for a short time only stays if it is the best over that time.
inline void prefer_over_one_horizon(const scene_data& data, std::vector<scene_fit>& fits, std::array<double, 2> noise) {
  const auto brief = std::find_if(fits.begin(), fits.end(), [](const scene_fit& f) { return f.horizon_periods < 1e8; });
  if (brief == fits.end()) return;
  const double cost = cost_of(*brief, noise);
  for (const scene_fit& f : fits) {
    if (f.horizon_periods < 1e8) continue;
    const scene_fit other = fit_scene(data, f.effects, f.value, {{1000, brief->horizon_periods, true, freedom::no_corrections}}, noise);
    if (cost_of(other, noise) < cost + 6) {
      fits.erase(brief);
      return;
    }
  }
  std::rotate(fits.begin(), brief, brief + 1);
}

}  // namespace detail

/// Fits of the effects `already` in the model and one more, the best first. `strong`: what is there is far off.
[[nodiscard]] inline std::vector<scene_fit> one_more_effect(const scene_data& data, const scene_fit& already, const std::vector<pluck_effect>& catalogue,
                                                            bool strong, std::array<double, 2> noise) {
  using stages = std::vector<fit_stage>;
  const stages looks = strong ? stages{{1000, 3, true, {}}, {1000, 8, true, {}}, {12, 8, false, {}}} : stages{{1000, 1e9, true, {}}};
  std::vector<std::vector<detail::scored_start>> starts(catalogue.size());
  std::vector<bool> foremost(catalogue.size(), false);
  for (const fit_stage& look : looks) {
    auto problem = data.problem(already.effects, already.value, {look.partials, look.periods, look.filtered, freedom::no_corrections}, noise);
    Eigen::VectorXd value = already.value;
    int iterations = 0;
    detail::descend(problem, problem.model(), already.value, value, 15, 1e-2, iterations);
    if (look.filtered) problem.set_noise(problem.assess(value).noise);
    const pluck_score test(problem, value);
    std::vector<double> gains(catalogue.size(), 0.0);
    for (std::size_t i = 0; i < catalogue.size(); ++i) {
      if (catalogue[i].strength < -1) {  // begins from nothing
        if (starts[i].empty()) starts[i].push_back({catalogue[i].starts[0], 0});
        continue;
      }
      const scene_plucks with(data.layout, data.guess.ac_coupled_Hz, detail::with_one_more(already.effects, catalogue[i]));
      for (auto& s : detail::best_starts(test, with, catalogue[i], strong ? 2 : 1)) {
        gains[i] = std::max(gains[i], s.gain);
        starts[i].push_back(std::move(s));
      }
    }
    detail::note_foremost(gains, strong ? 6 : 12, foremost);
  }

  const stages slowly{{6, 5, false, {}}, {12, 8, false, {}}, {24, 12, false, {}}, {1000, 12, true, {}}}, at_once{{1000, 12, true, {}}};
  const freedom some = freedom::no_corrections;
  const auto settled = [&](stages s) {
    for (auto& one : s) one.free = some;
    return s;
  };
  std::vector<scene_fit> fits;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    scene_fit best;
    double least = 1e300;
    if (!foremost[i] && catalogue[i].strength >= -1) continue;
    for (const auto& start : starts[i])
      for (const stages& how : strong ? std::vector<stages>{slowly, at_once} : std::vector<stages>{{{1000, 1e9, true, {}}}}) {
        scene_fit f = fit_scene(data, detail::with_one_more(already.effects, catalogue[i]), detail::extended(already.value, catalogue[i], start.values),
                                settled(how), noise);
        if (const double cost = detail::cost_of(f, noise); cost < least) least = cost, best = std::move(f);
      }
    if (least < 1e299) fits.push_back(std::move(best));
  }
  const auto better = [&](const scene_fit& a, const scene_fit& b) { return detail::cost_of(a, noise) < detail::cost_of(b, noise); };
  std::sort(fits.begin(), fits.end(), better);
  if (fits.size() > 5) fits.resize(5);
  for (scene_fit& f : fits) {
    stages rest = strong ? settled({{1000, 40, true, {}}, {1000, 1e9, true, {}}}) : stages{};
    const bool corrects = std::any_of(f.effects.begin(), f.effects.end(), [](const pluck_effect& e) {
      return std::any_of(e.parameters.begin(), e.parameters.end(), [](const effect_parameter& p) { return p.late; });
    });
    if (corrects) rest.push_back({1000, 1e9, true, freedom::all});
    if (!rest.empty()) f = fit_scene(data, f.effects, f.value, rest, noise);
  }
  std::sort(fits.begin(), fits.end(), better);
  detail::prefer_over_one_horizon(data, fits, noise);
  return fits;
}

}  // namespace rosin
