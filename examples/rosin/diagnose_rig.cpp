// SPDX-License-Identifier: MIT
//
// Plucks first: what do they say of string, ends, wire and sensors? Then the strokes, reconstructed with that: tension and
// contact.
//
#include "diagnose_parts.hpp"
#include "digits.hpp"
#include "rig_ends.hpp"

#include <rosin/diagnose/mismatch_class.hpp>

namespace tool {

namespace {

constexpr double drift_fault = 5e-5;  ///< beside noise, by what else the two versions part; found on rigs of two other simulators
constexpr double loaded_drift_fault =
    3e-4;  ///< the same of strings with loads or yielding ends, whose noise is not told by the search
constexpr double wide_drift_fault = 1e-3;  ///< and beside a contact of some width

/// A converter that oversamples by four may smear a release over a quarter of its step: a variance of (T/4)^2 / 12 beside the d^2
/// (1/4 - 2/pi^2) of the release itself. What that makes of the duration d.
double smear_of(double duration_s, double rate_Hz) {
  constexpr double pi = std::numbers::pi, share = 0.25 - 2 / (pi * pi);
  return std::pow(0.25 / rate_Hz, 2) / 12 / (2 * share * std::max(duration_s, 0.25 / rate_Hz));
}

/// An effect's name in its id, which goes on with the place or the variant.
std::string bare(const std::string& id) { return id.substr(0, id.find_first_of("@ ")); }

/// Mean and standard deviation of what every take has its own of, where that is never zero.
std::optional<std::array<double, 2>> mean_of_takes(const rosin::pluck_diagnosis& p, std::size_t which) {
  const auto& parameters = p.best.effects[which].parameters;
  if (parameters.empty() || parameters[0].take < 0 || !(parameters[0].low > 0)) return {};
  const std::vector<double> all = p.best.values_of(which);
  Eigen::Index at = p.best.first_of(which);
  const auto n = static_cast<double>(all.size());
  double sum = 0, square = 0;
  for (const double v : all) sum += v / n, square += std::pow(p.best.sd[at++] / n, 2);
  double apart = 0;
  for (const double v : all) apart += (v - sum) * (v - sum) / n;
  return {{sum, std::sqrt(square + apart / n)}};
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
      const std::string name = bare(id);
      if (name != e.name &&
          std::find(m.indistinguishable_from.begin(), m.indistinguishable_from.end(), name) == m.indistinguishable_from.end())
        m.indistinguishable_from.push_back(name);
    }
  Eigen::Index at = p.best.first_of(which);
  std::array<double, 2> hum{}, hum_sd{};
  for (std::size_t i = 0; i < e.parameters.size(); ++i, ++at) {
    const rosin::effect_parameter& q = e.parameters[i];
    const double v = rosin::to_physical(q, p.best.value[at]), sd = p.best.sd[at] * (q.logarithmic ? v : 1);
    if (q.late || (q.take >= 0 && q.low > 0)) continue;
    if (q.name == "amplitude") {
      if (const std::size_t of_first = i - 1; of_first < 4)
        hum[of_first / 2] = std::hypot(hum[of_first / 2], v), hum_sd[of_first / 2] = sd;  // the fundamental in the first take
      continue;
    }
    m.parameters.push_back(in_si(q.name, v, sd, values, p.best.value[0]));
  }
  if (const auto own = mean_of_takes(p, which))
    m.parameters.push_back(in_si(e.parameters[0].name, own->at(0), own->at(1), values, p.best.value[0]));
  for (auto& q : m.parameters)
    if (q.name == "duration_s") q.sd = std::hypot(q.sd, smear_of(q.value, p.data.takes.front().rate_Hz));
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

std::vector<std::string> bare(const std::vector<std::string>& ids) {
  std::vector<std::string> out;
  for (const auto& id : ids) out.push_back(bare(id));
  return out;
}

void add_place(const rosin::acting_place& place, rig_diagnosis& d) {
  switch (place.on) {
    case rosin::acting::on_string:
      d.position = place.position;
      d.acts =
          "on the string at " + in_digits(place.position, "%.4f") + " +- " + in_digits(2 * place.sd, "%.1g") + " of its length";
      break;
    case rosin::acting::near_end:
      d.position = 0, d.acts = "at the near end";
      break;
    case rosin::acting::far_end:
      d.position = 1, d.acts = "at the far end";
      break;
    case rosin::acting::with_release:
      d.position = place.position, d.acts = "where the string is plucked, with the release, or alike in both channels";
      break;
    case rosin::acting::near_channel:
      d.acts = "in the near channel";
      break;
    case rosin::acting::far_channel:
      d.acts = "in the far channel";
      break;
  }
}

void take_over(const rosin::pluck_diagnosis& p, const rosin::rig_values& values, rig_diagnosis& d) {
  for (std::size_t i = 0; i < p.best.effects.size(); ++i)
    if (missing_effect m = described(p, i, values); !p.is_ordinary(i)) d.missing.push_back(std::move(m));
    else d.assumed.push_back("what any wire does, and has no name: " + m.statement);
  for (const auto& h : p.ranking) d.ranking.push_back({bare(h.ids), h.log_evidence / std::log(10.0), h.left});
  d.held_out = p.held_out;
  d.before = p.before, d.noise_floor = p.floor;
  d.residual = residuals_of(p);
  if (p.mismatched) d.after = p.after;
  if (!p.mismatched) return;
  d.take = p.data.takes[p.mismatch.take].name, d.channel = p.mismatch.channel == 0 ? "near" : "far";
  d.time_s = p.mismatch.time_s, d.band_Hz = p.mismatch.band_Hz, d.residual_over_noise = p.mismatch.residual_over_noise;
  if (d.residual) d.kind = d.residual->kind, d.echo = d.residual->echoes[p.mismatch.channel].at((*d.time_s)[0]);
  for (const auto& m : d.missing)
    if (m.position) d.position = m.position;
  if (p.mismatch.place) add_place(*p.mismatch.place, d);
}

void add_calibration(const rosin::pluck_diagnosis& p, rig_diagnosis& d) {
  for (Eigen::Index i = 0; i < p.data.layout.size(); ++i)
    if (!p.data.layout.is_own_loss(i) && i != (p.data.layout.own_losses() > 0 ? p.data.layout.loss_scatter() : -1))
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
  for (std::size_t i = 0; i < p.best.effects.size(); ++i)  // as the effect that all takes share
    if (const auto own = mean_of_takes(p, i))
      d.calibration.push_back({p.best.effects[i].name + " " + p.best.effects[i].parameters[0].name, own->at(0), own->at(1)});
  for (const std::size_t c : {0U, 1U})
    d.calibration.push_back({channel_noise[c], p.best.quality.noise[c], std::numeric_limits<double>::quiet_NaN()});
}

/// Drift counts where it takes away most of what the two versions of the force part by, and a moved contact does not do as well.
bool drifted(const rosin::tension_drift& t) {
  return std::abs(t.relative) > 5 * t.sd && t.delta_after < 0.7 * t.delta_before && t.delta_after < 0.9 * t.delta_moved_contact &&
         t.delta_before > 0.004;
}

missing_effect drift_by(double relative, double sd) {
  missing_effect m;
  m.effect = "tension-drift";
  m.probability = 0.999;
  m.parameters = {{"relative", relative, sd}};
  m.statement = "The tension changed by " + in_digits(100 * relative, "%+.3g") + " % between the plucks and the strokes.";
  return m;
}

void add_drift(const rosin::tension_drift& t, const std::vector<diagnosed_stroke>& strokes, bool plain_string, rig_diagnosis& d) {
  d.missing.push_back(drift_by(t.relative, std::hypot(t.sd, plain_string ? drift_fault : loaded_drift_fault)));
  // Of the force's two versions a few hundred samples a take are independent: ln L rises by n ln(before / after).
  const double gain = 500 * std::log(t.delta_before / std::max(1e-6, t.delta_after)) / std::log(10.0);
  for (auto& r : d.ranking) r.log10_evidence -= gain;
  d.ranking.insert(d.ranking.begin(), {{"tension-drift"}, 0.0});
  if (d.missing.size() > 1) return;
  double parting = 0;
  for (const auto& s : strokes) parting += std::pow(parting_by_noise(s), 2) / static_cast<double>(strokes.size());
  d.metric = "force-consistency", d.before = t.delta_before, d.after = t.delta_after, d.noise_floor = std::sqrt(parting);
}

/// A stroke stretches a string, too: a rise in tension up to twice that of the strongest pluck needs no other cause once E A is
/// found.
bool stretched_by_motion(const rosin::tension_drift& t, const rosin::pluck_diagnosis& p, const rosin::rig_values& values) {
  const double axial_N = axial_stiffness_of(p);
  if (!(axial_N > 0) || !(t.relative > 0) || !values.impedance_Ns_m || !values.length_m) return false;
  const rosin::scene_plucks model(p.data.layout, p.data.guess.ac_coupled_Hz, p.best.effects);
  const double tension_N = values.impedance_Ns_m->value * 2 * values.length_m->value * p.best.value[0];
  double most = 0;
  for (std::size_t i = 0; i < p.data.takes.size(); ++i)
    most = std::max(most, rosin::mean_stretch(model.string(p.best.value), p.best.value[model.position(i)],
                                              std::exp(p.best.value[model.at(i, rosin::pluck_layout::strength)]) / tension_N,
                                              axial_N / (4 * tension_N), 1));
  return t.relative < 2 * most;
}

/// Strokes that are only predicted, taken out of those to fit.
std::vector<diagnosed_stroke> set_aside(std::vector<diagnosed_stroke>& strokes) {
  std::vector<diagnosed_stroke> fitted, held;
  for (auto& s : strokes) (s.hold_out ? held : fitted).push_back(std::move(s));
  strokes = std::move(fitted);
  return held;
}

/// A contact of some width hides a drift, and a drift the width: both at once, where that leaves nothing open. `d`: before the
/// contact was examined.
std::optional<rig_diagnosis> wide_and_drifted(const rosin::rig& rig, const rosin::rig_values& values,
                                              const std::vector<diagnosed_stroke>& strokes, const rosin::pluck_diagnosis& p,
                                              const std::vector<std::string>& without, provenance& from, rig_diagnosis d) {
  constexpr double least_gain = 1000, sure = 5;
  const auto both = width_and_drift_of(rig, strokes, p);
  if (!both || both->gain < least_gain || std::abs(both->relative) < sure * std::hypot(both->sd, wide_drift_fault)) return {};
  std::vector<std::string> said;  // once already
  auto again = reconstruct_strokes(rig, values, p, both->relative, from, said);
  add_lost_levels(rig, p, again);
  const auto held = set_aside(again);
  const std::size_t others = d.missing.size();
  if (!examine_contact(rig, again, held, p, both->relative, without, d)) return {};
  const auto contact = d.missing.begin() + static_cast<std::ptrdiff_t>(others);
  if (std::none_of(contact, d.missing.end(), [](const auto& m) { return m.effect == "finite-contact-width"; })) return {};
  d.missing.insert(contact, drift_by(both->relative, std::hypot(both->sd, wide_drift_fault)));
  for (auto& r : d.ranking)  // of the contact all were tried at that tension
    if (r.effects == std::vector<std::string>{"finite-contact-width"}) r.effects.insert(r.effects.begin(), "tension-drift");
  return d;
}

/// Names of the strokes in which the string moves as far as the obstacle that was found: of Helmholtz motion
/// v x (1 - x) / (2 f0 p) to either side at x, bowed at p.
std::string strokes_that_rattle(const rosin::rig& rig, const rosin::rig_values& values, const rosin::pluck_diagnosis& p,
                                const rosin::rattle& met) {
  constexpr double near_it = 0.7;  // friction holds the string aside besides
  const double x = met.place.position;
  std::string names;
  for (const rosin::take& take : rig.takes) {
    if (take.kind != rosin::take_kind::bow) continue;
    const double bowed = rig.position_of(take).value_or(values.position ? values.position->value : 0.5);
    if (take.speed_m_s && *take.speed_m_s * x * (1 - x) / (2 * p.best.value[0] * bowed) < near_it * std::abs(met.gap_m)) continue;
    names += (names.empty() ? "" : ", ") + take.name;
  }
  return names;
}

void rank(rig_diagnosis& d) {
  // Each kind of evidence has its own data; what was found comes first, the rest follows in its order.
  double top = -1e300;
  for (const auto& r : d.ranking) top = std::max(top, r.log10_evidence);
  for (auto& r : d.ranking) r.log10_evidence = std::min(0.0, r.log10_evidence - top);
  std::stable_sort(d.ranking.begin(), d.ranking.end(),
                   [](const auto& a, const auto& b) { return a.log10_evidence > b.log10_evidence; });
}

}  // namespace

rosin::outcome<rig_diagnosis> diagnose(const rosin::rig& rig, provenance& from, const std::vector<std::string>& without,
                                       int threads, const std::function<void()>& step) {
  rig_diagnosis d;
  d.title = rig.title.value_or(rig.file);
  const rosin::rig_values values = rosin::values_of(rig);
  d.assumed = values.assumed;
  for (const std::size_t end : {0U, 1U})
    if (to_be_fitted(rig, end))
      d.assumed.push_back(std::string{"terminations."} + (end == 0 ? "near" : "far") +
                          " = \"fit\": begins as rigid; what moves there is named");
  const auto plucks = diagnose_plucks_of(rig, values, from, d.warnings, without, threads);
  step();
  if (!plucks) return rosin::failure{plucks.error()};
  const rosin::pluck_diagnosis& p = plucks->sound();
  take_over(p, values, d);
  assume_of_plucks(p, d);
  const auto knows = [&](const char* effect) { return std::find(without.begin(), without.end(), effect) == without.end(); };
  if (p.explained && knows("pluck-position")) name_pluck_position(values, p, d);
  const bool accounted = !plucks->odd || add_odd(*plucks->odd, values, knows, d);
  if (p.explained && knows("dropouts")) name_dropouts(rig, p, from, d);
  add_calibration(p, d);

  std::vector<diagnosed_stroke> strokes;
  const bool plain_string = is_plain(p);
  bool contact_open = false;
  const auto reaching = plucks->odd && plucks->odd->met ? strokes_that_rattle(rig, values, p, *plucks->odd->met) : std::string{};
  if (!reaching.empty())
    d.assumed.push_back("the strokes were not examined: in " + reaching + " the string's motion reaches the obstacle as well");
  else if (p.explained && values.impedance_Ns_m) strokes = reconstruct_strokes(rig, values, p, 0, from, d.warnings);
  else if (std::any_of(rig.takes.begin(), rig.takes.end(), [](const auto& t) { return t.kind == rosin::take_kind::bow; }))
    d.assumed.emplace_back("the strokes were not examined: the contact cannot be seen past what the plucks leave unexplained");
  step();
  std::vector<diagnosed_stroke> held = set_aside(strokes);
  if (strokes.empty() && !held.empty()) d.assumed.emplace_back("the strokes were not examined: all of them are marked hold_out");
  if (!strokes.empty()) {
    const rosin::tension_drift drift = drift_of(strokes, p);
    const double rise = drifted(drift) && knows("tension-drift") ? drift.relative : 0;
    if (rise != 0) {
      if (stretched_by_motion(drift, p, values))
        d.assumed.push_back("the strokes' tension is " + in_digits(100 * drift.relative, "%+.3g") +
                            " % off the plucks': their motion stretches the string");
      else add_drift(drift, strokes, plain_string, d);
      strokes = reconstruct_strokes(rig, values, p, rise, from, d.warnings);
      held = set_aside(strokes);
    }
    step();
    add_lost_levels(rig, p, strokes);
    add_lost_levels(rig, p, held);
    for (const auto& s : strokes)
      if (s.own_place)
        d.assumed.push_back(s.name + ": bowed at " + in_digits(*s.own_place, "%.4f") +
                            " of the length, where its two versions part least, not where the plucks were");
    for (const auto& line : approaches_of(rig, strokes, p)) d.assumed.push_back(line);
    const rig_diagnosis before = d;
    contact_open = !examine_contact(rig, strokes, held, p, rise, without, d);
    if (contact_open && rise == 0 && knows("tension-drift") && knows("finite-contact-width"))
      if (auto both = wide_and_drifted(rig, values, strokes, p, without, from, before))
        d = *std::move(both), contact_open = false;
  }
  rank(d);
  d.verdict = !p.explained || contact_open || !accounted ? "unexplained" : d.missing.empty() ? "no-mismatch" : "explained";
  if (d.verdict != "no-mismatch" && d.take.empty()) d.take = strokes.empty() ? p.data.takes.front().name : strokes.front().name;
  if (d.verdict != "no-mismatch" && d.kind.empty() && d.metric != "pluck-residual")
    d.kind = rosin::name_of(d.metric == "force-consistency" ? rosin::mismatch_class::sensor_or_string
                                                            : rosin::mismatch_class::contact);
  if (d.verdict != "no-mismatch" && !(d.residual_over_noise > 0))
    d.residual_over_noise = d.noise_floor > 0 ? d.before / d.noise_floor : 0;
  if (d.verdict == "no-mismatch") d.after.reset();
  return d;
}

}  // namespace tool
