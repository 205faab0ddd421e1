// SPDX-License-Identifier: MIT
#include "diagnose_parts.hpp"
#include "pluck_input.hpp"

namespace tool {

namespace {

bool has(const std::vector<std::string>& names, const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); }

}  // namespace

rosin::outcome<rosin::pluck_diagnosis> diagnose_plucks_of(const rosin::rig& rig, const rosin::rig_values& values, provenance& from, rig_diagnosis& d) {
  rig_plucks plucks = read_plucks(rig, from);
  d.warnings.insert(d.warnings.end(), plucks.warnings.begin(), plucks.warnings.end());
  auto& [takes, held, warnings, incomplete] = plucks;
  if (takes.empty() && held.empty()) return rosin::failure{rig.file + ": no pluck to compare with"};
  if (takes.empty()) return rosin::failure{rig.file + ": every pluck is marked hold_out: none is left to fit"};
  if (held.empty() && takes.size() > 1) {  // the last of several: one that nothing is fitted to
    held.push_back(std::move(takes.back()));
    takes.pop_back();
  }

  const std::vector<std::string> physics = rig.model ? rig.model->physics : std::vector<std::string>{};
  rosin::pluck_options options;
  options.stiffness = has(physics, "bending-stiffness");
  options.internal_loss = has(physics, "frequency-dependent-loss");
  options.air_loss = has(physics, "air-loss");
  rosin::pluck_guess guess = guess_of(rig, values);
  if (!options.stiffness) guess.inharmonicity = 0;
  const double impedance = values.impedance_Ns_m ? values.impedance_Ns_m->value : 0, length = values.length_m ? values.length_m->value : 0;
  const double rate = takes.front().rate_Hz;
  const std::size_t count = takes.size();
  return rosin::diagnose_plucks(takes, held, guess, options, [=](const rosin::pluck_fit_result& fit) {
    const rosin::string_facts facts{fit.value[rosin::pluck_layout::fundamental], rate, fit.limits.stop_Hz, impedance, length, count};
    return rosin::catalogue_without(physics, facts, fit.limits);
  });
}

}  // namespace tool
