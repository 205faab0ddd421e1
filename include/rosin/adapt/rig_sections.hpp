// tier: hosted
// SPDX-License-Identifier: MIT
//
// The tables of a rig file apart from its takes, key by key, each with the range that is physically possible. The ranges
// are generous on purpose: they catch a wrong unit or sign, not an unusual string.
//
#pragma once

#include <rosin/acquire/effect_names.hpp>
#include <rosin/acquire/rig.hpp>
#include <rosin/adapt/toml_fields.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin::detail {

inline string_section read_string(toml_fields fields) {
  string_section s;
  s.fundamental_Hz = fields.required_number("fundamental_Hz", up_to(1e5));
  s.length_m = fields.number("length_m", up_to(1e3));
  s.tension_N = fields.number("tension_N", up_to(1e6));
  s.bending_stiffness_Nm2 = fields.number("bending_stiffness_Nm2", zero_to(1e3));
  s.impedance_Ns_m = fields.number("impedance_Ns_m", up_to(1e4));
  s.diameter_m = fields.number("diameter_m", up_to(0.1));
  s.density_kg_m3 = fields.number("density_kg_m3", up_to(3e4));
  s.youngs_modulus_Pa = fields.number("youngs_modulus_Pa", up_to(2e12));
  s.quality = fields.number("quality", {1, 1e7});
  s.loss_internal_s = fields.number("loss_internal_s", zero_to(1));
  s.loss_air_sqrt_Hz = fields.number("loss_air_sqrt_Hz", zero_to(10));
  s.length_tolerance = fields.number("length_tolerance", zero_to(0.5));
  s.tension_tolerance = fields.number("tension_tolerance", zero_to(0.9));
  s.fundamental_tolerance = fields.number("fundamental_tolerance", zero_to(0.5));
  s.bending_stiffness_tolerance = fields.number("bending_stiffness_tolerance", zero_to(0.99));
  s.impedance_tolerance = fields.number("impedance_tolerance", zero_to(0.9));
  fields.unknown();
  return s;
}

inline torsion_section read_torsion(toml_fields fields) {
  torsion_section t;
  t.speed_ratio = fields.required_number("speed_ratio", up_to(100));
  t.impedance_ratio = fields.required_number("impedance_ratio", up_to(1000));
  t.q = fields.required_number("q", {0.5, 1e6});
  fields.unknown();
  return t;
}

inline model_section read_model(toml_fields fields) {
  model_section m;
  if (const auto law = fields.choice("friction", friction_model_names)) m.friction = static_cast<friction_model>(*law);
  const auto* list = fields.list("physics", "a list of effect names");
  for (std::size_t i = 0; list != nullptr && i < list->size(); ++i) {
    const auto* name = list->get(i)->as_string();
    const std::string place = fields.path("physics") + "[" + std::to_string(i) + "]";
    if (name == nullptr) fields.wrong_type(*list->get(i), place, "the name of an effect, in quotes");
    else if (!is_effect_name(name->get()))
      fields.problem(*name, place, "unknown effect \"" + name->get() + "\"" + suggestion(name->get(), effect_names));
    else m.physics.push_back(name->get());
  }
  fields.unknown();
  return m;
}

inline friction_section read_friction(toml_fields fields) {
  friction_section f;
  fields.each_table("terms", "a list, as [ { coefficient = 0.4, speed_m_s = 0.01 } ]", [&](toml_fields term) {
    f.terms.push_back({term.required_number("coefficient", up_to(10)), term.required_number("speed_m_s", up_to(100))});
    term.unknown();
  });
  f.constant = fields.number("constant", zero_to(10));
  f.contact_radius_m = fields.number("contact_radius_m", up_to(0.01));
  f.layer_thickness_m = fields.number("layer_thickness_m", up_to(0.001));
  f.ambient_C = fields.number("ambient_C", {-50, 100});
  f.bristle_stiffness_N_m = fields.number("bristle_stiffness_N_m", up_to(1e9));
  f.bristle_damping_Ns_m = fields.number("bristle_damping_Ns_m", zero_to(1e4));
  f.break_away_fraction = fields.number("break_away_fraction", inside_unit);
  f.static_coefficient = fields.number("static_coefficient", up_to(10));
  f.dynamic_coefficient = fields.number("dynamic_coefficient", up_to(10));
  f.stribeck_speed_m_s = fields.number("stribeck_speed_m_s", up_to(100));
  f.viscous_Ns_m = fields.number("viscous_Ns_m", zero_to(1e4));
  if (f.static_coefficient && f.dynamic_coefficient && *f.static_coefficient < *f.dynamic_coefficient)
    fields.refuse("static_coefficient", "is smaller than dynamic_coefficient");
  fields.unknown();
  return f;
}

inline files_section read_files(toml_fields fields) {
  files_section f;
  f.rate_Hz = fields.number("rate_Hz", {1, 1e9});
  if (const auto column = fields.integer("time_column", 0, 1023)) f.time_column = static_cast<int>(*column);
  fields.unknown();
  return f;
}

inline bow_section read_bow_section(toml_fields fields) {
  bow_section b;
  if (!fields.has("kind")) fields.missing("kind");
  if (const auto kind = fields.choice("kind", bow_kind_names)) b.kind = static_cast<bow_kind>(*kind);
  b.width_m = fields.number("width_m", zero_to(0.1));
  b.tilt = fields.number("tilt", {0, 1});
  b.hair_stiffness_N_m = fields.number("hair_stiffness_N_m", up_to(1e9));
  b.hair_mass_kg = fields.number("hair_mass_kg", zero_to(1));
  b.hair_resistance_Ns_m = fields.number("hair_resistance_Ns_m", zero_to(1e5));
  if (b.kind == bow_kind::rod)
    for (const char* key : {"hair_stiffness_N_m", "hair_mass_kg", "hair_resistance_Ns_m"})
      fields.refuse(key, "belongs to a bow of kind \"hair\"");
  fields.unknown();
  return b;
}

inline simulate_section read_simulate(toml_fields fields) {
  simulate_section s;
  s.rate_Hz = fields.number("rate_Hz", {1e3, 1e7});
  s.duration_s = fields.number("duration_s", up_to(3600));
  s.noise_N = fields.number("noise_N", zero_to(100));
  s.seed = fields.integer("seed", 0, std::numeric_limits<std::int64_t>::max());
  s.nominal_scatter = fields.flag("nominal_scatter");
  if (const auto bits = fields.integer("bits", 0, 32)) {
    if (*bits == 0 || *bits == 16 || *bits == 24 || *bits == 32) s.bits = static_cast<int>(*bits);
    else fields.refuse("bits", "must be 16, 24, 32, or 0 for float, is " + std::to_string(*bits));
  }
  fields.unknown();
  return s;
}

}  // namespace rosin::detail

#include <rosin/core/macros_back.ipp>
