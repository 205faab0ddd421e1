// tier: hosted
// SPDX-License-Identifier: MIT
//
// Which effect of the catalogue, added to what is in the model already, explains most of what the plucks hold besides?
//
// Every starting point of every effect is put to a score test, which costs a millisecond; the best few of each effect are fitted
// over the first periods; and the best few of these over all of the record. Where the model is far off, the score is taken over
// the first three and eight periods: there an effect is still where it began, and a biased pitch has not spread it.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_effects.hpp>
#include <rosin/diagnose/pluck_order.hpp>
#include <rosin/diagnose/strong_starts.hpp>

#include <atomic>
#include <memory>
#include <optional>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

struct scored_start {
  std::vector<double> values;  ///< physical
  double gain = 0;
};

/// The starting points of one effect at which the score peaks, the highest first.
template <class = void>
std::vector<scored_start> best_starts(const pluck_score& test, const scene_plucks& with, const pluck_effect& e,
                                      std::size_t most) {
  std::vector<scored_start> all;
  for (const auto& start : e.starts) {
    const score_result s = test(with, start);
    scored_start one{start, s.gain};
    if (e.strength >= 0) {
      const auto i = static_cast<std::size_t>(e.strength);
      const effect_parameter& p = e.parameters[i];
      if (p.low >= 0 && s.mix <= 0) one.gain = 0;
      one.values[i] = std::clamp(start[i] * s.mix, p.low, p.high);
    } else {
      one.gain = gain_as_it_stands(s);
    }
    all.push_back(one);
  }
  std::vector<scored_start> peaks;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].gain > 3 && (i == 0 || all[i].gain >= all[i - 1].gain) && (i + 1 == all.size() || all[i].gain > all[i + 1].gain))
      peaks.push_back(all[i]);
  std::sort(peaks.begin(), peaks.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  if (peaks.size() > most) peaks.erase(peaks.begin() + static_cast<std::ptrdiff_t>(most), peaks.end());
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

/// Whether the last effect of a fit is what its name says.
inline bool is_itself(const scene_fit& f) {
  const pluck_effect& e = f.effects.back();
  return !e.is_itself || e.is_itself(f.values_of(f.effects.size() - 1));
}

inline std::vector<pluck_effect> with_one_more(std::vector<pluck_effect> effects, const pluck_effect& e) {
  effects.push_back(e);
  return effects;
}

/// Where to begin, effect by effect, and which effects are worth a fit.
struct beginnings {
  std::vector<std::vector<scored_start>> starts;
  std::vector<bool> foremost;
};

/// Beginnings of effects that are sought in what is left over, by the score over the whole record.
template <class = void>
void seek_beginnings(const scene_data& data, const scene_fit& already, const std::vector<pluck_effect>& catalogue,
                     std::array<double, 2> noise, beginnings& out) {
  if (std::none_of(catalogue.begin(), catalogue.end(), [](const pluck_effect& e) { return bool(e.seek); })) return;
  auto problem = data.problem(already.effects, already.value, {}, noise);
  std::size_t strongest = 0;
  const auto strength = [&](std::size_t t) { return already.value[data.layout.at(t, pluck_layout::strength)]; };
  for (std::size_t t = 1; t < problem.takes(); ++t)
    if (strength(t) > strength(strongest)) strongest = t;
  take_residual rest;
  rest.residual = residual_of(problem, already.value, strongest), rest.take = strongest;
  rest.begin_s = problem.part(strongest, 1).begin_s, rest.rate_Hz = problem.rate_Hz(strongest);
  const pluck_scene scene = problem.model().scene(already.value, static_cast<int>(strongest));
  for (int n = 1; scene.string.partial_Hz(n) < problem.limits().stop_Hz && n < 1000; ++n)
    rest.own_Hz.push_back(partial_between_clamps_Hz(scene, n));
  std::unique_ptr<pluck_score> test;
  for (std::size_t i = 0; i < catalogue.size(); ++i) {
    pluck_effect e = catalogue[i];
    if (!e.seek) continue;
    e.starts = e.seek(rest);
    if (e.starts.empty()) continue;
    if (!test)
      problem.set_noise(problem.assess(already.value).noise), test = std::make_unique<pluck_score>(problem, already.value);
    out.starts[i] =
        best_starts(*test, scene_plucks(data.layout, data.guess.ac_coupled_Hz, with_one_more(already.effects, e)), e, 1);
    out.foremost[i] = !out.starts[i].empty();
  }
}

template <class Real = double>
beginnings find_beginnings(const scene_data& data, const scene_fit& already, const std::vector<pluck_effect>& catalogue,
                           bool strong, std::array<double, 2> noise) {
  beginnings out{std::vector<std::vector<scored_start>>(catalogue.size()), std::vector<bool>(catalogue.size(), false)};
  std::vector<fit_stage> looks =
      strong ? std::vector<fit_stage>{{1000, 3, true}, {1000, 8, true}, {12, 8, false}} : std::vector<fit_stage>{{}};
  for (fit_stage& look : looks) look.periods = std::min(look.periods, data.most_periods_with(already.effects));
  for (const fit_stage& look : looks) {
    auto problem = data.problem(already.effects, already.value, look, noise);
    Eigen::VectorX<Real> value = already.value;
    int iterations = 0;
    descend(problem, problem.model(), already.value, value, 15, 1e-2, iterations);
    if (look.filtered) problem.set_noise(problem.assess(value).noise);
    const pluck_score test(problem, value);
    std::vector<double> gains(catalogue.size(), 0.0);
    at_once(catalogue.size(), data.options.threads, [&](std::size_t i) {
      if (catalogue[i].seek || catalogue[i].strength < -1) return;
      const scene_plucks with(data.layout, data.guess.ac_coupled_Hz, with_one_more(already.effects, catalogue[i]));
      for (auto& s : best_starts(test, with, catalogue[i], strong ? 2 : 1)) {
        gains[i] = std::max(gains[i], s.gain);
        out.starts[i].push_back(std::move(s));
      }
    });
    note_foremost(gains, strong ? 6 : 12, out.foremost);
  }
  for (std::size_t i = 0; i < catalogue.size(); ++i)
    if (!catalogue[i].seek && catalogue[i].strength < -1)  // begins from nothing
      out.starts[i] = {{catalogue[i].starts[0], 0}}, out.foremost[i] = true;
  seek_beginnings(data, already, catalogue, noise, out);
  return out;
}
ROSIN_INSTANTIATE(beginnings find_beginnings(const scene_data&, const scene_fit&, const std::vector<pluck_effect>&, bool,
                                             std::array<double, 2>))

/// The best of several ways to one effect. Where the model is far off: from the first partials of the first periods on, every
/// start for two short stages and the best of them further; and all partials at once.
template <class = void>
std::optional<scene_fit> first_fit(const scene_data& data, const scene_fit& already, const pluck_effect& e,
                                   const std::vector<scored_start>& starts, const std::vector<found_start>& found, bool strong,
                                   std::array<double, 2> noise) {
  const std::vector<pluck_effect> effects = with_one_more(already.effects, e);
  std::optional<scene_fit> best;
  const auto keep = [&](scene_fit f) {
    const double cost = cost_of(f, noise);
    if (cost < 1e299 && (!best || cost < cost_of(*best, noise))) best = std::move(f);
  };
  const auto from = [&](const scored_start& s) { return extended(data.layout, already.value, e, s.values); };
  if (!strong || e.seek) {
    const std::vector<fit_stage> stages = strong ? std::vector<fit_stage>{{1000, 24, true}, {}} : std::vector<fit_stage>{{}};
    for (const auto& s : starts) keep(fit_scene(data, effects, from(s), stages, noise));
    return best;
  }
  for (const auto& s : starts) keep(fit_scene(data, effects, from(s), {{6, 5, false}, {12, 8, false}}, noise));
  std::vector<scene_fit> further;
  if (best) further.push_back(fit_scene(data, effects, best->value, {{24, 12, false}, {1000, 12, true}}, noise));
  const auto highest =
      std::max_element(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.gain < b.gain; });
  if (highest != starts.end()) further.push_back(fit_scene(data, effects, from(*highest), {{1000, 12, true}}, noise));
  for (const found_start& f : found)
    if (f.id == e.id())
      further.push_back(fit_scene(data, effects, f.value, {{1000, 1.5, true}, {1000, 3, true}, {1000, 12, true}}, noise));
  best.reset();
  for (auto& f : further) keep(std::move(f));
  return best;
}

/// Over all of the record, with corrections freed in the end. What lies far behind is not followed further.
template <class = void>
void follow_up(const scene_data& data, std::vector<scene_fit>& fits, bool strong, std::array<double, 2> noise) {
  constexpr std::size_t most = 5, least = 2;
  if (fits.size() > most) fits.erase(fits.begin() + most, fits.end());
  while (strong && fits.size() > least && cost_of(fits.back(), noise) > 30 * cost_of(fits.front(), noise)) fits.pop_back();
  at_once(fits.size(), data.options.threads, [&](std::size_t i) {
    scene_fit& f = fits[i];
    std::vector<fit_stage> rest;
    rest.reserve(3);
    if (strong) rest.push_back({1000, 40, true}), rest.push_back({});
    const bool corrects =
        data.layout.has_ends() || std::any_of(f.effects.begin(), f.effects.end(), [](const pluck_effect& e) {
          return std::any_of(e.parameters.begin(), e.parameters.end(), [](const effect_parameter& p) { return p.late; });
        });
    if (corrects) rest.push_back({1000, 1e9, true, freedom::all});
    if (!rest.empty()) f = fit_scene(data, f.effects, f.value, rest, noise);
  });
}

}  // namespace detail

/// Fits of the effects `already` in the model and one more, the best first. `strong`: what is there is far off; effects that no
/// score tells of are then only tried if no other leaves mere noise. `known`: what earlier calls of the same recordings found.
template <class = void>
[[nodiscard]] std::vector<scene_fit> one_more_effect(const scene_data& data, const scene_fit& already,
                                                     const std::vector<pluck_effect>& catalogue, bool strong,
                                                     std::array<double, 2> noise, detail::known_starts& known) {
  const detail::beginnings begin = detail::find_beginnings(data, already, catalogue, strong, noise);
  std::vector<detail::found_start> found;
  if (strong && already.effects.empty()) found = detail::strong_starts(data, already, catalogue, noise, known);
  const auto is_found = [&](const pluck_effect& e) {
    return std::any_of(found.begin(), found.end(), [&](const auto& f) { return f.id == e.id(); });
  };
  std::vector<scene_fit> fits, sought;  // the latter over all of the record from the beginning
  std::atomic<bool> complete{false};
  for (const bool scored : {true, false}) {
    std::vector<std::size_t> tried;
    for (std::size_t i = 0; i < catalogue.size() && !complete; ++i)
      if ((catalogue[i].strength >= -1) == scored && (begin.foremost[i] || is_found(catalogue[i]))) tried.push_back(i);
    std::vector<std::optional<scene_fit>> first(tried.size());
    std::atomic<std::size_t> enough{tried.size()};  // the first that leaves mere noise, of those that no score tells of
    at_once(tried.size(), data.options.threads, [&](std::size_t k) {
      if (k > enough) return;
      first[k] = detail::first_fit(data, already, catalogue[tried[k]], begin.starts[tried[k]], found, strong, noise);
      if (!strong || !first[k] || first[k]->quality.inflation() != 1.0) return;
      complete = true;
      if (!scored)
        for (std::size_t least = enough; k < least && !enough.compare_exchange_weak(least, k);) {
        }
    });
    for (std::size_t k = 0; k < std::min(tried.size(), enough + 1); ++k)
      if (first[k]) (catalogue[tried[k]].seek ? sought : fits).push_back(*std::move(first[k]));
  }
  std::sort(fits.begin(), fits.end(),
            [&](const auto& a, const auto& b) { return detail::price_of(a, noise) < detail::price_of(b, noise); });
  detail::follow_up(data, fits, strong, noise);
  fits.insert(fits.end(), sought.begin(), sought.end());
  std::erase_if(fits, [](const scene_fit& f) { return !detail::is_itself(f); });
  detail::put_in_order(data, already, fits, noise);
  return fits;
}
ROSIN_INSTANTIATE(std::vector<scene_fit> one_more_effect(const scene_data&, const scene_fit&, const std::vector<pluck_effect>&,
                                                         bool, std::array<double, 2>, detail::known_starts&))
template <class = void>
[[nodiscard]] std::vector<scene_fit> one_more_effect(const scene_data& data, const scene_fit& already,
                                                     const std::vector<pluck_effect>& catalogue, bool strong,
                                                     std::array<double, 2> noise) {
  detail::known_starts none;
  return one_more_effect(data, already, catalogue, strong, noise, none);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
