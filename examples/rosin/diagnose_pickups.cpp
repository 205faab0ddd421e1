// SPDX-License-Identifier: MIT
//
// Rigs without force transducers at both ends: what plucks heard by a pickup or a microphone say of physics that was left out.
//
#include "diagnose_pickup_page.hpp"
#include "digits.hpp"
#include "progress.hpp"
#include "rig_ends.hpp"

#include <rosin/diagnose/pickup_diagnosis.hpp>

#include <cmath>
#include <numbers>

namespace tool {

namespace {

std::optional<rosin::pickup_kind> kind_of(rosin::quantity what) {
  switch (what) {
    case rosin::quantity::termination_force:
      return rosin::pickup_kind::force;
    case rosin::quantity::string_velocity:
      return rosin::pickup_kind::velocity;
    case rosin::quantity::string_displacement:
      return rosin::pickup_kind::displacement;
    case rosin::quantity::sound:
      return rosin::pickup_kind::sound;
    default:
      return std::nullopt;
  }
}

struct heard_plucks {
  std::vector<rosin::pickup_signal> fitted, held;
  bool calibrated_force = true;  ///< every channel is a force in newtons
  bool halves = false;
};

void add_signals(const rosin::take& take, const rosin::take_signals& read, heard_plucks& out) {
  for (const auto& signal : read.signals) {
    const auto kind = kind_of(signal.sensor.quantity);
    if (!kind) continue;
    out.calibrated_force = out.calibrated_force && *kind == rosin::pickup_kind::force && signal.sensor.per_full_scale;
    (take.hold_out ? out.held : out.fitted)
        .push_back(
            {take.name, signal.sensor.name, read.sample_rate_Hz, signal.values, *kind, signal.sensor.position.value_or(0)});
  }
}

/// Without a take marked: the last of several, or the later half of one.
void set_aside(heard_plucks& h, double nominal_Hz) {
  if (!h.held.empty() || h.fitted.empty()) return;
  const std::string last = h.fitted.back().take;
  if (h.fitted.front().take != last) {
    for (const auto& s : h.fitted)
      if (s.take == last) h.held.push_back(s);
    std::erase_if(h.fitted, [&](const auto& s) { return s.take == last; });
    return;
  }
  h.halves = true;
  for (auto& s : h.fitted) {
    auto [early, late] = rosin::halves_of(s, nominal_Hz);
    s = early, h.held.push_back(late);
  }
}

rosin::outcome<heard_plucks> read_all(const rosin::rig& rig, provenance& from, rig_diagnosis& d) {
  heard_plucks out;
  progress bar{"reading", rig.takes.size()};
  for (const auto& take : rig.takes) {
    bar.step();
    if (take.kind != rosin::take_kind::pluck) continue;
    const auto read = read_telling(rig, take, from, d.warnings);
    if (read && rosin::has_error(read->check.findings)) d.warnings.push_back(take.name + ": left out for the error above");
    else if (read) add_signals(take, read->signals, out);
  }
  if (out.fitted.empty() && out.held.empty())
    return failed(rig.file + ": no pluck heard by a pickup, a microphone or a force channel", d.warnings);
  if (out.fitted.empty()) return failed(rig.file + ": every pluck is marked hold_out: none is left to fit", d.warnings);
  set_aside(out, rig.string.fundamental_Hz);
  return out;
}

/// What turns ratios into SI units, where it is known.
struct string_scale {
  std::optional<rosin::nominal> tension_N, length_m, impedance_Ns_m, mass_kg;
  bool calibrated_force = false;
};

string_scale scale_of(const rosin::rig_values& v, double f0, bool calibrated_force) {
  string_scale s{v.tension_N, v.length_m, v.impedance_Ns_m, {}, calibrated_force};
  if (v.impedance_Ns_m) s.mass_kg = rosin::nominal{v.impedance_Ns_m->value / (2 * f0), v.impedance_Ns_m->sd / (2 * f0)};
  return s;
}

double relative_sd(const rosin::nominal& n) { return n.sd / n.value; }

/// With the doubt in what it was scaled by.
diagnosed_value scaled(const char* name, double value, double sd, double doubt) {
  return {name, value, std::hypot(sd, doubt * value)};
}

/// A value in SI units where the rig file gives what that takes, otherwise as a ratio under a name that says so.
diagnosed_value named(const rosin::found_value& v, const string_scale& s, const rosin::pickup_diagnosis& p) {
  const auto& Z = s.impedance_Ns_m;
  if (v.name == "inharmonicity" && s.tension_N && s.length_m) {
    const double per = s.tension_N->value * std::pow(s.length_m->value / std::numbers::pi, 2);
    return scaled("bending_stiffness_Nm2", v.value * per, v.sd * per,
                  std::hypot(relative_sd(*s.tension_N), 2 * relative_sd(*s.length_m)));
  }
  if (v.name == "mass")
    return s.mass_kg ? scaled("mass_kg", v.value * s.mass_kg->value, v.sd * s.mass_kg->value, relative_sd(*s.mass_kg))
                     : diagnosed_value{"mass_over_string", v.value, v.sd};
  if (v.name == "lightness") {
    const double ratio = 1 / v.value, sd = v.sd * ratio * ratio;
    return s.mass_kg ? scaled("mass_kg", ratio * s.mass_kg->value, sd * s.mass_kg->value, relative_sd(*s.mass_kg))
                     : diagnosed_value{"mass_over_string", ratio, sd};
  }
  if (v.name == "resistance")
    return Z ? scaled("resistance_Ns_m", v.value * Z->value, v.sd * Z->value, relative_sd(*Z))
             : diagnosed_value{"resistance_over_impedance", v.value, v.sd};
  if (v.name == "conductance")
    return Z ? scaled("resistance_Ns_m", Z->value / v.value, Z->value * v.sd / (v.value * v.value), relative_sd(*Z))
             : diagnosed_value{"conductance_times_impedance", v.value, v.sd};
  if (v.name == "pitch_rise" && s.calibrated_force && s.tension_N) {
    const double per = 16 * std::pow(s.tension_N->value, 3);
    return scaled("axial_stiffness_N", per * p.glide_per_power, per * p.glide_per_power_sd, 3 * relative_sd(*s.tension_N));
  }
  if (v.name == "amplitude") return {s.calibrated_force ? "amplitude_N" : "amplitude_full_scale", v.value, v.sd};
  return {v.name, v.value, v.sd};
}

missing_effect described(const rosin::pickup_finding& f, const string_scale& s, const rosin::pickup_diagnosis& p) {
  missing_effect m;
  m.effect = f.effect;
  m.probability = (1 - std::exp(-std::min(30.0, f.gain))) / (1 + static_cast<double>(f.alike.size()));
  m.indistinguishable_from = f.alike;
  for (const auto& v : f.values) m.parameters.push_back(named(v, s, p));
  for (const auto& v : m.parameters)
    if (v.name == "position") m.position = v.value;
  m.statement = pickup_statement(m);
  return m;
}

pickup_picture picture_of(const rosin::pickup_diagnosis& p) {
  const auto& j = p.judged[p.worst];
  pickup_picture out{j.take, j.channel, j.rate_Hz, j.start_s, j.noise, p.law.declared.law.fundamental_Hz, j.before, j.after, {}};
  for (const auto& l : p.table.lines) {
    const auto declared = rosin::pickup_pole(p.law.declared.law, l.number), best = rosin::pickup_pole(p.law.best.law, l.number);
    constexpr double turn = 2 * std::numbers::pi;
    out.partials.push_back({l.number, l.frequency_Hz, l.frequency_sd, l.decay_per_s, l.decay_sd, declared.imag() / turn,
                            best.imag() / turn, -declared.real(), -best.real()});
  }
  return out;
}

void take_over(const rosin::pickup_diagnosis& p, const rosin::rig_values& values, const heard_plucks& plucks, rig_diagnosis& d) {
  const string_scale scale = scale_of(values, p.law.best.law.fundamental_Hz, plucks.calibrated_force);
  for (const auto& f : p.missing) d.missing.push_back(described(f, scale, p));
  for (const auto& [names, gain] : p.ranking) d.ranking.push_back({names, gain / std::log(10.0)});
  for (std::size_t i = 0; i < p.law.best.parameters.size(); ++i) {
    const auto& q = p.law.best.parameters[i];
    d.calibration.push_back({q.name, p.law.best.law.*q.member, p.law.best.sd[static_cast<Eigen::Index>(i)]});
  }
  d.calibration.push_back({"scatter_of_decay", p.law.best.scatter_decay, 0});
  d.calibration.push_back(
      {p.law.best.in_proportion ? "scatter_of_pitch_Hz_per_partial" : "scatter_of_pitch_Hz", p.law.best.scatter_Hz, 0});
  d.warnings.insert(d.warnings.end(), p.warnings.begin(), p.warnings.end());
  for (const auto& j : p.judged)
    if (std::find(d.held_out.begin(), d.held_out.end(), j.take) == d.held_out.end()) d.held_out.push_back(j.take);
  d.before = p.before, d.noise_floor = p.floor;
  d.verdict = !p.explained ? "unexplained" : p.mismatched ? "explained" : "no-mismatch";
  if (p.judged.empty()) return;
  const auto& worst = p.judged[p.worst];
  d.pickup = picture_of(p);
  if (!p.mismatched) return;
  d.after = p.after;
  d.take = worst.take, d.channel = worst.channel, d.time_s = p.time_s, d.band_Hz = p.band_Hz;
  d.residual_over_noise = rosin::rms_level(worst.before) / std::max(worst.noise, 1e-300);
  for (const auto& m : d.missing)
    if (m.position && !d.position) d.position = m.position;
}

void own_up(const rosin::rig& rig, const rosin::pickup_diagnosis& p, const heard_plucks& plucks, rig_diagnosis& d) {
  d.assumed.emplace_back(
      "amplitude and phase of every partial are free in every take and channel: where the pluck and the sensor are, how the "
      "sensor responds and how strong the pluck was is not judged");
  d.assumed.emplace_back(
      "of a take that is set aside amplitudes, phases and one pitch for all partials are free; frequencies' ratios, decays, "
      "glide and second lines are foretold");
  d.assumed.emplace_back("a place on the string is told up to its mirror image: positions count from the nearer end");
  if (plucks.halves) d.assumed.emplace_back("a single pluck: its first half was fitted, its later half foretold");
  d.assumed.push_back(
      "with every partial's own frequency and decay instead of any law, as the fitted takes have them, pluck-residual would be " +
      in_digits(p.own_poles));
  if (std::any_of(rig.takes.begin(), rig.takes.end(), [](const auto& t) { return t.kind == rosin::take_kind::bow; }))
    d.assumed.emplace_back("the strokes were not examined: a single channel does not tell force and velocity at the contact");
  for (std::size_t i = 0; i < p.table.offset.size(); ++i)
    if (std::abs(p.table.offset[i]) > 0.005)
      d.warnings.push_back(plucks.fitted[p.heard[i]].take + ": pitch " + in_digits(100 * p.table.offset[i]) +
                           " % off that of the other takes: another tuning or another string");
  const double off = p.law.best.law.fundamental_Hz / rig.string.fundamental_Hz - 1;
  if (std::abs(off) > 0.02) d.warnings.push_back("pitch: " + in_digits(100 * off) + " % from fundamental_Hz");
}

}  // namespace

rosin::outcome<rig_diagnosis> diagnose_pickups_of(const rosin::rig& rig, provenance& from,
                                                  const std::vector<std::string>& without) {
  rig_diagnosis d;
  d.title = rig.title.value_or(rig.file);
  const rosin::rig_values values = rosin::values_of(rig);
  for (const auto& line : values.assumed)
    if (line.find("position") == std::string::npos && line.find("gain") == std::string::npos &&
        line.find("force") == std::string::npos)
      d.assumed.push_back(line);
  if (any_end_moves(rig)) d.warnings.push_back(rig.file + ": terminations: without forces on both ends these begin as rigid");
  const auto plucks = read_all(rig, from, d);
  if (!plucks) return rosin::failure{plucks.error()};
  const std::vector<std::string> declared = rig.model ? rig.model->physics : std::vector<std::string>{};
  const auto found = rosin::diagnose_pickups(plucks->fitted, plucks->held, {rig.string.fundamental_Hz, declared, without});
  if (!found) return failed(rig.file + ": " + found.error(), d.warnings);
  if (found->judged.empty()) {
    d.warnings.insert(d.warnings.end(), found->warnings.begin(), found->warnings.end());
    return failed(rig.file + ": no take that was set aside could be heard", d.warnings);
  }
  take_over(*found, values, *plucks, d);
  own_up(rig, *found, *plucks, d);
  return d;
}

}  // namespace tool
