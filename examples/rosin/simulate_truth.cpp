// SPDX-License-Identifier: MIT
#include "simulate_truth.hpp"

namespace tool {

namespace {

json string_json(const simulation_plan& plan) {
  const auto& s = plan.rig.string;
  return {{"length_m", s.length_m},
          {"tension_N", s.tension_N},
          {"fundamental_Hz", s.fundamental_Hz},
          {"bending_stiffness_Nm2", s.bending_stiffness_Nm2},
          {"impedance_Ns_m", s.impedance_Ns_m()},
          {"quality", s.loss.quality},
          {"loss_internal_s", s.loss.internal_s},
          {"loss_air_sqrt_Hz", s.loss.air_sqrt_Hz}};
}

json torsion_json(const simulation_plan& plan) {
  const auto& t = plan.rig.torsion;
  return t.present() ? json{{"speed_ratio", t.speed_ratio}, {"impedance_ratio", t.impedance_ratio}, {"q", t.quality}}
                     : json(nullptr);
}

json channels_json(const simulation_plan& plan) {
  json out = json::object();
  for (const auto& c : plan.channels) {
    const double full = c.declared.per_full_scale.value_or(1);
    out[c.declared.name] = {{"quantity", rosin::name_of(c.declared.quantity)},
                            {"gain", c.gain},
                            {"declared_per_full_scale", c.declared.per_full_scale ? json(full) : json(nullptr)},
                            {"noise", c.noise_share * full},
                            {"ac_coupled_Hz", c.declared.ac_coupled_Hz ? json(*c.declared.ac_coupled_Hz) : json(nullptr)}};
  }
  return out;
}

json ends_json(const simulation_plan& plan) {
  json out = json::object();
  for (std::size_t e = 0; e < 2; ++e) {
    json modes = json::array();
    const auto add = [&](double frequency_Hz, double q, double mass_kg) {
      modes.push_back({{"frequency_Hz", frequency_Hz}, {"q", q}, {"mass_kg", mass_kg}});
    };
    for (const auto& m : plan.burden.string.ends[e].modes)
      add(m.frequency_Hz, m.q, plan.rig.string.impedance_Ns_m() / m.per_mass_per_s);
    if (const auto& s = plan.burden.string.supports[e]; s.mass_kg > 0) add(s.frequency_Hz, s.quality, s.mass_kg);
    out[e == 0 ? "near" : "far"] = modes;
    if (const double c = plan.burden.string.clamping[e]; c > 0) out[e == 0 ? "near_clamping" : "far_clamping"] = c;
  }
  return out;
}

json profile_json(const rosin::profile& points) {
  json out = json::array();
  for (const auto& [t, y] : points) out.push_back({t, y});
  return out;
}

json energy_json(const std::optional<rosin::stroke_energy>& e) {
  if (!e) return nullptr;
  const auto motion = [](const rosin::motion_energy& m) {
    return json{{"received_J", m.received_J}, {"stored_J", m.stored_J}, {"lost_J", m.lost_J}};
  };
  return {{"rod_J", e->rod_J},
          {"friction_J", e->friction_J},
          {"transverse", motion(e->transverse)},
          {"torsion", motion(e->torsion)},
          {"left_out_J", e->left_out_J},
          {"string_error", e->string_error()},
          {"error", e->error()}};
}

json bow_json(const true_take& take, const simulated_take& simulated) {
  const auto& rod = take.rod;
  json out{{"position", take.position}};
  if (!rod.place.empty()) out["position_profile"] = profile_json(rod.place);
  if (rod.speed_m_s.empty())
    out.update({{"speed_m_s", rod.steady.speed_m_s}, {"start_s", rod.steady.start_s}, {"rise_s", rod.steady.rise_s}});
  else out["speed_profile_m_s"] = profile_json(rod.speed_m_s);
  if (rod.normal_force_N.empty()) out["normal_force_N"] = rod.steady.normal_force_N;
  else out["normal_force_profile_N"] = profile_json(rod.normal_force_N);
  out["motion"] = name_of(motion_of(simulated.truth));
  out["slips"] = simulated.truth.slips;
  out["unconverged_steps"] = simulated.truth.unconverged;
  out["energy"] = energy_json(simulated.truth.energy);
  return out;
}

json take_json(const true_take& take, const simulated_take& simulated, const std::string& table) {
  json out{{"name", take.declared.name}, {"kind", rosin::name_of(take.declared.kind)}, {"file", take.declared.file}};
  if (take.declared.kind == rosin::take_kind::pluck)
    out.update({{"position", take.position}, {"force_N", take.pluck.force_N}, {"release_s", take.pluck.release_s}});
  if (take.declared.kind == rosin::take_kind::bow) out.update(bow_json(take, simulated));
  out["clipped_samples"] = simulated.clipped;
  out["table"] = table.empty() ? json(nullptr) : json(table);
  return out;
}

}  // namespace

std::string name_of(rosin::bowed_motion motion) {
  if (motion == rosin::bowed_motion::sticking) return "sticking";
  return motion == rosin::bowed_motion::stick_slip ? "stick-slip" : "sliding";
}

rosin::table truth_table(const simulation_plan& plan, const rosin::modal_take& take, std::vector<std::string> comments) {
  rosin::table out{std::move(comments), {}};
  std::vector<double> time(take.size());
  for (std::size_t n = 0; n < time.size(); ++n) time[n] = static_cast<double>(n) / take.sample_rate_Hz;
  out.add("time_s", std::move(time), 12);
  out.add("force_N", take.contact_force_N);
  out.add("velocity_m_s", take.centre_velocity_m_s);
  out.add("torsion_velocity_m_s", take.torsion_velocity_m_s);
  out.add("rod_velocity_m_s", take.rod_velocity_m_s);
  if (take.temperature_rise_K.empty()) return out;
  auto temperature = take.temperature_rise_K;
  for (double& t : temperature) t += 273.15 + plan.friction.ambient_C;
  out.add("temperature_K", std::move(temperature));
  return out;
}

json truth_document(const simulation_plan& plan, const std::vector<simulated_take>& takes, const std::vector<std::string>& tables,
                    const provenance& from) {
  const auto filter = plan.settings.low_pass();
  json out{{"schema", 1}, {"provenance", from.to_json()}, {"seed", plan.seed}};
  out["string"] = string_json(plan);
  out["torsion"] = torsion_json(plan);
  out["terminations"] = ends_json(plan);
  if (!plan.effects.empty()) out["effects"] = plan.effects;
  out["friction"] = plan.friction.to_json();
  out["channels"] = channels_json(plan);
  out["sample_rate_Hz"] = plan.settings.sample_rate_Hz;
  out["bits"] = plan.bits;
  out["low_pass"] = {{"pass_Hz", filter.pass_Hz()}, {"stop_Hz", filter.stop_Hz()}};
  out["simulation"] = {
      {"method", plan.burden.none()
                     ? "modes of the pinned stiff string, stepped exactly"
                     : "modes of the stiff string, stepped exactly; what it carries and ends on is solved for in every step"},
      {"oversampling", plan.settings.oversampling},
      {"mode_limit_Hz", plan.settings.mode_limit_Hz}};
  out["takes"] = json::array();
  for (std::size_t i = 0; i < takes.size(); ++i) out["takes"].push_back(take_json(plan.takes[i], takes[i], tables[i]));
  out["notes"] = plan.notes;
  out["assumed"] = plan.assumed;
  return out;
}

}  // namespace tool
