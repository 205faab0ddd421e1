// SPDX-License-Identifier: MIT
#include "diagnose_parts.hpp"
#include "pluck_input.hpp"
#include "rig_ends.hpp"

#include <algorithm>

namespace tool {

rosin::outcome<plucks_to_diagnose> plucks_of(const rosin::rig& rig, const rosin::rig_values& values, provenance& from) {
  rig_plucks plucks = read_plucks(rig, from);
  plucks_to_diagnose out{std::move(plucks.takes), std::move(plucks.held_out), guess_of(rig, values), options_for(physics_of(rig)),
                         std::move(plucks.warnings)};
  if (out.takes.empty() && out.held.empty()) return failed(rig.file + ": no pluck to compare with", out.warnings);
  if (out.takes.empty()) return failed(rig.file + ": every pluck is marked hold_out: none is left to fit", out.warnings);
  if (out.held.empty() && out.takes.size() > 1) {  // the last of several: one that nothing is fitted to
    out.held.push_back(std::move(out.takes.back()));
    out.takes.pop_back();
    out.marked = false;
  }
  if (!out.options.stiffness) out.guess.inharmonicity = 0;
  if (auto why = add_known_ends(rig, values, out.guess, out.warnings)) return *std::move(why);
  return out;
}

namespace {

/// Of two plucks one alone does not tell what depends on the strength: both are fitted where that explains them to the noise. What
/// the rig file marks as held out stays so.
std::optional<rosin::pluck_diagnosis> by_both(const plucks_to_diagnose& plucks, const auto& catalogue) {
  if (plucks.marked || plucks.takes.size() != 1) return std::nullopt;
  auto found = rosin::diagnose_plucks({plucks.takes[0], plucks.held[0]}, {}, plucks.guess, plucks.options, catalogue);
  if (!found || !found->explained || found->best.effects.empty() || found->best.quality.inflation() != 1.0) return std::nullopt;
  found->held_out.clear();
  return *std::move(found);
}

}  // namespace

rosin::outcome<plucks_told> diagnose_plucks_of(const rosin::rig& rig, const rosin::rig_values& values, provenance& from,
                                               std::vector<std::string>& warnings, const std::vector<std::string>& without,
                                               int threads) {
  auto plucks = plucks_of(rig, values, from);
  if (!plucks) return rosin::failure{plucks.error()};
  plucks->options.threads = threads;
  warnings.insert(warnings.end(), plucks->warnings.begin(), plucks->warnings.end());
  const double impedance = values.impedance_Ns_m ? values.impedance_Ns_m->value : 0,
               length = values.length_m ? values.length_m->value : 0;
  const double rate = plucks->takes.front().rate_Hz;
  std::vector<std::string> known = physics_of(rig);
  known.insert(known.end(), without.begin(), without.end());
  const auto catalogue = [=](const rosin::pluck_fit_result& fit) {
    const rosin::string_facts facts{
        fit.value[rosin::pluck_layout::fundamental], rate, fit.limits.stop_Hz, impedance, length, fit.layout.takes()};
    return rosin::catalogue_without(known, facts, fit.limits);
  };
  const bool may_rattle = impedance > 0 && std::find(known.begin(), known.end(), "rattle") == known.end();
  const auto look_for_obstacle = [&](rosin::odd_pluck& odd) {
    if (may_rattle && !odd.lost && !odd.moved) odd.met = rosin::find_rattle(odd, impedance);
  };
  auto found = rosin::diagnose_plucks(plucks->takes, plucks->held, plucks->guess, plucks->options, catalogue);
  rosin::pluck_guess told = plucks->guess;
  if (!found) {  // of one of another string or pitch nothing rings as declared together
    auto odd = rosin::find_odd_pluck(plucks->takes, plucks->held, told, plucks->options, catalogue);
    if (!odd) return failed(found.error(), plucks->warnings);
    look_for_obstacle(*odd);
    return plucks_told{odd->others, std::move(odd)};
  }
  if (!found->explained && may_rattle)
    if (auto all = rosin::find_rattling_string(plucks->takes, plucks->held, plucks->guess, plucks->options, impedance)) {
      all->others.ranking = found->ranking;
      return plucks_told{*std::move(found), std::move(all)};
    }
  if (!found->explained)
    if (auto both = by_both(*plucks, catalogue)) {
      *found = *std::move(both);
      warnings.emplace_back(
          "two plucks only: both were fitted, as one does not tell what depends on its strength; none was kept to judge by");
    }
  plucks_told out{*std::move(found), {}};
  if (out.found.explained) return out;
  told.ends = out.found.data.layout.ends(out.found.best.value);
  out.odd = rosin::find_odd_pluck(plucks->takes, plucks->held, told, plucks->options, catalogue);
  if (out.odd) look_for_obstacle(*out.odd);
  if (!may_rattle || (out.odd && (out.odd->lost || out.odd->moved || out.odd->met))) return out;
  if (auto some = rosin::find_rattling_plucks(plucks->takes, plucks->held, told, plucks->options, catalogue, impedance))
    out.odd = std::move(some);
  return out;
}

}  // namespace tool
