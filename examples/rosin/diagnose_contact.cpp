// SPDX-License-Identifier: MIT
//
// The contact, on strokes that are reconstructed with all that the plucks tell: which effects of it does the declared model not
// own up to?
//
#include "diagnose_contact_picture.hpp"

#include <map>

namespace tool {

namespace {

constexpr int most_contact_effects = 2;
constexpr double periods_in_picture = 4;
constexpr double further_tone_share =
    0.05;  ///< of what was gained so far on the same statistic: no model of a contact is exact either,
constexpr double further_give_share = 0.2;     ///< and what one model of its give leaves another one takes up
constexpr double takes_most = 0.5;             ///< of the fluctuation that a further model of the contact's give finds
constexpr double further_other_share = 0.005;  ///< of what was gained on another statistic
constexpr double most_left = rosin::contact_findings::most_left;

missing_effect described(const rosin::contact_hypothesis& h, double probability) {
  missing_effect m;
  m.effect = h.effect;
  m.probability = std::clamp(probability, 0.0, 1.0);
  for (const auto& p : h.parameters) m.parameters.push_back({p.name, p.value, p.sd});
  m.statement = statement_of(m);
  return m;
}

/// What is left of a hum moves the string by more than noise.
bool hums(const rig_diagnosis& d) {
  return std::any_of(d.missing.begin(), d.missing.end(), [](const missing_effect& m) { return m.effect == "mains-hum"; });
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

/// Without ripples that are left of the hum; nor does anything count that gains less than twice as much as they. Whether there
/// were any.
bool take_out_hum(rosin::contact_findings& found, const rig_diagnosis& d) {
  double most = 0;
  for (const auto& h : found.hypotheses)
    if (h.gain > found.needed(h) && is_hum(h, d)) most = std::max(most, h.gain);
  if (most == 0) return false;
  std::erase_if(found.hypotheses, [&](const auto& h) { return found.stands(h) && (is_hum(h, d) || h.gain < 2 * most); });
  return true;
}

/// The data that a statistic is taken from: what sticks, at one place or at two, or what slips.
std::string data_of(const std::string& statistic) { return statistic == "friction-residual" ? statistic : "stick-fluctuation"; }

double left_in(const std::string& data, const rosin::contact_findings& found) {
  return data == "friction-residual" ? found.friction_residual : found.stick_fluctuation;
}

double floor_in(const std::string& data, const rosin::contact_findings& found) {
  return data == "friction-residual" ? found.friction_floor : found.stick_floor;
}

open_contact shown_by(const std::string& statistic, const rosin::contact_findings& found) {
  const std::string data = data_of(statistic);
  return {data, {}, left_in(data, found), floor_in(data, found)};
}

/// What the diagnosis is judged by where nothing else is wrong with the rig.
void judge_by(const open_contact& open, rig_diagnosis& d) {
  d.metric = open.statistic, d.before = open.size, d.after = open.size, d.noise_floor = open.floor;
  if (!open.take.empty()) d.take = open.take;
}

/// What was gained so far, in nats, by the data that it was gained on.
using gains_so_far = std::map<std::string, double>;

/// The least that a further effect has to gain beside them; what takes most of what is left needs no more than the first.
double least_further(const gains_so_far& sofar, const rosin::contact_hypothesis& h, const rosin::contact_findings& found) {
  const bool gives = h.statistic == "stick-fluctuation" && h.effect != "speed-ripple";
  if (gives && h.fluctuation < takes_most * found.stick_fluctuation) return 0;
  if (h.of_samples > 0) return 0;  // sought where the first one leaves little
  double least = 0;
  for (const auto& [data, nats] : sofar)
    least = std::max(least, nats * (data != data_of(h.statistic) ? further_other_share
                                    : gives                      ? further_give_share
                                                                 : further_tone_share));
  return least;
}

/// Takes up the likeliest contact effect where it gains clearly; true if there was one. `found` is of the model with `sofar`
/// gained.
bool add_contact(rosin::contact_findings& found, const gains_so_far& sofar, rig_diagnosis& d) {
  if (sofar.empty())
    for (const auto& line : found.warnings) d.warnings.push_back(line);
  if (take_out_hum(found, d)) {
    d.warnings.emplace_back("a ripple at a multiple of the mains' frequency: taken for what is left of the hum");
    found.as_declared =
        std::none_of(found.hypotheses.begin(), found.hypotheses.end(), [&](const auto& h) { return found.stands(h); });
  }
  const bool nothing = found.as_declared;  // else the first one stands
  const double gained = nothing ? 0.0 : std::max(0.0, found.hypotheses.front().evidence(found.independent));
  if (sofar.empty()) {
    for (auto& r : d.ranking) r.log10_evidence -= gained / std::log(10.0);
    for (const auto& h : found.hypotheses) {
      const double nats = h.evidence(found.independent) - gained;
      d.ranking.push_back({{h.effect}, (nothing ? std::min(-0.5, nats) : nats) / std::log(10.0), {}});
    }
  }
  if (nothing) return false;
  const auto& best = found.hypotheses.front();
  if (best.gain < least_further(sofar, best, found)) return false;
  // What explains far more, but with parameters that the strokes leave open, forbids to name the lesser.
  if (std::any_of(found.hypotheses.begin(), found.hypotheses.end(),
                  [&](const auto& h) { return !h.decided && h.gain > 2 * best.gain && h.gain > found.threshold; }))
    return false;
  double second = 0;
  for (std::size_t i = 1; i < found.hypotheses.size(); ++i)
    if (const double g = found.hypotheses[i].gain; g <= best.gain) second = std::max(second, g);
  missing_effect m = described(best, 1 - std::exp(-std::min(30.0, best.gain - second)));
  for (std::size_t i = 1; i < found.hypotheses.size(); ++i)
    if (std::abs(found.hypotheses[i].gain - best.gain) < 5) m.indistinguishable_from.push_back(found.hypotheses[i].effect);
  d.missing.push_back(m);
  if (d.missing.size() > 1) return true;
  judge_by(shown_by(best.statistic, found), d);
  d.after = best.fluctuation;
  if (best.noise > 0) d.noise_floor = best.noise;
  return true;
}

/// What no name was found for, where it is more than noise and imperfect models leave: of string and sensors as well, where
/// something was found there.
std::optional<open_contact> left_open(const std::vector<diagnosed_stroke>& strokes, const rosin::contact_findings& found,
                                      const rig_diagnosis& d) {
  constexpr double much = 5, least = 0.06, beside_others = 2.5;
  const bool alone = d.missing.empty();
  if (!alone && hums(d)) return std::nullopt;
  if (!found.as_declared) return shown_by(found.hypotheses.front().statistic, found);  // it stands, but may not be named
  const double allowance = alone ? 1 : beside_others;
  for (const auto& s : strokes)
    if (s.delta > std::max(allowance * least, much * parting_by_noise(s)))
      return open_contact{"force-consistency", s.name, s.delta, parting_by_noise(s)};
  const std::string statistic = rosin::beyond_doubt(found, allowance);
  if (statistic.empty()) return std::nullopt;
  return shown_by(statistic, found);
}

const std::vector<rosin::contact_trace>& traces_of(const std::string& statistic, const rosin::contact_findings& found) {
  return data_of(statistic) == "friction-residual" ? found.slipping : found.sticking;
}

double period_of(const std::vector<diagnosed_stroke>& strokes) {
  const auto& delay = strokes.front().calibration.at.delay_s;
  return 2 * (delay[0] + delay[1]);
}
double shown_length_s(const rosin::contact_hypothesis& h, const std::vector<diagnosed_stroke>& strokes) {
  for (const auto& p : h.parameters)
    if (p.name == "frequency_Hz" && h.effect.find("ripple") != std::string::npos && p.value > 0)
      return periods_in_picture / p.value;
  return periods_in_picture * period_of(strokes);
}

using asked_contact = std::function<rosin::contact_findings(const rosin::contact_model&)>;

/// The first of two once more, with the second in the model: it may have held a part of it.
void settle_first(const asked_contact& ask, const rosin::contact_model& declared, const rosin::contact_hypothesis& second,
                  missing_effect& first) {
  const rosin::contact_findings found = ask(rosin::include(declared, second));
  const auto again =
      std::find_if(found.hypotheses.begin(), found.hypotheses.end(), [&](const auto& h) { return h.effect == first.effect; });
  if (again == found.hypotheses.end() || !found.stands(*again)) return;
  missing_effect m = described(*again, first.probability);
  m.indistinguishable_from = first.indistinguishable_from;
  first = std::move(m);
}

/// Torsion does not feel the tension. Declared relative to transverse waves as the plucks had them, its speed and impedance are
/// other multiples of what the strokes have; declared at the strokes' tension, they are not: whichever leaves less while the
/// string sticks.
void take_up_drift(const asked_contact& ask, double tension_drift, rosin::contact_model& model, rosin::contact_findings& found) {
  if (tension_drift == 0 || !model.torsion) return;
  rosin::contact_model other = model;
  other.torsion = rosin::at_tension(*other.torsion, tension_drift);
  rosin::contact_findings with = ask(other);
  if (with.stick_fluctuation < found.stick_fluctuation) model = std::move(other), found = std::move(with);
}

/// What is left while the string sticks once the likeliest effect is in the model, if one stands.
double left_at_best(const rosin::contact_findings& found) {
  return found.as_declared || found.hypotheses.front().fluctuation <= 0 ||
                 data_of(found.hypotheses.front().statistic) != "stick-fluctuation"
             ? found.stick_fluctuation
             : std::min(found.stick_fluctuation, found.hypotheses.front().fluctuation);
}

/// A notebook's torsion is off by some thousandths, as its other values are: where the strokes tell it better, it is a nuisance and
/// nothing is missing. Taken up if it leaves less, alone or with the effect that is likeliest then.
void take_up_torsion(const asked_contact& ask, const rosin::torsion_values& declared, rosin::contact_model& model,
                     rosin::contact_findings& found, rig_diagnosis& d) {
  constexpr double clearly_less = 0.95;
  const Eigen::Vector3d notebook(0.02, 0.06, 0.25);  // relative
  const auto torsion = std::find_if(found.hypotheses.begin(), found.hypotheses.end(),
                                    [&](const auto& h) { return h.effect == "torsion" && found.stands(h); });
  if (!model.torsion || torsion == found.hypotheses.end()) return;
  const rosin::torsion_values told{torsion->parameters[0].value, torsion->parameters[1].value, torsion->parameters[2].value};
  if (((told.logs() - declared.logs()).cwiseAbs() - notebook).maxCoeff() > 0) return;
  rosin::contact_model other = model;
  other.torsion = told;
  rosin::contact_findings with = ask(other);
  if (!(left_at_best(with) < clearly_less * left_at_best(found)) && found.hypotheses.front().effect != "torsion") return;
  model = std::move(other), found = std::move(with);
  std::erase_if(d.assumed, [](const std::string& line) { return line.rfind("torsion as the strokes tell it", 0) == 0; });
  d.assumed.push_back("torsion as the strokes tell it: speed_ratio " + in_digits(told.speed_ratio, "%.4g") +
                      ", impedance_ratio " + in_digits(told.impedance_ratio, "%.4g") + ", q " + in_digits(told.q, "%.3g") +
                      "; the rig file's is off by less than " + "notebooks are (2, 6 and 25 %)");
}

}  // namespace

bool examine_contact(const rosin::rig& rig, const std::vector<diagnosed_stroke>& strokes,
                     const std::vector<diagnosed_stroke>& held, const rosin::pluck_diagnosis& plucks, double tension_drift,
                     const std::vector<std::string>& without, rig_diagnosis& d) {
  rosin::contact_model model = declared_contact(rig);
  model.included.insert(model.included.end(), without.begin(), without.end());
  const asked_contact ask = [&](const rosin::contact_model& m) { return contact_of(rig, strokes, plucks, m); };
  rosin::contact_findings found = ask(model);
  take_up_drift(ask, tension_drift, model, found);
  const std::optional<rosin::torsion_values> noted = model.torsion;
  const auto take_up_told = [&] {
    if (noted) take_up_torsion(ask, *noted, model, found, d);
  };
  take_up_told();
  rosin::contact_model declared = model;
  const std::size_t others = d.missing.size();
  gains_so_far gained;
  bool sticking = false;
  std::string first;  // statistic
  const rosin::contact_findings at_first = found;
  rosin::contact_findings since = found;
  std::optional<rig_diagnosis> wide;  // no more than a width found, which takes most away
  const auto accounted = [&] { return !sticking || rosin::accounts_for_sticking(at_first, since, found); };
  for (int round = 0; round < most_contact_effects && add_contact(found, gained, d); ++round) {
    const rosin::contact_hypothesis best = found.hypotheses.front();
    if (round == 0) {
      first = best.statistic;
      d.contact = contact_picture_of(best.before.empty() ? traces_of(first, found) : best.before, data_of(first),
                                     shown_length_s(best, strokes));
      add_after(best.after, *d.contact);
    }
    gained[data_of(best.statistic)] += best.gain;
    sticking = sticking || best.statistic == "stick-fluctuation";
    if (round > 0) settle_first(ask, declared, best, d.missing[others]);
    model = rosin::include(std::move(model), best);
    found = ask(model);
    take_up_told();
    if (best.effect != "torsion") declared.torsion = model.torsion;
    if (best.width_s > 0) since = round == 0 ? found : ask(rosin::include(declared, best));  // in whichever order they were found
    if (first == data_of(first)) add_after(traces_of(first, found), *d.contact);
    if (others == 0 && data_of(first) == d.metric && (first == d.metric || round > 0))
      d.after = left_in(d.metric, found), d.noise_floor = floor_in(d.metric, found);
    if (round == 0 && best.width_s > 0 && found.stick_fluctuation < most_left * at_first.stick_fluctuation) wide = d;
  }
  if (wide && !accounted()) d = *std::move(wide), found = since, sticking = false;  // it stands without what does not
  const bool named = d.missing.size() > others;
  for (const diagnosed_stroke& s : held) d.held_out.push_back(s.name);
  if (named && others == 0 && !held.empty()) {
    const auto foretold = contact_of(rig, held, plucks, model);
    d.before = left_in(d.metric, contact_of(rig, held, plucks, declared));
    d.after = left_in(d.metric, foretold), d.noise_floor = floor_in(d.metric, foretold);
  }
  const std::optional<open_contact> open = named ? std::nullopt : left_open(strokes, found, d);
  if (open && others == 0) judge_by(*open, d);
  if (open && others > 0) d.left_in_strokes = open;
  if (open && open->statistic != "force-consistency")
    d.contact =
        contact_picture_of(traces_of(open->statistic, found), data_of(open->statistic), periods_in_picture * period_of(strokes)),
    first = open->statistic;
  if (d.contact) show_contact(d, others == 0 ? d.noise_floor : floor_in(data_of(first), found), others == 0);
  if (!named) return !open;
  const bool most_is_left = others == 0 && d.after > std::max(2 * d.noise_floor, most_left * d.before);
  if (!most_is_left && accounted()) return true;
  d.missing.erase(d.missing.begin() + static_cast<std::ptrdiff_t>(others), d.missing.end());
  if (d.missing.empty()) d.after = d.before;
  if (others > 0) d.left_in_strokes = shown_by("stick-fluctuation", found);
  d.contact->after.clear(), d.contact->cycle_after.clear();
  return false;
}

}  // namespace tool
