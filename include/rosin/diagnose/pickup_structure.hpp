// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the partials of all ringings are, before asking what law they follow: single lines, pairs with one detuning, pairs each of
// its own; steady in pitch, or gliding. All of these are fitted to the same tracks, with frequency, decay and amplitude of every
// partial free, and the likeliest is kept (Schwarz: each free number costs half the logarithm of the numbers it is taken from). A
// glide and a pair look alike for a while, so both orders of finding them are tried. An effect has to show in most partials: a
// neighbour can look like anything, but in one partial only.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pickup_glide_path.hpp>

#include <limits>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What may be there, and what the declared model holds already.
struct structure_question {
  bool glide = true, pairs = true;                      ///< may be found
  bool glide_declared = false, pairs_declared = false;  ///< are taken for granted
  std::vector<bool> power_known;                        ///< per ringing
};

struct structure_hypothesis {
  bool glides = false, paired = false, doubled = false;
  std::vector<glide_found> glide;  ///< per ringing, where it glides
  pair_found pair;                 ///< where it is paired
  double evidence = 0;             ///< natural logarithm, against single steady lines
};

namespace detail {

inline constexpr double agreement = 0.6;

template <class = void>
pickup_ringing steady(const pickup_ringing& r, const glide_found& g) {
  pickup_ringing out = r;
  if (g.relative > 0)
    for (auto& t : out.tracks) t = without_glide(t, path_along(g.shape, t), g.relative, 1.5 * r.tolerance_Hz);
  return out;
}
ROSIN_INSTANTIATE(pickup_ringing steady(const pickup_ringing&, const glide_found&))
template <class = void>
std::vector<pickup_ringing> steady(const std::vector<pickup_ringing>& all, const std::vector<glide_found>& g) {
  std::vector<pickup_ringing> out;
  for (std::size_t i = 0; i < all.size(); ++i) out.push_back(steady(all[i], g[i]));
  return out;
}
ROSIN_INSTANTIATE(std::vector<pickup_ringing> steady(const std::vector<pickup_ringing>&, const std::vector<glide_found>&))

inline std::vector<const partial_track*> clearest_of(const std::vector<pickup_ringing>& all) {
  std::vector<const partial_track*> out;
  for (const auto& r : all)
    for (const std::size_t i : clearest(r)) out.push_back(&r.tracks[i]);
  return out;
}

template <class = void>
structure_hypothesis with_glide(const std::vector<pickup_ringing>& all, const structure_question& ask,
                                const structure_hypothesis& base) {
  structure_hypothesis h = base;
  h.glides = false;
  for (std::size_t i = 0; i < all.size(); ++i) {
    glide_found g = find_glide(all[i], ask.power_known[i], base.paired ? base.pair.detuning : 0);
    const double worth = g.gain - std::log(static_cast<double>(all[i].tracks.size()) * 100);
    if (!(g.relative > 0) || !(worth > 0) || g.agreeing < agreement || !(g.relative > 3 * g.sd))
      g.relative = 0, g.sd = 0, g.gain = 0;
    else h.evidence += worth, h.glides = true;
    h.glide.push_back(g);
  }
  return h;
}

template <class = void>
structure_hypothesis with_pairs(const std::vector<pickup_ringing>& all, const structure_hypothesis& base) {
  structure_hypothesis h = base;
  const auto still = base.glides ? steady(all, base.glide) : all;
  const auto tracks = clearest_of(still);
  h.pair = find_pair(tracks);
  double cost = 5;
  for (const auto* t : tracks) cost += std::log(std::max(numbers_in(*t), 2.0));
  h.paired = h.pair.gain > cost && h.pair.agreeing > agreement;
  if (h.paired) h.evidence += h.pair.gain - cost;
  return h;
}

/// Pairs each of its own.
template <class = void>
structure_hypothesis with_doubles(const std::vector<pickup_ringing>& all, const structure_hypothesis& base) {
  structure_hypothesis h = base;
  const auto still = base.glides ? steady(all, base.glide) : all;
  double count = 0, doubled = 0;
  for (const auto& r : still)
    for (const std::size_t i : clearest(r)) {
      const partial_track& t = r.tracks[i];
      const line_fit two =
          one_or_two_lines(t.samples, t.rate_Hz, t.fit, 1.5 * r.tolerance_Hz, filled_with_noise(t.window, t.rate_Hz));
      count += 1;
      if (two.model.parts.size() < 2) continue;
      doubled += 1;
      h.evidence +=
          log_likelihood(t, two.residual) - log_likelihood(t, t.fit.residual) - 2 * std::log(std::max(numbers_in(t), 2.0));
    }
  h.doubled = doubled > 0.4 * count;
  if (!h.doubled) h.evidence = base.evidence;
  return h;
}

/// Glide and pairs together: the strength of each once more with the other known.
template <class = void>
structure_hypothesis refined(const std::vector<pickup_ringing>& all, structure_hypothesis h) {
  if (!h.glides || !h.paired) return h;
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (h.glide[i].relative > 0) h.glide[i] = glide_search(all[i], h.glide[i].shape, h.pair.detuning).best(h.glide[i].relative);
    const auto still = steady(all, h.glide);
    const double before = h.pair.gain;
    h.pair = find_pair(clearest_of(still));
    h.evidence += h.pair.gain - before;
  }
  return h;
}

}  // namespace detail

/// All that was tried, the likeliest first; but two effects only where the second is worth three tenths of what one alone is,
/// since no model of a glide is exact, and what one effect leaves another one takes up.
template <class = void>
[[nodiscard]] std::vector<structure_hypothesis> structures_of(const std::vector<pickup_ringing>& all,
                                                              const structure_question& ask) {
  std::vector<structure_hypothesis> tried{{}};
  const bool glide = ask.glide || ask.glide_declared, pairs = ask.pairs || ask.pairs_declared;
  if (glide) tried.push_back(detail::with_glide(all, ask, {}));
  if (pairs) {
    const std::size_t steps = tried.size();
    for (std::size_t i = 0; i < steps; ++i) {
      if (i > 0 && !tried[i].glides) continue;
      tried.push_back(detail::refined(all, detail::with_pairs(all, tried[i])));
      if (i == 0 && glide && tried.back().paired)
        tried.push_back(detail::refined(all, detail::with_glide(all, ask, tried.back())));
      tried.push_back(detail::with_doubles(all, tried[i]));
    }
  }
  double alone = 0;
  const auto effects = [](const structure_hypothesis& h) { return (h.glides ? 1 : 0) + (h.paired || h.doubled ? 1 : 0); };
  for (const auto& h : tried)
    if (effects(h) == 1) alone = std::max(alone, h.evidence);
  std::erase_if(tried, [&](const auto& h) {
    return effects(h) == 2 && h.evidence < 1.3 * alone && !(ask.glide_declared || ask.pairs_declared);
  });
  std::stable_sort(tried.begin(), tried.end(), [](const auto& a, const auto& b) { return a.evidence > b.evidence; });
  return tried;
}
ROSIN_INSTANTIATE(std::vector<structure_hypothesis> structures_of(const std::vector<pickup_ringing>&, const structure_question&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
