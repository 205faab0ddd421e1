// SPDX-License-Identifier: MIT
#include "diagnose_rig.hpp"
#include "digits.hpp"
#include "pluck_input.hpp"
#include "rig_ends.hpp"

#include <rosin/acquire/rig_values.hpp>
#include <rosin/diagnose/isolability.hpp>
#include <rosin/diagnose/pluck_diagnosis.hpp>

namespace tool {

rosin::outcome<json> isolability_of(const rosin::rig& rig, double rate_Hz, double noise_N) {
  const rosin::rig_values values = rosin::values_of(rig);
  rosin::planned_plucks plan;
  for (const auto& take : rig.takes) {
    const auto position = rig.position_of(take);
    if (take.kind == rosin::take_kind::pluck && position)
      plan.takes.push_back({take.name, rate_Hz, {}, take.force_N.value_or(1), take.force_tolerance.value_or(0.03), *position});
  }
  if (plan.takes.empty()) return rosin::failure{rig.file + ": no pluck with a position is announced"};
  const auto physics = physics_of(rig);
  plan.guess = guess_of(rig, values);
  plan.options = options_for(physics);
  if (!plan.options.stiffness) plan.guess.inharmonicity = 0;
  std::vector<std::string> remarks;
  if (auto why = add_known_ends(rig, values, plan.guess, remarks)) return *std::move(why);
  plan.noise_N = noise_N;
  const double impedance = values.impedance_Ns_m ? values.impedance_Ns_m->value : 0,
               length = values.length_m ? values.length_m->value : 0;
  const rosin::band limits = plan.options.limits_for(rate_Hz);
  const rosin::string_facts facts{plan.guess.fundamental_Hz, rate_Hz, limits.stop_Hz, impedance, length, plan.takes.size()};
  auto effects = rosin::still_to_add(rosin::catalogue_without(physics, facts, limits), {});
  std::erase_if(effects, [](const rosin::pluck_effect& e) { return e.variant == "each"; });  // of planned plucks all alike
  const auto found = rosin::isolability_of(plan, effects);
  json out{{"rig", rig.title.value_or(rig.file)}, {"sampling_rate_Hz", rate_Hz}, {"noise_N", noise_N},
           {"seconds", plan.duration_s},          {"assumed", values.assumed},   {"warnings", remarks}};
  out["effects"] = json::array(), out["cosine"] = json::array(), out["classes"] = json::array();
  for (std::size_t i = 0; i < found.ids.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    json one{{"effect", found.ids[i]}, {"surviving", found.surviving[row]}, {"detectable", nullptr}};
    if (std::isfinite(found.detectable[row]))
      one["detectable"] = {{"parameter", found.strength[i]}, {"value", found.detectable[row]}};
    out["effects"].push_back(std::move(one));
    std::vector<double> cosines(found.ids.size());
    for (std::size_t j = 0; j < cosines.size(); ++j) cosines[j] = found.cosine(row, static_cast<Eigen::Index>(j));
    out["cosine"].push_back(cosines);
  }
  for (const auto& c : found.classes()) {
    std::vector<std::string> names;
    for (const auto i : c) names.push_back(found.ids[i]);
    out["classes"].push_back(names);
  }
  return out;
}

std::string isolability_text(const json& j) {
  std::string out = j.at("rig").get<std::string>() + ": what " + in_digits(1e3 * j.at("seconds").get<double>()) +
                    " ms of its plucks can tell apart\n";
  for (const auto& w : j.at("warnings")) out += "  " + w.get<std::string>() + "\n";
  for (const auto& e : j.at("effects")) {
    out += "  " + e.at("effect").get<std::string>();
    if (e.at("detectable").is_object())
      out += ": seen from " + e.at("detectable").at("parameter").get<std::string>() + " = " +
             in_digits(e.at("detectable").at("value"), "%.2g") + " on (five standard deviations)";
    out += ", " + in_digits(100 * e.at("surviving").get<double>(), "%.0f") + " % of it left by the nuisances\n";
  }
  for (const auto& c : j.at("classes")) {
    if (c.size() < 2) continue;
    std::string names;
    for (const auto& n : c) names += (names.empty() ? "" : ", ") + n.get<std::string>();
    out += "cannot be told apart: " + names + "\n";
  }
  return out;
}

}  // namespace tool
