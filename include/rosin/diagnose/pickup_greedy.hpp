// tier: hosted
// SPDX-License-Identifier: MIT
//
// Which effects does a table of partials call for? One after the other: the effect that raises the evidence most is kept if it is
// worth it, if it foretells partials that were set aside better, and if it is no crumb of what was found before. Those found
// earlier are then asked whether they are still needed, and whether another would now do better in their place.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pickup_effects.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct greedy_limits {
  double worth = 9;     ///< natural logarithm of the evidence
  double crumb = 0.08;  ///< of what was gained so far
  double certain = 3;   ///< standard deviations that its strength is away from nothing
  double alike = 5;     ///< nearer than that cannot be told apart
  int most = 4;
  double pitch_Hz = 0,
         pitch_sd = 0.005;  ///< as declared, 0: not; relative. A law that takes the string far from it has to be better for it
};

struct found_in_law {
  law_effect effect;
  double gain = 0;
  std::vector<std::string> alike;
};

struct law_search {
  fitted_law declared, best;
  std::vector<found_in_law> found;
  std::vector<std::pair<std::string, double>> alone;  ///< each effect by itself: evidence against the declared law
  double gain = 0;                                    ///< of all found together
};

namespace detail {

/// Evidence, with the declared pitch as a measurement that may be wrong altogether.
inline double worth_of(const fitted_law& f, std::size_t lines, const greedy_limits& limits) {
  const double off = limits.pitch_Hz > 0 ? std::pow((f.law.fundamental_Hz / limits.pitch_Hz - 1) / limits.pitch_sd, 2) : 0.0;
  return evidence_of(f, lines) - 0.5 * off / (1 + off / 100);
}

struct tried_effect {
  const law_effect* effect;
  fitted_law fit;
  double evidence;
};

template <class = void>
std::vector<tried_effect> try_each(const line_table& table, const fitted_law& base, const std::vector<law_effect>& catalogue,
                                   const greedy_limits& limits) {
  std::vector<tried_effect> out;
  for (const auto& e : catalogue) {
    const bool there =
        std::any_of(base.parameters.begin(), base.parameters.end(), [&](const auto& p) { return p.member == e.strength; });
    if (there || 2 * table.lines.size() < base.parameters.size() + e.parameters.size() + 4) continue;
    fitted_law f = with_effect(table, base, e);
    out.push_back({&e, f, worth_of(f, table.lines.size(), limits)});
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.evidence > b.evidence; });
  return out;
}

template <class = void>
fitted_law without_effect(const line_table& table, const fitted_law& fit, const law_effect& e) {
  fitted_law less = fit;
  std::erase_if(less.parameters, [&](const auto& p) {
    return std::any_of(e.parameters.begin(), e.parameters.end(), [&](const auto& q) { return q.member == p.member; });
  });
  pickup_law start = fit.law;
  start.*e.strength = 0;
  return fit_law(table, less.parameters, start);
}

/// Each effect found is taken out and sought anew: it stays, makes room for a better one, or goes.
template <class = void>
void exchange(const line_table& table, const std::vector<law_effect>& catalogue, const greedy_limits& limits, law_search& s) {
  for (std::size_t i = 0; i < s.found.size() && s.found.size() > 1;) {
    const fitted_law less = without_effect(table, s.best, s.found[i].effect);
    const double now = worth_of(s.best, table.lines.size(), limits), before = worth_of(less, table.lines.size(), limits);
    if (now - before < limits.worth) {
      s.best = less;
      s.found.erase(s.found.begin() + static_cast<std::ptrdiff_t>(i));
      continue;
    }
    const auto others = try_each(table, less, catalogue, limits);
    if (!others.empty() && others.front().evidence > now + 3 && others.front().effect->name != s.found[i].effect.name)
      s.best = others.front().fit, s.found[i] = {*others.front().effect, others.front().evidence - before, {}};
    ++i;
  }
}
ROSIN_INSTANTIATE(void exchange(const line_table&, const std::vector<law_effect>&, const greedy_limits&, law_search&))

}  // namespace detail

/// `held`: partials that are predicted only; those above all of the table are not asked for, and none are where that leaves fewer
/// than four.
template <class = void>
[[nodiscard]] law_search search_law(const line_table& table, const fitted_law& declared, const std::vector<law_effect>& catalogue,
                                    line_table held = {}, const greedy_limits& limits = {}) {
  std::erase_if(held.lines, [&](const string_line& l) { return l.number > table.lines.back().number; });
  law_search s{declared, declared, {}, {}, 0};
  const double nothing = detail::worth_of(declared, table.lines.size(), limits);
  for (int round = 0; round < limits.most; ++round) {
    const auto tried = detail::try_each(table, s.best, catalogue, limits);
    const double now = detail::worth_of(s.best, table.lines.size(), limits);
    if (round == 0)
      for (const auto& t : tried) s.alone.emplace_back(t.effect->name, std::max(t.evidence - nothing, -1e3));
    const auto good = [&](const detail::tried_effect& t) {
      const bool foretells =
          held.lines.size() < 4 || predicted_log_likelihood(held, t.fit) > predicted_log_likelihood(held, s.best);
      const auto strength = std::find_if(t.fit.parameters.begin(), t.fit.parameters.end(),
                                         [&](const auto& p) { return p.member == t.effect->strength; });
      const bool there = t.fit.law.*t.effect->strength > limits.certain * t.fit.sd_of(strength->name);
      return t.evidence - now > std::max(limits.worth, limits.crumb * (now - nothing)) && foretells && there;
    };
    auto best = std::find_if(tried.begin(), tried.end(), good);
    if (best == tried.end()) break;
    for (auto other = best + 1; other != tried.end(); ++other)  // of those that cannot be told apart the simplest
      if (other->evidence > tried.front().evidence - limits.alike &&
          other->effect->parameters.size() < best->effect->parameters.size() && good(*other))
        best = other;
    found_in_law f{*best->effect, best->evidence - now, {}};
    for (const auto& t : tried)
      if (t.effect != best->effect && t.evidence > tried.front().evidence - limits.alike) f.alike.push_back(t.effect->name);
    s.best = best->fit;
    s.found.push_back(std::move(f));
    detail::exchange(table, catalogue, limits, s);
  }
  s.gain = detail::worth_of(s.best, table.lines.size(), limits) - nothing;
  return s;
}
ROSIN_INSTANTIATE(law_search search_law(const line_table&, const fitted_law&, const std::vector<law_effect>&, line_table,
                                        const greedy_limits&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
