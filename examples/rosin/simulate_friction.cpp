// SPDX-License-Identifier: MIT
#include "simulate_friction.hpp"

#include <rosin/friction/yield_curve_design.hpp>

#include <numbers>

namespace tool {

namespace {

using rosin::friction_model;
using rosin::detail::sentence;

/// The keys of [friction], which of them are given, and which laws look at them.
struct friction_key {
  const char* name;
  bool given;
  std::vector<friction_model> used_by;
};

std::vector<friction_key> keys_of(const rosin::friction_section& f) {
  using enum friction_model;
  return {{"terms", !f.terms.empty(), {velocity_curve, thermal, elasto_plastic}},
          {"constant", f.constant.has_value(), {velocity_curve, thermal, elasto_plastic}},
          {"static_coefficient", f.static_coefficient.has_value(), {velocity_curve, thermal, elasto_plastic}},
          {"dynamic_coefficient", f.dynamic_coefficient.has_value(), {velocity_curve, thermal, elasto_plastic}},
          {"stribeck_speed_m_s", f.stribeck_speed_m_s.has_value(), {velocity_curve, thermal, elasto_plastic}},
          {"contact_radius_m", f.contact_radius_m.has_value(), {thermal}},
          {"layer_thickness_m", f.layer_thickness_m.has_value(), {thermal}},
          {"ambient_C", f.ambient_C.has_value(), {thermal}},
          {"bristle_stiffness_N_m", f.bristle_stiffness_N_m.has_value(), {elasto_plastic}},
          {"bristle_damping_Ns_m", f.bristle_damping_Ns_m.has_value(), {elasto_plastic}},
          {"break_away_fraction", f.break_away_fraction.has_value(), {elasto_plastic}},
          {"viscous_Ns_m", f.viscous_Ns_m.has_value(), {elasto_plastic}}};
}

double value_or(const std::optional<double>& given, double fallback, const char* key, std::vector<std::string>& assumed) {
  if (!given) assumed.push_back(sentence(std::string{"friction."} + key, fallback, "none given"));
  return given.value_or(fallback);
}

declared_curve exponentials(const rosin::friction_section& f, std::vector<std::string>& assumed) {
  declared_curve out;
  constexpr rosin::two_exponential_curve<> usual{};
  out.constant = value_or(f.constant, usual.c, "constant", assumed);
  auto terms = f.terms;
  if (terms.empty()) {
    terms = {{usual.a, usual.va_m_s}, {usual.b, usual.vb_m_s}};
    assumed.emplace_back("friction.terms = 0.4 exp(-v / 0.01 m/s) + 0.45 exp(-v / 0.1 m/s), none given");
  }
  for (const auto& term : terms) out.terms.at(out.count++) = term;
  return out;
}

declared_curve stribeck(const rosin::friction_section& f, std::vector<std::string>& assumed) {
  constexpr rosin::stribeck_curve<> usual{};
  declared_curve out;
  out.constant = value_or(f.dynamic_coefficient, usual.coulomb, "dynamic_coefficient", assumed);
  out.stribeck_rise = value_or(f.static_coefficient, usual.at_rest, "static_coefficient", assumed) - out.constant;
  out.stribeck_m_s = value_or(f.stribeck_speed_m_s, usual.v_stribeck_m_s, "stribeck_speed_m_s", assumed);
  return out;
}

/// Either sort of curve; with neither given, rosin's.
rosin::outcome<declared_curve> steady_curve(const rosin::rig& rig, const rosin::friction_section& f,
                                            std::vector<std::string>& assumed) {
  const bool by_terms = !f.terms.empty() || f.constant;
  const bool by_stribeck = f.static_coefficient || f.dynamic_coefficient || f.stribeck_speed_m_s;
  if (by_terms && by_stribeck)
    return rosin::failure{rig.file +
                          ": friction: terms and constant describe one curve, static_coefficient, dynamic_coefficient and "
                          "stribeck_speed_m_s another; give one of them"};
  if (f.terms.size() > declared_curve::most_terms)
    return rosin::failure{rig.file + ": friction.terms: " + std::to_string(f.terms.size()) +
                          " exponentials; a simulation takes " + std::to_string(declared_curve::most_terms) + " at most"};
  auto curve = by_stribeck ? stribeck(f, assumed) : exponentials(f, assumed);
  if (curve.stribeck_rise < 0)
    return rosin::failure{rig.file + ": friction: static_coefficient is smaller than dynamic_coefficient"};
  if (!(curve(0).value > 0)) return rosin::failure{rig.file + ": friction: there is no friction at all"};
  return curve;
}

/// Of the first bowed take: what the contact's radius and the bristles' stiffness refer to.
double reference_force_N(const rosin::rig& rig) {
  for (const auto& take : rig.takes) {
    if (take.kind != rosin::take_kind::bow) continue;
    if (take.normal_force_N) return *take.normal_force_N;
    for (const auto& [time, force] : take.normal_force_profile_N)
      if (force > 0) return force;
  }
  return 0.3;
}

rosin::outcome<friction_law> thermal_law(const rosin::rig& rig, const rosin::friction_section& f, chosen_friction& out,
                                         std::vector<std::string>& assumed) {
  out.heat.layer_m = value_or(f.layer_thickness_m, out.heat.layer_m, "layer_thickness_m", assumed);
  const double usual_radius = std::sqrt(out.heat.area_per_newton_m2 * out.normal_force_N / std::numbers::pi);
  const double radius = value_or(f.contact_radius_m, usual_radius, "contact_radius_m", assumed);
  out.heat.area_per_newton_m2 = std::numbers::pi * radius * radius / out.normal_force_N;
  out.ambient_C = value_or(f.ambient_C, out.ambient_C, "ambient_C", assumed);
  const auto strength = rosin::design_yield_curve(out.curve, out.heat.without_string(), out.normal_force_N);
  if (!strength) return rosin::failure{rig.file + ": friction: " + strength.error()};
  return friction_law{rosin::thermal_plastic<double>{*strength, out.heat}};
}

friction_law bristle_law(const rosin::friction_section& f, chosen_friction& out, std::vector<std::string>& assumed) {
  auto& b = out.bristles;
  b.stiffness_1_m = value_or(f.bristle_stiffness_N_m, b.stiffness_1_m * out.normal_force_N, "bristle_stiffness_N_m", assumed) /
                    out.normal_force_N;
  b.damping_Ns_m = value_or(f.bristle_damping_Ns_m, b.damping_Ns_m, "bristle_damping_Ns_m", assumed);
  b.breakaway = value_or(f.break_away_fraction, b.breakaway, "break_away_fraction", assumed);
  b.viscous_Ns_m = f.viscous_Ns_m.value_or(0);
  b.kinetic = out.curve.constant;
  return rosin::elasto_plastic<declared_curve>{out.curve, b};
}

}  // namespace

rosin::curve_point<double> declared_curve::operator()(double v) const noexcept {
  const double u = v / stribeck_m_s, bump = stribeck_rise > 0 ? stribeck_rise * std::exp(-u * u) : 0.0;
  rosin::curve_point<double> out{constant + bump, -2 * u * bump / stribeck_m_s};
  for (std::size_t i = 0; i < count; ++i) {
    const double part = terms[i].coefficient * std::exp(-v / terms[i].speed_m_s);
    out.value += part;
    out.slope -= part / terms[i].speed_m_s;
  }
  return out;
}

rosin::outcome<chosen_friction> choose_friction(const rosin::rig& rig, std::vector<std::string>& assumed,
                                                std::vector<std::string>& notes) {
  const auto given = rig.friction.value_or(rosin::friction_section{});
  chosen_friction out;
  if (rig.model && rig.model->friction) out.model = *rig.model->friction;
  for (const auto& key : keys_of(given))
    if (key.given && std::find(key.used_by.begin(), key.used_by.end(), out.model) == key.used_by.end())
      notes.push_back("friction." + std::string{key.name} + " has no meaning for the law " + name_of(out.model) + ": not used");
  const auto curve = steady_curve(rig, given, assumed);
  if (!curve) return rosin::failure{curve.error()};
  out.curve = *curve;
  out.normal_force_N = reference_force_N(rig);
  out.law = rosin::velocity_curve<declared_curve>{out.curve};
  if (out.model == friction_model::thermal) {
    const auto law = thermal_law(rig, given, out, assumed);
    if (!law) return rosin::failure{law.error()};
    out.law = *law;
  }
  if (out.model == friction_model::elasto_plastic) {
    if (!(out.curve.constant > 0))
      return rosin::failure{rig.file + ": friction: elasto-plastic friction needs a friction above 0 in fast sliding"};
    out.law = bristle_law(given, out, assumed);
  }
  return out;
}

json chosen_friction::to_json() const {
  json out{{"law", name_of(model)}, {"constant", curve.constant}};
  out["terms"] = json::array();
  for (std::size_t i = 0; i < curve.count; ++i)
    out["terms"].push_back({{"coefficient", curve.terms[i].coefficient}, {"speed_m_s", curve.terms[i].speed_m_s}});
  if (curve.stribeck_rise > 0) {
    out["static_coefficient"] = curve.constant + curve.stribeck_rise;
    out["stribeck_speed_m_s"] = curve.stribeck_m_s;
  }
  if (model == friction_model::thermal) {
    out["contact_radius_m"] = std::sqrt(heat.area_per_newton_m2 * normal_force_N / std::numbers::pi);
    out["layer_thickness_m"] = heat.layer_m;
    out["ambient_C"] = ambient_C;
  }
  if (model == friction_model::elasto_plastic) {
    out["bristle_stiffness_N_m"] = bristles.stiffness_1_m * normal_force_N;
    out["bristle_damping_Ns_m"] = bristles.damping_Ns_m;
    out["break_away_fraction"] = bristles.breakaway;
    out["viscous_Ns_m"] = bristles.viscous_Ns_m;
  }
  if (model != friction_model::velocity_curve) out["at_normal_force_N"] = normal_force_N;
  return out;
}

}  // namespace tool
