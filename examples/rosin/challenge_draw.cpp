// SPDX-License-Identifier: MIT
//
// What is hidden and how strong. Ranges: those of a laboratory in which one thing has gone wrong, at strength 1.
//
#include "challenge_rig.hpp"

#include <algorithm>
#include <cmath>

namespace tool {

namespace {

hidden_effect on_the_string(const std::string& name, challenge_rig& r, rosin::gaussian_source& s, double k) {
  const double z = r.base.rig.string.impedance_Ns_m();
  if (name == "bending-stiffness") {
    r.declares_stiffness = false;
    return {name, "", "", {{"bending_stiffness_Nm2", r.base.rig.string.bending_stiffness_Nm2}}};
  }
  if (name == "frequency-dependent-loss") {
    const double loss = k * evenly_in_log(s, 1e-7, 5e-7);
    r.base.rig.string.loss.internal_s = r.bowed.string.loss.internal_s = loss;
    return {name, "", "", {{"loss_internal_s", loss}}};
  }
  if (name == "tension-modulation") {
    r.burden.axial_stiffness_N = k * s.uniform(8000, 16000);
    return {name, "", "", {{"axial_stiffness_N", r.burden.axial_stiffness_N}}};
  }
  if (name == "second-polarization") {
    r.detuning = with_sign(s, evenly_in_log(s, 1e-3, 6e-3));
    r.pluck_angle_rad = with_sign(s, s.uniform(0.1, 0.35)), r.sensor_angle_rad = k * with_sign(s, s.uniform(0.1, 0.3));
    return {name, "", "", {{"detuning", r.detuning}, {"coupling", std::tan(r.pluck_angle_rad) * std::tan(r.sensor_angle_rad)}}};
  }
  const double x = place(s, r);
  if (name == "point-mass") {
    const double mass = k * evenly_in_log(s, 1e-6, 1e-5);
    r.burden.loads.push_back({x, mass, 0, 0});
    return {name, "", "", {{"position", x}, {"mass_kg", mass}}};
  }
  if (name == "point-damper") {
    const double resistance = k * evenly_in_log(s, 2e-3, 2e-2) * z;
    r.burden.loads.push_back({x, 0, resistance, 0});
    return {name, "", "", {{"position", x}, {"resistance_Ns_m", resistance}}};
  }
  const std::size_t e = side(s);  // support-resonance
  r.burden.supports[e] = {evenly_in_log(s, 2e-3, 12e-3) / k, evenly_in_log(s, 1200, 6000), s.uniform(8, 35)};
  return {name,
          name_of_side(e),
          "",
          {{"frequency_Hz", r.burden.supports[e].frequency_Hz},
           {"q", r.burden.supports[e].quality},
           {"mass_kg", r.burden.supports[e].mass_kg}}};
}

hidden_effect in_the_sensors(const std::string& name, challenge_rig& r, rosin::gaussian_source& s, double k) {
  if (name == "ac-coupling") {
    const double corner = k * evenly_in_log(s, 2, 20);
    for (auto& c : r.converters) c.ac_coupled_Hz = corner;
    return {name, "", "", {{"cutoff_Hz", corner}}};
  }
  if (name == "channel-skew") {
    r.faults.skew_s = k * with_sign(s, evenly_in_log(s, 5e-7, 4e-6));
    return {name, "", "", {{"skew_s", r.faults.skew_s}}};
  }
  if (name == "channel-crosstalk") {
    r.faults.crosstalk = k * with_sign(s, evenly_in_log(s, 5e-3, 0.03));
    return {name, "", "", {{"fraction", r.faults.crosstalk}}};
  }
  if (name == "mains-hum") {
    const double frequency = s.uniform() < 0.5 ? 50 : 60, amplitude = k * evenly_in_log(s, 4e-3, 2e-2);
    for (std::size_t c = 0; c < 2; ++c) {
      const double share = c == 0 ? 1 : s.uniform(0.3, 0.9);
      for (int n = 1; n <= 3; ++n)
        r.converters[c].hum.push_back({n * frequency, share * amplitude / (n * n), s.uniform(0, 6.28)});
    }
    return {name, "", "", {{"frequency_Hz", frequency}, {"amplitude_N", amplitude}}};
  }
  const std::size_t c = side(s);
  if (name == "sensor-nonlinearity") {
    r.faults.quadratic_per_N[c] = k * with_sign(s, s.uniform(0.01, 0.05));
    return {name, "", name_of_side(c), {{"quadratic_per_N", r.faults.quadratic_per_N[c]}}};
  }
  // sensor-resonance: weaker means farther beyond the band
  r.faults.resonance_Hz[c] = evenly_in_log(s, 14e3, 28e3) / std::sqrt(k), r.faults.resonance_q[c] = s.uniform(6, 25);
  return {name, "", name_of_side(c), {{"frequency_Hz", r.faults.resonance_Hz[c]}, {"q", r.faults.resonance_q[c]}}};
}

hidden_effect under_the_bow(const std::string& name, challenge_rig& r, rosin::gaussian_source& s, double k) {
  if (name == "slow-release") {
    r.release_duration_s = std::sqrt(k) * evenly_in_log(s, 15e-6, 60e-6);
    return {name, "", "", {{"duration_s", r.release_duration_s}}};
  }
  if (name == "torsion") {
    r.declares_torsion = false;
    return {name,
            "",
            "",
            {{"speed_ratio", r.base.rig.torsion.speed_ratio},
             {"impedance_ratio", r.base.rig.torsion.impedance_ratio},
             {"q", r.base.rig.torsion.quality}}};
  }
  if (name == "tension-drift") {
    const double relative = k * with_sign(s, evenly_in_log(s, 4e-3, 2e-2));
    r.bowed.string.tension_N *= 1 + relative;
    r.bowed.string.fundamental_Hz *= std::sqrt(1 + relative);
    return {name, "", "", {{"relative", relative}}};
  }
  if (name == "rod-resonance") {
    r.rod = {evenly_in_log(s, 1.5e-3, 6e-3) / k, evenly_in_log(s, 900, 4000), s.uniform(8, 25)};
    return {name, "", "", {{"frequency_Hz", r.rod.frequency_Hz}, {"q", r.rod.quality}, {"mass_kg", r.rod.mass_kg}}};
  }
  if (name == "finite-contact-width") {
    r.contact_width_m = std::sqrt(k) * s.uniform(3e-3, 8e-3);
    r.contact_places = 2 + static_cast<int>(s.uniform(0, 5));
    return {name, "", "", {{"width_m", r.contact_width_m}}};
  }
  if (name == "speed-ripple" || name == "normal-force-ripple") {
    r.ripple_Hz = s.uniform(40, 220);
    const double relative = k * (name == "speed-ripple" ? s.uniform(0.015, 0.06) : s.uniform(0.08, 0.25));
    (name == "speed-ripple" ? r.speed_ripple : r.force_ripple) = relative;
    return {name, "", "", {{"frequency_Hz", r.ripple_Hz}, {"relative", relative}}};
  }
  if (name == "thermal-friction") {
    const rosin::contact_heat_parameters<double> heat{.layer_m = s.uniform(1e-6, 5e-6),
                                                      .area_per_newton_m2 = s.uniform(0.7e-7, 1.5e-7)};
    const auto strength =
        rosin::design_yield_curve(r.base.steady_friction, heat.without_string(), r.base.strokes[0].normal_force_N);
    if (strength) r.base.law = rosin::thermal_plastic<double>{*strength, heat};
    return {name, "", "", {}};
  }
  r.bristles_N_m = evenly_in_log(s, 8e3, 4e4) / k;  // elasto-plastic-friction
  return {name, "", "", {{"bristle_stiffness_N_m", r.bristles_N_m}}};
}

/// Strings besides the E: the declared values stay as far off as they were drawn.
void draw_other_string(const std::vector<double>& pitch_Hz, challenge_rig& r, rosin::gaussian_source& s) {
  auto& t = r.base.rig.string;
  auto& d = r.base.declared.string;
  const double tension = s.uniform(0.6, 1.25), one = t.fundamental_Hz;
  const double pitch =
      pitch_Hz.size() == 2 ? evenly_in_log(s, pitch_Hz[0] / one, pitch_Hz[1] / one) : evenly_in_log(s, 0.45, 1.25);
  const double stiff = evenly_in_log(s, 0.4, 2.0);
  for (auto* p : {&t, &d}) p->tension_N *= tension, p->fundamental_Hz *= pitch, p->bending_stiffness_Nm2 *= stiff;
  r.base.law = rosin::velocity_curve<rosin::two_exponential_curve<double>>{r.base.steady_friction};
}

void hide(const std::string& name, challenge_rig& r, rosin::gaussian_source& s, double k) {
  if (auto further = hidden_on_request(name, r, s, k)) return r.effects.push_back(*std::move(further));
  const auto& all = hideable();
  const auto index = std::find(all.begin(), all.end(), name) - all.begin();
  r.effects.push_back(index < 7    ? on_the_string(name, r, s, k)
                      : index < 13 ? in_the_sensors(name, r, s, k)
                                   : under_the_bow(name, r, s, k));
}

}  // namespace

const std::vector<std::string>& hideable() {
  static const std::vector<std::string> names{"bending-stiffness",
                                              "frequency-dependent-loss",
                                              "tension-modulation",
                                              "second-polarization",
                                              "point-mass",
                                              "point-damper",
                                              "support-resonance",
                                              "ac-coupling",
                                              "channel-skew",
                                              "channel-crosstalk",
                                              "mains-hum",
                                              "sensor-nonlinearity",
                                              "sensor-resonance",
                                              "slow-release",
                                              "torsion",
                                              "tension-drift",
                                              "rod-resonance",
                                              "finite-contact-width",
                                              "speed-ripple",
                                              "normal-force-ripple",
                                              "thermal-friction",
                                              "elasto-plastic-friction"};
  return names;
}

bool exclude_each_other(const std::string& one, const std::string& other) {
  const auto ripple = [](const std::string& n) { return n.find("ripple") != std::string::npos; };
  const auto law = [](const std::string& n) { return n == "thermal-friction" || n == "elasto-plastic-friction"; };
  return one == other || (ripple(one) && ripple(other)) || (law(one) && law(other));
}

challenge_rig draw_challenge(const challenge_choice& choice) {
  challenge_rig r;
  r.name = "challenge-" + std::to_string(choice.seed);
  r.base = rosin::draw_rig(choice.seed);
  rosin::gaussian_source s{choice.seed ^ 0x9e3779b97f4a7c15ULL};
  draw_other_string(choice.pitch_Hz, r, s);
  r.base.rig.damping = s.uniform() < 0.5 ? rosin::damping_convention::viscous : rosin::damping_convention::kelvin_voigt;
  r.base.rig.uneven = {choice.loss_scatter, choice.seed};
  r.bowed = r.base.rig;
  const auto& all = hideable();
  const auto any = [&] { return all[static_cast<std::size_t>(s.uniform() * static_cast<double>(all.size()))]; };
  std::vector<std::string> names = choice.wanted;
  while (static_cast<int>(names.size()) < choice.effects) {
    const auto name = any();
    if (std::none_of(names.begin(), names.end(), [&](const auto& n) { return exclude_each_other(n, name); }))
      names.push_back(name);
  }
  if (choice.effects == 0) names.clear();
  for (const auto& name : names) hide(name, r, s, choice.strength);
  const double peak = r.base.declared.pluck_N[0] * std::max(r.base.position, 1 - r.base.position);
  if (choice.noise_dB > 0) r.base.noise_N = peak * std::pow(10, -choice.noise_dB / 20);
  for (std::size_t c = 0; c < 2; ++c) {
    r.converters[c].gain = r.base.gain[c], r.converters[c].noise_N = r.base.noise_N;
    for (auto& line : r.converters[c].hum)
      line.amplitude_N *= r.base.gain[c];  // a force that is not there, as the sensor sees it
  }
  return r;
}

json truth_of(const challenge_rig& r) {
  json effects = json::array();
  for (const auto& e : r.effects) {
    json parameters = e.parameters;
    if (!e.end.empty()) parameters["end"] = e.end;
    if (!e.channel.empty()) parameters["channel"] = e.channel;
    effects.push_back({{"effect", e.name}, {"parameters", parameters}});
  }
  const auto& t = r.base.rig.string;
  return {{"name", r.name},
          {"effects", effects},
          {"string",
           {{"length_m", t.length_m},
            {"tension_N", t.tension_N},
            {"fundamental_Hz", t.fundamental_Hz},
            {"bending_stiffness_Nm2", t.bending_stiffness_Nm2},
            {"q", t.loss.quality},
            {"loss_scatter", r.base.rig.uneven.scatter}}},
          {"position", r.base.position},
          {"gain", r.base.gain},
          {"noise_N", r.base.noise_N},
          {"contact_places", r.contact_width_m > 0 ? r.contact_places : 1},
          {"damping", r.base.rig.damping == rosin::damping_convention::viscous ? "viscous" : "kelvin-voigt"}};
}

}  // namespace tool
