// SPDX-License-Identifier: MIT
//
// Plucks first: what do they say of string, ends, wire and sensors? Then the strokes, reconstructed with that: tension and contact.
//
#include "diagnose_parts.hpp"

namespace tool {

namespace {

constexpr int most_contact_effects = 2;
constexpr double further_tone_share = 0.05;     ///< of what was gained so far: no model of a contact is exact either,
constexpr double further_give_share = 0.2;      ///< and what one model of its give leaves another one takes up
constexpr double left_of_sticking = 0.5;        ///< found on rigs of another simulator: at most 0.4 where all was named right, 0.8 where not
constexpr double drift_fault = 3e-4;           ///< beside noise, by what else the two versions part; found on rigs of another simulator

/// A converter that oversamples by four may smear a release over a quarter of its step: a variance of (T/4)^2 / 12 beside the d^2 (1/4 - 2/pi^2)
/// of the release itself. What that makes of the duration d.
double smear_of(double duration_s, double rate_Hz) {
  constexpr double pi = std::numbers::pi, share = 0.25 - 2 / (pi * pi);
  return std::pow(0.25 / rate_Hz, 2) / 12 / (2 * share * std::max(duration_s, 0.25 / rate_Hz));
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
    if (auto& last_one = m.parameters.back(); q.name == "duration_s") last_one.sd = std::hypot(sd, smear_of(v, p.data.takes.front().rate_Hz));
  }
  if (e.name == "mains-hum") {
    const std::size_t c = hum[1] > hum[0] ? 1 : 0;
    const double gain = std::exp(p.best.value[rosin::pluck_layout::gain_near + static_cast<int>(c)]);
    m.parameters.push_back(in_si("amplitude_N", hum[c] / gain, hum_sd[c] / gain, values, p.best.value[0]));
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

void add_place(const rosin::acting_place& place, rig_diagnosis& d) {
  switch (place.on) {
    case rosin::acting::on_string:
      d.position = place.position;
      d.acts = "on the string at " + rosin::detail::figure(place.position, "%.4f") + " +- " + rosin::detail::figure(2 * place.sd, "%.1g") + " of its length";
      break;
    case rosin::acting::near_end: d.position = 0, d.acts = "at the near end"; break;
    case rosin::acting::far_end: d.position = 1, d.acts = "at the far end"; break;
    case rosin::acting::near_channel: d.acts = "in the near channel"; break;
    case rosin::acting::far_channel: d.acts = "in the far channel"; break;
  }
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
  if (p.mismatch.place) add_place(*p.mismatch.place, d);
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
  m.parameters = {{"relative", t.relative, std::hypot(t.sd, drift_fault)}};
  m.statement = "The tension changed by " + rosin::detail::figure(100 * t.relative, "%+.3g") + " % between the plucks and the strokes.";
  d.missing.push_back(m);
  // Of the force's two versions a few hundred samples a take are independent: ln L rises by n ln(before / after).
  const double gain = 500 * std::log(t.delta_before / std::max(1e-6, t.delta_after)) / std::log(10.0);
  for (auto& r : d.ranking) r.log10_evidence -= gain;
  d.ranking.insert(d.ranking.begin(), {{"tension-drift"}, 0.0});
  if (d.missing.size() > 1) return;
  d.metric = "force-consistency", d.before = t.delta_before, d.after = t.delta_after;
}

/// A stroke stretches a string, too: a rise in tension up to twice that of the strongest pluck needs no other cause once E A is found.
bool stretched_by_motion(const rosin::tension_drift& t, const rosin::pluck_diagnosis& p, const rosin::rig_values& values) {
  const auto& effects = p.best.effects;
  const auto found = std::find_if(effects.begin(), effects.end(), [](const rosin::pluck_effect& e) { return e.name == "tension-modulation"; });
  if (found == effects.end() || !(t.relative > 0) || !values.impedance_Ns_m || !values.length_m) return false;
  const rosin::scene_plucks model(p.data.layout, p.data.guess.ac_coupled_Hz, effects);
  const double tension_N = values.impedance_Ns_m->value * 2 * values.length_m->value * p.best.value[0];
  const double axial_N = p.best.value[model.first_of(static_cast<std::size_t>(found - effects.begin()))];
  double most = 0;
  for (std::size_t i = 0; i < p.data.takes.size(); ++i)
    most = std::max(most, rosin::mean_stretch(model.string(p.best.value), p.best.value[model.position(i)],
                                              std::exp(p.best.value[model.at(i, rosin::pluck_layout::strength)]) / tension_N, axial_N / (4 * tension_N), 1));
  return t.relative < 2 * most;
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

/// Before and floor are those of what the contact is judged by.
void judge_by(const std::string& statistic, const rosin::contact_findings& found, rig_diagnosis& d) {
  d.metric = statistic.empty() ? "stick-fluctuation" : statistic;
  d.before = d.metric == "friction-residual" ? found.friction_residual : found.stick_fluctuation;
  d.noise_floor = d.metric == "friction-residual" ? found.friction_floor : found.stick_floor;
  d.after = d.before;
}

/// Takes up the likeliest contact effect where it gains clearly; true if there was one. `found` is of the model with `sofar` nats gained.
bool add_contact(rosin::contact_findings& found, double sofar, rig_diagnosis& d) {
  if (sofar == 0)
    for (const auto& line : found.warnings) d.warnings.push_back(line);
  if (std::erase_if(found.hypotheses, [&](const auto& h) { return h.gain > found.threshold && is_hum(h, d); }) > 0) {
    d.warnings.emplace_back("a ripple at a multiple of the mains' frequency: taken for what is left of the hum");
    found.as_declared = std::none_of(found.hypotheses.begin(), found.hypotheses.end(), [&](const auto& h) {
      return h.decided && h.gain > found.threshold && h.held_out_gain > found.threshold / 2;
    });
  }
  const bool nothing = found.as_declared || found.hypotheses.empty();
  const double gained = nothing ? 0.0 : std::max(0.0, found.hypotheses.front().evidence(found.independent));
  if (sofar == 0) {
    for (auto& r : d.ranking) r.log10_evidence -= gained / std::log(10.0);
    for (const auto& h : found.hypotheses) {
      const double nats = h.evidence(found.independent) - gained;
      d.ranking.push_back({{h.effect}, (nothing ? std::min(-0.5, nats) : nats) / std::log(10.0)});
    }
  }
  if (nothing) return false;
  const auto& best = found.hypotheses.front();
  if (!best.decided || best.gain <= found.threshold || best.held_out_gain <= found.threshold / 2) return false;
  const bool gives = best.statistic == "stick-fluctuation" && best.effect != "speed-ripple";
  if (best.gain < (gives ? further_give_share : further_tone_share) * sofar) return false;
  // What explains far more, but with parameters that the strokes leave open, forbids to name the lesser.
  if (std::any_of(found.hypotheses.begin(), found.hypotheses.end(), [&](const auto& h) { return !h.decided && h.gain > 2 * best.gain && h.gain > found.threshold; })) return false;
  const double second = found.hypotheses.size() > 1 ? found.hypotheses[1].gain : 0;
  missing_effect m = described(best, 1 - std::exp(-std::min(30.0, best.gain - std::max(0.0, second))));
  for (std::size_t i = 1; i < found.hypotheses.size(); ++i)
    if (found.hypotheses[i].gain > best.gain - 5) m.indistinguishable_from.push_back(found.hypotheses[i].effect);
  d.missing.push_back(m);
  if (d.missing.size() > 1) return true;
  judge_by(best.statistic, found, d);
  d.after = best.fluctuation;
  return true;
}

/// What the sticking string moves by beyond noise.
double stick_excess(const rosin::contact_findings& f) { return std::sqrt(std::max(0.0, f.stick_fluctuation * f.stick_fluctuation - f.stick_floor * f.stick_floor)); }

/// How far noise alone makes the two versions of a stroke's force part, as a share of the force.
double parting_by_noise(const diagnosed_stroke& s) {
  double power = 0, count = 1;
  for (std::size_t i = s.motion.known.begin; i < s.motion.known.end; ++i) power += s.mean_N[i] * s.mean_N[i], ++count;
  const double noise_N = std::hypot(s.calibration.noise_N[0] / s.calibration.gain[0], s.calibration.noise_N[1] / s.calibration.gain[1]);
  return std::sqrt(2.0) * noise_N / std::sqrt(std::max(1e-300, power / count));
}

/// Whether what no name was found for is as little as noise and imperfect models leave; else what shows it is what d is judged by.
bool is_at_rest(const std::vector<diagnosed_stroke>& strokes, const rosin::contact_findings& found, rig_diagnosis& d) {
  constexpr double much = 5, least = 0.06;
  const auto apart = std::find_if(strokes.begin(), strokes.end(), [&](const auto& s) { return s.delta > std::max(least, much * parting_by_noise(s)); });
  const std::string statistic = rosin::beyond_doubt(found);
  if (apart != strokes.end()) d.metric = "force-consistency", d.take = apart->name, d.before = apart->delta, d.after = d.before, d.noise_floor = parting_by_noise(*apart);
  else if (!statistic.empty()) judge_by(statistic, found, d);
  return apart == strokes.end() && statistic.empty();
}

/// One effect of the contact after the other; true if the contact is as the model then has it. Where one was found in what sticks, that has
/// to move by at most half of what it did, or by no more than noise makes it; else none is named.
bool examine_contact(const rosin::rig& rig, const std::vector<diagnosed_stroke>& strokes, bool plain_string, const std::vector<std::string>& without, rig_diagnosis& d) {
  rosin::contact_model model = declared_contact(rig);
  model.included.insert(model.included.end(), without.begin(), without.end());
  const std::size_t others = d.missing.size();
  double gained = 0, excess = 0;
  bool sticking = false;
  rosin::contact_findings found = contact_of(rig, strokes, plain_string, model);
  excess = stick_excess(found);
  for (int round = 0; round < most_contact_effects && add_contact(found, gained, d); ++round) {
    gained += found.hypotheses.front().gain;
    sticking = sticking || found.hypotheses.front().statistic == "stick-fluctuation";
    model = rosin::include(std::move(model), found.hypotheses.front());
    found = contact_of(rig, strokes, plain_string, model);
    if (d.metric == "stick-fluctuation") d.after = found.stick_fluctuation;
  }
  if (d.missing.size() == others) {
    if (!found.as_declared && others == 0) judge_by(found.hypotheses.front().statistic, found, d);
    return others > 0 || (found.as_declared && is_at_rest(strokes, found, d));
  }
  if (!sticking || stick_excess(found) < std::max(found.stick_floor, left_of_sticking * excess)) return true;
  d.missing.erase(d.missing.begin() + static_cast<std::ptrdiff_t>(others), d.missing.end());
  if (d.missing.empty()) d.after = d.before;
  return false;
}

void rank(rig_diagnosis& d) {
  // Each kind of evidence has its own data; what was found comes first, the rest follows in its order.
  double top = -1e300;
  for (const auto& r : d.ranking) top = std::max(top, r.log10_evidence);
  for (auto& r : d.ranking) r.log10_evidence = std::min(0.0, r.log10_evidence - top);
  std::stable_sort(d.ranking.begin(), d.ranking.end(), [](const auto& a, const auto& b) { return a.log10_evidence > b.log10_evidence; });
}

}  // namespace

rosin::outcome<rig_diagnosis> diagnose(const rosin::rig& rig, provenance& from, const std::vector<std::string>& without, const std::function<void()>& step) {
  rig_diagnosis d;
  d.title = rig.title.value_or(rig.file);
  const rosin::rig_values values = rosin::values_of(rig);
  d.assumed = values.assumed;
  const auto plucks = diagnose_plucks_of(rig, values, from, d.warnings, without);
  step();
  if (!plucks) return rosin::failure{plucks.error()};
  const rosin::pluck_diagnosis& p = plucks->sound();
  take_over(p, values, d);
  const auto knows = [&](const char* effect) { return std::find(without.begin(), without.end(), effect) == without.end(); };
  if (p.explained && knows("pluck-position")) name_pluck_position(values, p, d);
  const bool accounted = !plucks->odd || add_odd(*plucks->odd, knows("rattle") && values.impedance_Ns_m ? values.impedance_Ns_m->value : 0, d);
  if (p.explained && knows("dropouts")) name_dropouts(rig, p, from, d);
  add_calibration(p, d);

  std::vector<diagnosed_stroke> strokes;
  const bool plain_string = is_plain(p);
  bool contact_open = false;
  if (p.explained && values.impedance_Ns_m) strokes = reconstruct_strokes(rig, values, p, 0, from, d.warnings);
  else if (std::any_of(rig.takes.begin(), rig.takes.end(), [](const auto& t) { return t.kind == rosin::take_kind::bow; }))
    d.assumed.emplace_back("the strokes were not examined: the contact cannot be seen past what the plucks leave unexplained");
  step();
  if (!strokes.empty()) {
    const rosin::tension_drift drift = drift_of(strokes, p);
    if (drifted(drift) && knows("tension-drift")) {
      if (stretched_by_motion(drift, p, values)) d.assumed.push_back("the strokes' tension is " + rosin::detail::figure(100 * drift.relative, "%+.3g") + " % off the plucks': their motion stretches the string");
      else add_drift(drift, d);
      strokes = reconstruct_strokes(rig, values, p, drift.relative, from, d.warnings);
    }
    step();
    add_lost_levels(rig, p, strokes);
    contact_open = !examine_contact(rig, strokes, plain_string, without, d);
  }
  rank(d);
  d.verdict = !p.explained || contact_open || !accounted ? "unexplained" : d.missing.empty() ? "no-mismatch" : "explained";
  if (d.verdict != "no-mismatch" && d.take.empty()) {
    d.take = strokes.empty() ? p.data.takes.front().name : strokes.front().name;
    d.residual_over_noise = d.noise_floor > 0 ? d.before / d.noise_floor : 0;
  }
  if (d.verdict == "no-mismatch") d.after.reset();
  return d;
}

}  // namespace tool
