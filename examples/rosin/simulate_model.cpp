// SPDX-License-Identifier: MIT
#include "simulate_model.hpp"

#include <rosin/adapt/audio_sndfile.hpp>
#include <rosin/calibrate/pluck_layout.hpp>

#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>

namespace tool {

namespace {

/// Reads a parameter of an effect; what is missing is kept for the message.
class parameters_of {
public:
  explicit parameters_of(const found_effect& effect) : effect_{effect} {}
  double operator()(const char* name) {
    const auto it = effect_.parameters.find(name);
    if (it != effect_.parameters.end()) return it->second;
    if (missing.empty()) missing = name;
    return 1;
  }
  /// One that older diagnoses do not tell.
  double if_told(const char* name) const { return effect_.parameters.contains(name) ? effect_.parameters.at(name) : 0; }
  /// 0 near, 1 far.
  std::size_t side(const std::string& place) {
    if (place != "near" && place != "far" && missing.empty()) missing = "end or channel";
    return place == "far" ? 1 : 0;
  }
  std::string missing;

private:
  const found_effect& effect_;
};

using put = std::function<void(const found_effect&, parameters_of&, simulation_plan&)>;

void put_hum(parameters_of& p, simulation_plan& plan) {
  const rosin::hum_line line{p("frequency_Hz"), p("amplitude_N"), 0};
  for (auto& c : plan.channels)
    if (c.declared.quantity == rosin::quantity::termination_force) c.hum.push_back(line);
  plan.notes.emplace_back(
      "mains-hum: a diagnosis tells neither phase nor harmonics nor the weaker channel: the fundamental, alike in both, from "
      "phase 0");
}

void put_ripple(const found_effect& e, parameters_of& p, simulation_plan& plan) {
  for (auto& take : plan.takes) {
    take.rod.ripple_Hz = p("frequency_Hz");
    (e.name == "speed-ripple" ? take.rod.speed_ripple : take.rod.force_ripple) = p("relative");
  }
  plan.notes.push_back(e.name + ": a diagnosis tells no phase: 0 at the first sample");
}

void put_ac_coupling(parameters_of& p, simulation_plan& plan) {
  for (auto& c : plan.channels)
    if (c.declared.quantity == rosin::quantity::termination_force) c.declared.ac_coupled_Hz = p("cutoff_Hz");
}

/// Its resonances under an end, as sympathetic_effect.hpp has them.
void put_other_string(const found_effect& e, parameters_of& p, simulation_plan& plan) {
  constexpr double highest_Hz = 60e3;
  const double first = p("frequency_Hz"), b = p("string_inharmonicity"),
               per_mass = plan.rig.string.impedance_Ns_m() / p("mass_kg");
  for (int n = 1; n <= 100; ++n)
    if (const double f = n * first * std::sqrt((1 + b * n * n) / (1 + b)); f < highest_Hz)
      plan.burden.string.ends[p.side(e.end)].modes.push_back({f, p("q"), per_mass * std::pow(n, p("slope"))});
}

/// Of one end, or of both.
void put_clamping(const found_effect& e, parameters_of& p, simulation_plan& plan) {
  const double clamping = p("clamping");
  for (std::size_t side = 0; side < 2; ++side)
    if (double& there = plan.burden.string.clamping[side]; e.end.empty() || p.side(e.end) == side)
      there = std::min(1.0, there + clamping);
}

/// What is found in [friction] or in the fit of the string has been put in already.
void put_nothing(const found_effect&, parameters_of&, simulation_plan&) {}

const std::map<std::string, put>& can_be_put() {
  using effect = const found_effect&;
  using get = parameters_of&;
  using plan = simulation_plan&;
  static const std::map<std::string, put> all{
      {"bending-stiffness", [](effect, get p, plan to) { to.rig.string.bending_stiffness_Nm2 += p("bending_stiffness_Nm2"); }},
      {"frequency-dependent-loss", [](effect, get p, plan to) { to.rig.string.loss.internal_s += p("loss_internal_s"); }},
      {"air-loss",
       [](effect, get p, plan to) {
         to.rig.string.loss.air_sqrt_Hz += p("loss_air_sqrt_Hz"), to.rig.string.loss.drag_Hz += p.if_told("loss_drag_Hz");
       }},
      {"tension-modulation", [](effect, get p, plan to) { to.burden.string.axial_stiffness_N = p("axial_stiffness_N"); }},
      {"second-polarization",
       [](effect, get p, plan to) { to.burden.detuning = p("detuning"), to.burden.coupling = p("coupling"); }},
      {"point-mass",
       [](effect, get p, plan to) { to.burden.string.loads.push_back({.position = p("position"), .mass_kg = p("mass_kg")}); }},
      {"point-damper",
       [](effect, get p, plan to) {
         to.burden.string.loads.push_back({.position = p("position"), .resistance_Ns_m = p("resistance_Ns_m")});
       }},
      {"support-resonance",
       [](effect e, get p, plan to) {
         to.burden.string.ends[p.side(e.end)].modes.push_back(
             {p("frequency_Hz"), p("q"), to.rig.string.impedance_Ns_m() / p("mass_kg")});
       }},
      {"resistive-end",
       [](effect e, get p, plan to) {
         to.burden.string.ends[p.side(e.end)].modes.push_back(
             rosin::overdamped_mode(to.rig.string.impedance_Ns_m() / p("resistance_Ns_m"), p("corner_Hz"), 1e6));
       }},
      {"clamped-end", put_clamping},
      {"sympathetic-string", [](effect e, get p, plan to) { put_other_string(e, p, to); }},
      {"ac-coupling", [](effect, get p, plan to) { put_ac_coupling(p, to); }},
      {"sensor-resonance",
       [](effect e, get p, plan to) {
         const std::size_t c = p.side(e.channel);
         to.burden.sensors.resonance_Hz[c] = p("frequency_Hz"), to.burden.sensors.resonance_q[c] = p("q");
       }},
      {"channel-skew", [](effect, get p, plan to) { to.burden.sensors.skew_s = p("skew_s"); }},
      {"channel-crosstalk", [](effect, get p, plan to) { to.burden.sensors.crosstalk = p("fraction"); }},
      {"sensor-nonlinearity",
       [](effect e, get p, plan to) { to.burden.sensors.quadratic_per_N[p.side(e.channel)] = p("quadratic_per_N"); }},
      {"mains-hum", [](effect, get p, plan to) { put_hum(p, to); }},
      {"slow-release",
       [](effect, get p, plan to) {
         for (auto& take : to.takes) take.pluck.release_duration_s = p("duration_s");
       }},
      {"finite-pluck-width", [](effect, get p, plan to) { to.burden.pluck_width_m = p("width_m"); }},
      {"phantom-partials",
       [](effect e, get p, plan to) { to.burden.string.sensed_stiffness_N[p.side(e.channel)] = p("sensed_axial_stiffness_N"); }},
      {"clock-drift", [](effect, get p, plan to) { to.burden.sensors.clock_drift = p("relative"); }},
      {"torsion",
       [](effect, get p, plan to) {
         to.rig.torsion = {p("speed_ratio"), p("impedance_ratio"), p("q")};
       }},
      {"tension-drift", [](effect, get p, plan to) { to.tension_drift = p("relative"); }},
      {"rod-resonance",
       [](effect, get p, plan to) {
         to.burden.rod = {p("mass_kg"), p("frequency_Hz"), p("q")};
       }},
      {"finite-contact-width", [](effect, get p, plan to) { to.burden.contact_width_m = p("width_m"); }},
      {"speed-ripple", [](effect e, get p, plan to) { put_ripple(e, p, to); }},
      {"normal-force-ripple", [](effect e, get p, plan to) { put_ripple(e, p, to); }},
      {"thermal-friction", put_nothing},
      {"elasto-plastic-friction", put_nothing}};
  return all;
}

std::optional<double> value_of(const diagnosed_model& model, const std::string& name) {
  const auto it = model.calibration.find(name);
  return it == model.calibration.end() ? std::nullopt : std::optional{it->second};
}

/// Impedance as declared: the masses of a diagnosis refer to it.
void put_string(const diagnosed_model& model, simulation_plan& plan) {
  auto& s = plan.rig.string;
  if (const auto f = value_of(model, "fundamental_Hz")) s.tension_N *= *f / s.fundamental_Hz, s.fundamental_Hz = *f;
  if (const auto b = value_of(model, "inharmonicity"))
    s.bending_stiffness_Nm2 = *b * s.tension_N * std::pow(s.length_m / std::numbers::pi, 2);
  if (const auto d = value_of(model, "inverse_quality")) s.loss.quality = 1 / *d;
  s.loss.internal_s = value_of(model, "loss_internal_s").value_or(s.loss.internal_s);
  s.loss.air_sqrt_Hz = value_of(model, "loss_air_sqrt_Hz").value_or(s.loss.air_sqrt_Hz);
  s.loss.causality = value_of(model, "loss_causality").value_or(0);
  s.loss.drag_Hz = value_of(model, "loss_drag_Hz").value_or(0);
  s.loss.reference_Hz = s.fundamental_Hz;
  for (std::size_t i = 0; i < rosin::loss_unevenness::orders; ++i) {
    s.loss.uneven.cosine[i] = value_of(model, "loss_cosine_" + std::to_string(i + 1)).value_or(0);
    s.loss.uneven.sine[i] = value_of(model, "loss_sine_" + std::to_string(i + 1)).value_or(0);
  }
  if (value_of(model, "convention").value_or(-1) > 0) plan.rig.damping = rosin::damping_convention::kelvin_voigt;
}

/// Declared terminations, by as much as the plucks say that they are off (pluck_layout.hpp).
void put_ends(const diagnosed_model& model, simulation_plan& plan) {
  const rosin::pluck_layout layout({}, {}, plan.burden.string.ends);
  Eigen::VectorXd off = Eigen::VectorXd::Zero(layout.size());
  for (Eigen::Index p = layout.first_of_ends(); p < layout.size(); ++p) off[p] = value_of(model, layout.name(p)).value_or(0);
  plan.burden.string.ends = layout.ends(off);
}

/// Where a pluck was made: as declared, and as fitted.
struct fitted_place {
  double declared, fitted;
  std::string take;
};

std::vector<fitted_place> fitted_places(const diagnosed_model& model, const rosin::rig& rig) {
  std::vector<rosin::pluck_take> takes;
  for (const auto& take : rig.takes)
    if (const auto declared = rig.position_of(take); declared && model.calibration.contains("release_s of " + take.name))
      takes.push_back({.name = take.name, .position = *declared});
  rosin::pluck_options options;
  options.own_places = rosin::pluck_layout(takes, options).positions().size() < takes.size() &&
                       model.calibration.contains("position " + std::to_string(takes.size()));
  const rosin::pluck_layout layout(takes, options);
  std::vector<fitted_place> out;
  for (std::size_t t = 0; t < takes.size(); ++t)
    out.push_back(
        {takes[t].position, value_of(model, layout.name(layout.position(t))).value_or(takes[t].position), takes[t].name});
  return out;
}

void put_takes(const diagnosed_model& model, const rosin::rig& rig, simulation_plan& plan) {
  const auto places = fitted_places(model, rig);
  for (auto& take : plan.takes) {
    const double declared = rig.position_of(take.declared).value_or(take.position);
    const auto is_own = [&](const fitted_place& p) { return p.take == take.declared.name; };
    auto nearest = std::find_if(places.begin(), places.end(), is_own);
    if (nearest == places.end())
      nearest = std::min_element(places.begin(), places.end(), [&](const auto& a, const auto& b) {
        return std::abs(a.declared - declared) < std::abs(b.declared - declared);
      });
    if (nearest != places.end() && take.declared.kind != rosin::take_kind::quiet)
      take.position = take.pluck.position = declared + nearest->fitted - nearest->declared;
    if (take.declared.kind != rosin::take_kind::pluck) continue;
    const auto of = [&](const char* name) { return value_of(model, std::string{name} + " of " + take.declared.name); };
    take.pluck.release_s = of("release_s").value_or(take.pluck.release_s);
    if (const auto ln = of("ln_strength")) take.pluck.force_N = std::exp(*ln);
    take.offset_N = {of("offset_near_N").value_or(0), of("offset_far_N").value_or(0)};
  }
  for (auto& c : plan.channels)
    if (const auto ln = value_of(model, "ln_gain_" + c.declared.name)) c.gain = std::exp(*ln);
}

found_effect effect_from(const json& m) {
  found_effect out{m.at("effect").get<std::string>(), {}, {}, {}};
  if (const auto where = m.find("where"); where != m.end())
    out.end = where->value("end", ""), out.channel = where->value("channel", "");
  for (const auto& [name, value] : m.at("parameters").items()) {
    if (value.is_object()) out.parameters[name] = value.at("value").get<double>();
    else if (value.is_number()) out.parameters[name] = value.get<double>();
  }
  return out;
}

}  // namespace

rosin::outcome<diagnosed_model> read_diagnosed_model(const std::string& path) {
  const auto text = rosin::read_file(path);
  if (!text) return rosin::failure{text.error()};
  const json document = json::parse(*text, nullptr, false);
  const auto wrong = [&](const std::string& what) { return rosin::failure{path + ": " + what}; };
  if (!document.is_object() || !document.contains("missing") || !document.contains("calibration") ||
      !document["calibration"].is_object() || !document["missing"].is_array())
    return wrong("is no diagnosis (rosin diagnose --json writes one)");
  diagnosed_model out{path, document.value("verdict", json{}).is_string() ? document.value("verdict", "") : "", {}, {}};
  try {
    for (const auto& [name, value] : document["calibration"].items())
      if (value.is_object() && value.contains("value") && value["value"].is_number())
        out.calibration[name] = value["value"].get<double>();
    for (const json& m : document["missing"]) out.effects.push_back(effect_from(m));
  } catch (const json::exception& error) {
    return wrong(std::string{"is no diagnosis: "} + error.what());
  }
  if (!out.calibration.contains("fundamental_Hz")) return wrong("calibration has no \"fundamental_Hz\"");
  return out;
}

rosin::rig with_model(rosin::rig rig, const diagnosed_model& model) {
  for (const auto& e : model.effects) {
    if (e.name != "thermal-friction" && e.name != "elasto-plastic-friction") continue;
    if (!rig.model) rig.model.emplace();
    if (!rig.friction) rig.friction.emplace();
    const auto given = [&](const char* name) {
      return e.parameters.contains(name) ? std::optional{e.parameters.at(name)} : std::nullopt;
    };
    rig.model->friction = e.name == "thermal-friction" ? rosin::friction_model::thermal : rosin::friction_model::elasto_plastic;
    if (const auto layer = given("layer_m")) rig.friction->layer_thickness_m = layer;
    if (const auto stiffness = given("bristle_stiffness_N_m")) rig.friction->bristle_stiffness_N_m = stiffness;
    for (const auto& take : rig.takes)
      if (const auto area = given("area_per_newton_m2"); area && take.normal_force_N && !rig.friction->contact_radius_m)
        rig.friction->contact_radius_m = std::sqrt(*area * *take.normal_force_N / std::numbers::pi);
  }
  for (auto* end : {&rig.near, &rig.far})  // what moves there is among the effects that were found
    if (*end && (*end)->kind == rosin::termination::form::fit) (*end)->kind = rosin::termination::form::rigid;
  auto how = rig.simulate.value_or(rosin::simulate_section{});
  double longest_s = 0;
  for (const auto& take : rig.takes) {
    const auto recorded = rosin::detail::read_format(rig, take, table_formats());
    if (!recorded || !(recorded->sample_rate_Hz > 0)) continue;
    if (!how.rate_Hz) how.rate_Hz = recorded->sample_rate_Hz;
    longest_s = std::max(longest_s, static_cast<double>(recorded->frames) / recorded->sample_rate_Hz);
  }
  if (!how.duration_s && longest_s > 0) how.duration_s = longest_s;
  rig.simulate = how;
  return rig;
}

std::optional<rosin::failure> apply_model(const diagnosed_model& model, const rosin::rig& rig, simulation_plan& plan) {
  put_string(model, plan);
  put_ends(model, plan);
  put_takes(model, rig, plan);
  for (const auto& e : model.effects) {
    const auto how = can_be_put().find(e.name);
    if (how == can_be_put().end()) return rosin::failure{model.file + ": \"" + e.name + "\" cannot be simulated"};
    parameters_of p{e};
    how->second(e, p, plan);
    if (!p.missing.empty())
      return rosin::failure{model.file + ": \"" + e.name + "\" cannot be simulated: it has no " + p.missing};
    plan.effects.push_back(e.name);
  }
  for (const std::size_t c : {0U, 1U})  // a sensor that rings bends behind that, unless the diagnosis says otherwise
    plan.burden.sensors.rings_first[c] =
        !value_of(model, std::string{"sensor-nonlinearity@"} + (c == 0 ? "near" : "far") + " before it rings quadratic_per_N");
  if (plan.rig.torsion.present()) std::erase(plan.notes, "no [torsion]: the string does not turn");
  if (model.verdict == "unexplained")
    plan.notes.push_back(model.file + ": its verdict is \"unexplained\": something is still missing");
  return std::nullopt;
}

}  // namespace tool
