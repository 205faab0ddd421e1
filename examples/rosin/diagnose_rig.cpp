// SPDX-License-Identifier: MIT
//
// Plucks first: what do they say of string, ends, wire and sensors? Then the strokes, reconstructed with that: tension and contact.
//
#include "diagnose_rig.hpp"
#include "pluck_input.hpp"

#include <rosin/calibrate/calibration.hpp>
#include <rosin/diagnose/contact_effects.hpp>
#include <rosin/diagnose/corrected_take.hpp>
#include <rosin/diagnose/pluck_diagnosis.hpp>
#include <rosin/diagnose/tension_drift.hpp>
#include <rosin/reconstruct/uncertainty.hpp>

namespace tool {

namespace {

/// One bowed take as the plucks' calibration and what they tell of the sensors make it.
struct diagnosed_stroke {
  std::string name;
  double rate_Hz = 0, speed_m_s = 0, normal_force_N = 0;
  rosin::calibration calibration;
  std::array<std::vector<double>, 2> recorded_N, force_N;
  std::vector<double> mean_N, mean_m_s;
  rosin::bow_motion<double> motion;
  double force_sd_N = 0, velocity_sd_m_s = 0, delta = 0;
};

using layout = rosin::pluck_layout;

bool has(const std::vector<std::string>& names, const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); }

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
    const rosin::string_facts facts{fit.value[layout::fundamental], rate, fit.limits.stop_Hz, impedance, length, count};
    return rosin::catalogue_without(physics, facts, fit.limits);
  });
}

/// The fit with all that was found, as a plain calibration of the string.
rosin::calibration calibration_with(const rosin::pluck_diagnosis& p, double declared, const rosin::rig_values& values) {
  rosin::pluck_fit_result fit = p.declared;
  const Eigen::Index plain = p.data.layout.size();
  Eigen::VectorXd v = p.best.value.head(plain);
  Eigen::Index at = plain;
  for (const auto& e : p.best.effects) {
    if (e.name == "bending-stiffness") v[rosin::pluck_layout::inharmonicity] += p.best.value[at];
    if (e.name == "frequency-dependent-loss") v[rosin::pluck_layout::internal_loss] += p.best.value[at];
    if (e.name == "air-loss") v[rosin::pluck_layout::air_loss] += p.best.value[at];
    at += static_cast<Eigen::Index>(e.parameters.size());
  }
  fit.value = v;
  if (p.best.covariance.rows() >= plain) fit.covariance = p.best.covariance.topLeftCorner(plain, plain);
  fit.noise_N = p.best.quality.noise;
  const double z = values.impedance_Ns_m->value;
  return rosin::calibration_from(fit, declared, z, values.impedance_Ns_m->sd / z);
}

std::vector<diagnosed_stroke> reconstruct_strokes(const rosin::rig& rig, const rosin::rig_values& values, const rosin::pluck_diagnosis& plucks, double tension_drift,
                                                  provenance& from, rig_diagnosis& d) {
  std::vector<diagnosed_stroke> out;
  for (const auto& take : rig.takes) {
    if (take.kind != rosin::take_kind::bow) continue;
    const auto position = rig.position_of(take);
    const auto read = read_take(rig, take, from);
    if (!read || !position) {
      d.warnings.push_back(take.name + ": left out: " + (read ? "its position is unknown" : read.error()));
      continue;
    }
    if (rosin::has_error(read->check.findings)) {
      for (const auto& f : read->check.findings)
        if (f.level == rosin::severity::error) d.warnings.push_back(sentence(rig, f));
      d.warnings.push_back(take.name + ": left out for the error above");
      continue;
    }
    diagnosed_stroke s;
    s.name = take.name, s.rate_Hz = read->signals.sample_rate_Hz;
    s.speed_m_s = take.speed_m_s.value_or(0), s.normal_force_N = take.normal_force_N.value_or(0);
    s.calibration = rosin::at_tension(calibration_with(plucks, *position, values), tension_drift);
    s.recorded_N = {read->signals.near_N(), read->signals.far_N()};
    const rosin::band limits{0.30 * s.rate_Hz, 0.45 * s.rate_Hz};
    rosin::undo_sensors(plucks.data, plucks.best, s.recorded_N, s.rate_Hz, limits.stop_Hz);
    for (std::size_t c = 0; c < 2; ++c) {
      const double corner = rig.channel(c == 0 ? "near" : "far")->ac_coupled_Hz.value_or(0);
      if (corner > 0) rosin::restore_ac_coupled(std::span(s.recorded_N[c]), corner, s.rate_Hz);
    }
    s.force_N = rosin::detail::calibrated(s.calibration, s.recorded_N[0], s.recorded_N[1]);
    s.motion = rosin::reconstructor<double>(s.calibration.at, limits, s.rate_Hz)(s.force_N[0], s.force_N[1]);
    if (s.motion.known.end <= s.motion.known.begin + 500) {
      d.warnings.push_back(take.name + ": left out: too short");
      continue;
    }
    for (std::size_t i = 0; i < s.motion.force_near_N.size(); ++i) {
      s.mean_N.push_back(0.5 * (s.motion.force_near_N[i] + s.motion.force_far_N[i]));
      s.mean_m_s.push_back(0.5 * (s.motion.velocity_near_m_s[i] + s.motion.velocity_far_m_s[i]));
    }
    const auto slopes = rosin::sensitivity<rosin::full_physics>(s.calibration, s.force_N[0], s.force_N[1], limits, s.rate_Hz);
    const std::array<double, 2> noise{s.calibration.noise_N[0] / s.calibration.gain[0], s.calibration.noise_N[1] / s.calibration.gain[1]};
    const auto sd = rosin::uncertainty<rosin::full_physics>(s.calibration, s.motion, slopes, noise, limits, s.rate_Hz);
    const auto middle = (s.motion.known.begin + s.motion.known.end) / 2;
    s.force_sd_N = sd.force_sd_N[middle], s.velocity_sd_m_s = sd.velocity_sd_m_s[middle];
    s.delta = rosin::consistency_delta(s.motion.force_near_N, s.motion.force_far_N);
    out.push_back(std::move(s));
  }
  return out;
}

rosin::tension_drift drift_of(const std::vector<diagnosed_stroke>& strokes) {
  std::vector<rosin::bowed_recording> takes;
  for (const auto& s : strokes) takes.push_back({s.recorded_N[0], s.recorded_N[1], s.calibration});
  const double rate = strokes.front().rate_Hz;
  return rosin::find_tension_drift(takes, {0.30 * rate, 0.45 * rate}, rate);
}

rosin::contact_findings contact_of(const rosin::rig& rig, const std::vector<diagnosed_stroke>& strokes) {
  std::vector<rosin::contact_take> takes;
  for (const auto& s : strokes) {
    rosin::contact_take t{s.name, s.mean_N, s.mean_m_s, s.motion.velocity_near_m_s, s.motion.velocity_far_m_s, s.force_N[0], s.force_N[1]};
    t.rate_Hz = s.rate_Hz, t.rod_speed_m_s = s.speed_m_s, t.normal_force_N = s.normal_force_N;
    t.delay_s = s.calibration.at.delay_s, t.stiffness_s2 = s.calibration.at.stiffness_s2;
    t.inverse_q = s.calibration.at.loss.inverse_q(0.5 / (t.delay_s[0] + t.delay_s[1]));
    t.impedance_Ns_m = s.calibration.at.impedance_Ns_m, t.length_m = rig.string.length_m.value_or(0);
    t.force_sd_N = s.force_sd_N, t.velocity_sd_m_s = s.velocity_sd_m_s, t.edge_Hz = 0.45 * s.rate_Hz;
    takes.push_back(t);
  }
  rosin::contact_model model;
  if (rig.torsion) model.torsion = rosin::torsion_values{rig.torsion->speed_ratio, rig.torsion->impedance_ratio, rig.torsion->q};
  if (rig.model && rig.model->friction) model.law = static_cast<rosin::contact_law>(*rig.model->friction);
  if (rig.model)
    for (const auto& name : rig.model->physics)
      if (name != "torsion") model.included.push_back(name);
  return rosin::contact_hypotheses(takes, model);
}

missing_effect described(const rosin::pluck_diagnosis& p, std::size_t which, const rosin::rig_values& values) {
  const rosin::pluck_effect& e = p.best.effects[which];
  missing_effect m;
  m.effect = e.name;
  if (e.place >= 0) (e.at_end ? m.end : m.channel) = e.place == 0 ? "near" : "far";
  const bool last = which + 1 == p.best.effects.size();
  const auto others = static_cast<double>(last ? p.alternatives.size() : 0);
  m.probability = others > 0 ? 1 / (1 + others) : 1 - std::exp(-std::min(30.0, p.found_gain[which]));
  if (last)
    for (const auto& id : p.alternatives) {
      const std::string name = id.substr(0, id.find('@'));
      if (name != e.name && std::find(m.indistinguishable_from.begin(), m.indistinguishable_from.end(), name) == m.indistinguishable_from.end())
        m.indistinguishable_from.push_back(name);
    }
  Eigen::Index at = p.data.layout.size();
  for (std::size_t i = 0; i < which; ++i) at += static_cast<Eigen::Index>(p.best.effects[i].parameters.size());
  std::array<double, 2> hum{}, hum_sd{};
  for (std::size_t i = 0; i < e.parameters.size(); ++i, ++at) {
    const rosin::effect_parameter& q = e.parameters[i];
    const double v = rosin::to_physical(q, p.best.value[at]), sd = p.best.sd[at] * (q.logarithmic ? v : 1);
    if (q.late) continue;
    if (q.name == "amplitude") {
      const std::size_t in_take = (i - 1) % 16;  // re and im of near, of far; four harmonics
      if (q.take == 0 && in_take < 4) hum[in_take / 2] = std::hypot(hum[in_take / 2], v), hum_sd[in_take / 2] = sd;
      continue;
    }
    m.parameters.push_back(in_si(q.name, v, sd, values, p.best.value[0]));
  }
  if (e.name == "mains-hum") {
    const std::size_t c = hum[1] > hum[0] ? 1 : 0;
    const double gain = std::exp(p.best.value[rosin::pluck_layout::gain_near + static_cast<int>(c)]);
    m.parameters.push_back({"amplitude_N", hum[c] / gain, hum_sd[c] / gain});
  }
  for (const auto& q : m.parameters)
    if (q.name == "position") m.position = q.value;
  m.statement = statement_of(m);
  return m;
}

missing_effect described(const rosin::contact_hypothesis& h, double probability) {
  missing_effect m;
  m.effect = h.effect;
  m.probability = std::clamp(probability, 0.0, 1.0);
  for (const auto& p : h.parameters) m.parameters.push_back({p.name, p.value, p.sd});
  m.statement = statement_of(m);
  return m;
}

std::vector<std::string> bare(const std::vector<std::string>& ids) {
  std::vector<std::string> out;
  for (const auto& id : ids) out.push_back(id.substr(0, id.find('@')));
  return out;
}

void take_over(const rosin::pluck_diagnosis& p, const rosin::rig_values& values, rig_diagnosis& d) {
  for (std::size_t i = 0; i < p.best.effects.size(); ++i) d.missing.push_back(described(p, i, values));
  for (const auto& h : p.ranking) d.ranking.push_back({bare(h.ids), h.log_evidence / std::log(10.0)});
  d.held_out = p.held_out;
  d.before = p.before, d.noise_floor = p.floor;
  d.residual = residuals_of(p);
  if (p.mismatched) d.after = p.after;
  if (!p.mismatched) return;
  d.take = p.data.takes[p.mismatch.take].name, d.channel = p.mismatch.channel == 0 ? "near" : "far";
  d.time_s = p.mismatch.time_s, d.band_Hz = p.mismatch.band_Hz, d.residual_over_noise = p.mismatch.residual_over_noise;
  for (const auto& m : d.missing)
    if (m.position) d.position = m.position;
}

void add_calibration(const rosin::pluck_diagnosis& p, rig_diagnosis& d) {
  for (Eigen::Index i = 0; i < p.data.layout.size(); ++i)
    d.calibration.push_back({p.data.layout.name(i), p.best.value[i], p.best.sd.size() > i ? p.best.sd[i] : 0.0});
  Eigen::Index at = p.data.layout.size();
  for (const auto& e : p.best.effects)
    for (const auto& q : e.parameters) {
      if (q.take < 0) {
        const double value = rosin::to_physical(q, p.best.value[at]);
        d.calibration.push_back({e.id() + " " + q.name, value, p.best.sd[at] * (q.logarithmic ? value : 1)});
      }
      ++at;
    }
}

/// Drift counts where it takes away most of what the two versions of the force part by, and a moved contact does not do as well.
bool drifted(const rosin::tension_drift& t) {
  return std::abs(t.relative) > 5 * t.sd && t.delta_after < 0.7 * t.delta_before && t.delta_after < 0.9 * t.delta_moved_contact && t.delta_before > 0.004;
}

void add_drift(const rosin::tension_drift& t, rig_diagnosis& d) {
  missing_effect m;
  m.effect = "tension-drift";
  m.probability = 0.999;
  m.parameters = {{"relative", t.relative, t.sd}};
  m.statement = "The tension changed by " + rosin::detail::figure(100 * t.relative, "%+.3g") + " % between the plucks and the strokes.";
  d.missing.push_back(m);
  // Of the force's two versions a few hundred samples a take are independent: ln L rises by n ln(before / after).
  const double gain = 500 * std::log(t.delta_before / std::max(1e-6, t.delta_after)) / std::log(10.0);
  for (auto& r : d.ranking) r.log10_evidence -= gain;
  d.ranking.insert(d.ranking.begin(), {{"tension-drift"}, 0.0});
  if (d.missing.size() > 1) return;
  d.metric = "force-consistency", d.before = t.delta_before, d.after = t.delta_after;
}

/// A ripple at a multiple of a mains hum that was found is what is left of the hum.
bool is_hum(const rosin::contact_hypothesis& h, const rig_diagnosis& d) {
  const auto frequency = [](const auto& parameters) {
    for (const auto& p : parameters)
      if (p.name == "frequency_Hz") return p.value;
    return 0.0;
  };
  if (h.effect != "speed-ripple" && h.effect != "normal-force-ripple") return false;
  return std::any_of(d.missing.begin(), d.missing.end(), [&](const missing_effect& m) {
    const double mains = m.effect == "mains-hum" ? frequency(m.parameters) : 0, ripple = frequency(h.parameters);
    return mains > 0 && std::abs(ripple - mains * std::round(ripple / mains)) < 2;
  });
}

/// A contact effect is taken up where it gains clearly.
void add_contact(rosin::contact_findings found, rig_diagnosis& d) {
  for (const auto& line : found.warnings) d.warnings.push_back(line);
  if (std::erase_if(found.hypotheses, [&](const auto& h) { return h.gain > found.threshold && is_hum(h, d); }) > 0) {
    d.warnings.emplace_back("a ripple at a multiple of the mains' frequency: taken for what is left of the hum");
    found.as_declared = std::none_of(found.hypotheses.begin(), found.hypotheses.end(), [&](const auto& h) {
      return h.decided && h.gain > found.threshold && h.held_out_gain > found.threshold / 2;
    });
  }
  double gained = 0;
  if (!found.hypotheses.empty() && !found.as_declared) gained = std::max(0.0, found.hypotheses.front().evidence(found.independent));
  for (auto& r : d.ranking) r.log10_evidence -= gained / std::log(10.0);
  for (const auto& h : found.hypotheses) d.ranking.push_back({{h.effect}, found.as_declared ? std::min(-0.5, h.evidence(found.independent) / std::log(10.0)) : (h.evidence(found.independent) - gained) / std::log(10.0)});
  if (found.as_declared || found.hypotheses.empty()) return;
  const auto& best = found.hypotheses.front();
  if (!best.decided || best.gain <= found.threshold || best.held_out_gain <= found.threshold / 2) return;
  const double second = found.hypotheses.size() > 1 ? found.hypotheses[1].gain : 0;
  missing_effect m = described(best, 1 - std::exp(-std::min(30.0, best.gain - std::max(0.0, second))));
  for (std::size_t i = 1; i < found.hypotheses.size(); ++i)
    if (found.hypotheses[i].gain > best.gain - 5) m.indistinguishable_from.push_back(found.hypotheses[i].effect);
  d.missing.push_back(m);
  if (d.missing.size() > 1) return;
  d.metric = best.statistic.empty() ? "stick-fluctuation" : best.statistic;
  d.before = d.metric == "friction-residual" ? found.friction_residual : found.stick_fluctuation;
  d.noise_floor = d.metric == "friction-residual" ? found.friction_floor : found.stick_floor;
  d.after = best.fluctuation;
}

void rank(rig_diagnosis& d) {
  // Each kind of evidence has its own data; what was found comes first, the rest follows in its order.
  double top = -1e300;
  for (const auto& r : d.ranking) top = std::max(top, r.log10_evidence);
  for (auto& r : d.ranking) r.log10_evidence = std::min(0.0, r.log10_evidence - top);
  std::stable_sort(d.ranking.begin(), d.ranking.end(), [](const auto& a, const auto& b) { return a.log10_evidence > b.log10_evidence; });
}

}  // namespace

rosin::outcome<rig_diagnosis> diagnose(const rosin::rig& rig, provenance& from) {
  rig_diagnosis d;
  d.title = rig.title.value_or(rig.file);
  const rosin::rig_values values = rosin::values_of(rig);
  d.assumed = values.assumed;
  auto plucks = diagnose_plucks_of(rig, values, from, d);
  if (!plucks) return rosin::failure{plucks.error()};
  const rosin::pluck_diagnosis& p = *plucks;
  take_over(p, values, d);
  add_calibration(p, d);

  const bool can_reconstruct = p.explained && rosin::string_is_plain(p.best.effects) && values.impedance_Ns_m;
  std::vector<diagnosed_stroke> strokes;
  bool contact_open = false;
  if (can_reconstruct) strokes = reconstruct_strokes(rig, values, p, 0, from, d);
  else if (std::any_of(rig.takes.begin(), rig.takes.end(), [](const auto& t) { return t.kind == rosin::take_kind::bow; }))
    d.assumed.emplace_back("the strokes were not examined: the contact cannot be seen past what the string itself does");
  if (!strokes.empty()) {
    const rosin::tension_drift drift = drift_of(strokes);
    if (drifted(drift)) {
      add_drift(drift, d);
      strokes = reconstruct_strokes(rig, values, p, drift.relative, from, d);
    }
    const rosin::contact_findings contact = contact_of(rig, strokes);
    add_contact(contact, d);
    contact_open = !contact.as_declared && d.missing.empty();
  }
  rank(d);
  d.verdict = !p.explained || contact_open ? "unexplained" : d.missing.empty() ? "no-mismatch" : "explained";
  if (d.verdict != "no-mismatch" && d.take.empty()) {
    d.take = strokes.empty() ? p.data.takes.front().name : strokes.front().name;
    d.residual_over_noise = d.noise_floor > 0 ? d.before / d.noise_floor : 0;
  }
  if (d.verdict == "no-mismatch") d.after.reset();
  return d;
}

}  // namespace tool
