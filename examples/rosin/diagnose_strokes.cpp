// SPDX-License-Identifier: MIT
#include "diagnose_parts.hpp"
#include "digits.hpp"

#include <rosin/calibrate/calibration.hpp>
#include <rosin/diagnose/corrected_take.hpp>
#include <rosin/diagnose/even_tension.hpp>
#include <rosin/diagnose/loaded_motion.hpp>
#include <rosin/diagnose/stroke_place.hpp>
#include <rosin/reconstruct/dc_level.hpp>

namespace tool {

namespace {

constexpr double least_place_sd = 0.001;  // fraction of the length

/// The fit with all that was found, as a plain calibration of the string.
rosin::calibration calibration_with(const rosin::pluck_diagnosis& p, double declared, const rosin::rig_values& values) {
  rosin::pluck_fit_result fit = p.declared;
  const Eigen::Index plain = p.data.layout.size();
  Eigen::VectorXd v = p.best.value.head(plain);
  for (std::size_t i = 0; i < p.best.effects.size(); ++i) {
    const std::string& name = p.best.effects[i].name;
    const std::vector<double> found = p.best.values_of(i);
    if (name == "bending-stiffness") v[rosin::pluck_layout::inharmonicity] += found[0];
    if (name == "frequency-dependent-loss") v[rosin::pluck_layout::internal_loss] += found[0];
    if (name == "air-loss") v[rosin::pluck_layout::air_loss] += found[0], v[rosin::pluck_layout::loss_drag] += found[1];
  }
  fit.value = v;
  if (p.best.covariance.rows() >= plain) fit.covariance = p.best.covariance.topLeftCorner(plain, plain);
  fit.noise_N = p.best.quality.noise;
  const double z = values.impedance_Ns_m->value;
  return rosin::calibration_from(fit, declared, z, values.impedance_Ns_m->sd / z);
}

rosin::bow_motion<double> motion_of(const diagnosed_stroke& s, const rosin::pluck_scene& scene, const rosin::band& limits) {
  if (scene.plain_string()) return rosin::reconstructor<double>(s.calibration.at, limits, s.rate_Hz)(s.force_N[0], s.force_N[1]);
  return rosin::reconstruct_loaded(scene, s.calibration.at, s.force_N, limits, s.rate_Hz);
}

/// A take and its calibration, without what the sensors did to it.
diagnosed_stroke recorded_stroke(const rosin::take& take, const rosin::take_signals& read, const rosin::calibration& calibration,
                                 const rosin::pluck_diagnosis& plucks, const rosin::band& limits) {
  diagnosed_stroke s;
  s.name = take.name, s.rate_Hz = read.sample_rate_Hz, s.hold_out = take.hold_out;
  const rosin::take bowed = rosin::with_measured(take, rosin::motion_of(take, read));
  s.speed_m_s = bowed.speed_m_s.value_or(0), s.normal_force_N = bowed.normal_force_N.value_or(0);
  s.calibration = calibration;
  s.recorded_N = {read.near_N(), read.far_N()};
  rosin::undo_sensors(plucks.data, plucks.best, s.recorded_N, calibration.at.delay_s, s.rate_Hz, limits.stop_Hz);
  s.force_N = rosin::detail::calibrated(s.calibration, s.recorded_N[0], s.recorded_N[1]);
  return s;
}

/// The tension of a string that its motion stretches is taken to its mean; returns the clock on which it stays there.
std::optional<rosin::wave_clock> even_out(diagnosed_stroke& s, const rosin::pluck_diagnosis& plucks, double length_m) {
  const double axial_N = axial_stiffness_of(plucks);
  const auto& at = s.calibration.at;
  if (!(axial_N > 0) || !(length_m > 0) || !is_plain(plucks)) return std::nullopt;
  const double tension_N = at.impedance_Ns_m * length_m / (at.delay_s[0] + at.delay_s[1]);
  const rosin::wave_clock clock(rosin::stretch_by_motion(s.force_N, at.delay_s, s.rate_Hz, tension_N, axial_N));
  for (std::size_t c = 0; c < 2; ++c) s.recorded_N[c] = clock.even(s.recorded_N[c]), s.force_N[c] = clock.even(s.force_N[c]);
  s.stretch = clock.mean_stretch();
  s.calibration = rosin::at_tension(s.calibration, s.stretch);
  return clock;
}

/// Of the calibrated channels.
std::array<double, 2> noise_of(const rosin::calibration& c) { return {c.noise_N[0] / c.gain[0], c.noise_N[1] / c.gain[1]}; }

/// What follows from the motion: the mean of its two versions, how sure it is, and how they differ.
void add_means_and_doubts(diagnosed_stroke& s, const rosin::band& limits) {
  for (std::size_t i = 0; i < s.motion.force_near_N.size(); ++i) {
    s.mean_N.push_back(s.motion.force_N(i));
    s.mean_m_s.push_back(s.motion.velocity_m_s(i));
  }
  const auto slopes = rosin::sensitivity<rosin::full_physics>(s.calibration, s.force_N[0], s.force_N[1], limits, s.rate_Hz);
  s.sd = rosin::uncertainty<rosin::full_physics>(s.calibration, s.motion, slopes, noise_of(s.calibration), limits, s.rate_Hz);
  const auto middle = (s.motion.known.begin + s.motion.known.end) / 2;
  s.force_sd_N = s.sd.force_sd_N[middle], s.velocity_sd_m_s = s.sd.velocity_sd_m_s[middle];
  s.delta = rosin::consistency_delta(s.motion.force_near_N, s.motion.force_far_N);
}

/// Where a stroke was made, if not where the plucks were: nearby, or where both were declared, if the plucks were clearly elsewhere.
/// Nothing where another tension accounts for how its versions part, or neither does.
std::optional<double> own_place(const diagnosed_stroke& s, double declared, const rosin::rig_values& values,
                                const rosin::pluck_diagnosis& plucks, const std::function<double(double)>& parting) {
  constexpr double over_noise = 3, share = 0.3, of_drift = 0.7;
  if (!(s.delta > over_noise * parting_by_noise(s))) return std::nullopt;
  // either place may be off by the tolerance, which is two standard deviations
  const double doubt = 4 * std::max(least_place_sd, values.position ? values.position->sd : 0.0),
               plucked = s.calibration.position;
  rosin::stroke_place best = rosin::search_stroke_place(parting, plucked, doubt);
  if (std::abs(plucked - declared) > tolerated_offset(values))
    if (const auto there = rosin::search_stroke_place(parting, declared, doubt); there.delta < best.delta) best = there;
  if (!(best.delta < share * s.delta) || !(best.delta < of_drift * drift_of({s}, plucks).delta_after)) return std::nullopt;
  return best.position;
}

/// How far the amplifiers' zeros were off in the plucks, together, rms; 0 where that is within five standard deviations of none.
double zero_of_plucks_N(const rosin::pluck_diagnosis& plucks) {
  using layout = rosin::pluck_layout;
  const auto& fit = plucks.best;
  const std::size_t takes = plucks.data.takes.size();
  double power = 0, doubt = 0;
  for (std::size_t t = 0; t < takes; ++t)
    for (const auto& [offset, gain] :
         {std::pair{layout::offset_near, layout::gain_near}, {layout::offset_far, layout::gain_far}}) {
      const Eigen::Index at = plucks.data.layout.at(t, offset);
      const double newtons = std::exp(-fit.value[gain]);
      power += std::pow(newtons * fit.value[at], 2), doubt += std::pow(newtons * (at < fit.sd.size() ? fit.sd[at] : 0.0), 2);
    }
  return power > 25 * doubt ? std::sqrt(power / static_cast<double>(takes)) : 0;
}

}  // namespace

double axial_stiffness_of(const rosin::pluck_diagnosis& plucks) {
  for (std::size_t i = 0; i < plucks.best.effects.size(); ++i)
    if (plucks.best.effects[i].name == "tension-modulation") return plucks.best.values_of(i)[0];
  return 0;
}

std::vector<diagnosed_stroke> reconstruct_strokes(const rosin::rig& rig, const rosin::rig_values& values,
                                                  const rosin::pluck_diagnosis& plucks, double tension_drift, provenance& from,
                                                  std::vector<std::string>& warnings, const std::string& only,
                                                  std::optional<rosin::band> band) {
  const rosin::pluck_scene scene = rosin::scene_of(plucks.data, plucks.best);
  std::vector<diagnosed_stroke> out;
  for (const auto& take : rig.takes) {
    if (take.kind != rosin::take_kind::bow || (!only.empty() && take.name != only)) continue;
    const auto position = rig.position_of(take);
    const auto read = read_telling(rig, take, from, warnings);
    if (!read) continue;
    if (!position || rosin::has_error(read->check.findings)) {
      warnings.push_back(take.name + ": left out " + (position ? "for the error above" : "as its position is unknown"));
      continue;
    }
    const double rate = read->signals.sample_rate_Hz;
    const rosin::band limits = band.value_or(rosin::band{0.30 * rate, 0.45 * rate});
    const rosin::calibration plucked = rosin::at_tension(calibration_with(plucks, *position, values), tension_drift);
    const auto made_at = [&](double place) {
      diagnosed_stroke s = recorded_stroke(take, read->signals, rosin::at_place(plucked, place), plucks, limits);
      const auto clock = even_out(s, plucks, values.length_m ? values.length_m->value : 0);
      s.motion = motion_of(s, scene, limits);
      if (clock) clock->read_back(s.motion);
      return s;
    };
    diagnosed_stroke s = made_at(plucked.position);
    if (s.motion.known.end <= s.motion.known.begin + 500) {
      warnings.push_back(take.name + ": left out: too short");
      continue;
    }
    add_means_and_doubts(s, limits);
    const auto own = own_place(s, *position, values, plucks, [&](double place) {
      const auto motion = made_at(place).motion;
      return rosin::consistency_delta(motion.force_near_N, motion.force_far_N);
    });
    if (own) {
      s = made_at(*own);
      s.own_place = own;
      add_means_and_doubts(s, limits);
    }
    out.push_back(std::move(s));
  }
  return out;
}

void add_lost_levels(const rosin::rig& rig, const rosin::pluck_diagnosis& plucks, std::vector<diagnosed_stroke>& strokes) {
  const rosin::pluck_scene scene = rosin::scene_of(plucks.data, plucks.best);
  if (!(scene.sensors[0].corner_Hz > 0) && !rig.channel("near")->ac_coupled_Hz && !rig.channel("far")->ac_coupled_Hz) {
    for (diagnosed_stroke& s : strokes) s.level_sd_N = zero_of_plucks_N(plucks);
    return;
  }
  for (diagnosed_stroke& s : strokes) {
    const auto dc = rosin::estimate_dc_level(s.mean_N, s.mean_m_s, s.speed_m_s, s.normal_force_N);
    if (!dc.available) continue;
    s.level_sd_N = dc.sd_N;
    for (auto* force : {&s.mean_N, &s.motion.force_near_N, &s.motion.force_far_N})
      for (double& f : *force) f += dc.level_N;
    const auto& delay = s.calibration.at.delay_s;
    for (std::size_t c = 0; c < 2; ++c)
      for (double& f : s.force_N[c]) f += dc.level_N * rosin::held_forces(scene, delay[0] / (delay[0] + delay[1]))[c];
  }
}

double parting_by_noise(const diagnosed_stroke& s) {
  const auto known = Eigen::Map<const Eigen::ArrayXd>(s.mean_N.data(), static_cast<Eigen::Index>(s.mean_N.size()))
                         .segment(static_cast<Eigen::Index>(s.motion.known.begin),
                                  static_cast<Eigen::Index>(s.motion.known.end - s.motion.known.begin));
  // The versions part by twice what their mean is off; the force's mean does not count.
  return std::sqrt(2.0) * s.sd.force_noise_N / std::sqrt(std::max(1e-300, (known - known.mean()).square().mean()));
}

rosin::tension_drift drift_of(const std::vector<diagnosed_stroke>& strokes, const rosin::pluck_diagnosis& plucks) {
  const double rate = strokes.front().rate_Hz;
  const rosin::band limits{0.30 * rate, 0.45 * rate};
  const rosin::pluck_scene scene = rosin::scene_of(plucks.data, plucks.best);
  if (!scene.plain_string()) {
    std::vector<std::array<std::vector<double>, 2>> moved;
    for (const auto& s : strokes) moved.push_back(rosin::moved_ends(scene, s.force_N, limits, rate));
    return rosin::search_tension_drift(strokes.size(), [&](std::size_t i, double relative) {
      const auto motion = rosin::reconstruct_loaded(scene, rosin::at_tension(strokes[i].calibration, relative).at,
                                                    strokes[i].force_N, moved[i], limits, rate);
      return rosin::consistency_delta(motion.force_near_N, motion.force_far_N);
    });
  }
  std::vector<rosin::bowed_recording> takes;
  for (const auto& s : strokes) takes.push_back({s.recorded_N[0], s.recorded_N[1], s.calibration});
  return rosin::find_tension_drift(takes, limits, rate);
}

bool is_plain(const rosin::pluck_diagnosis& plucks) { return rosin::string_is_plain(plucks.data.guess, plucks.best.effects); }

rosin::contact_model declared_contact(const rosin::rig& rig) {
  rosin::contact_model model;
  if (rig.torsion) model.torsion = rosin::torsion_values{rig.torsion->speed_ratio, rig.torsion->impedance_ratio, rig.torsion->q};
  if (rig.model && rig.model->friction) model.law = static_cast<rosin::contact_law>(*rig.model->friction);
  if (rig.model)
    for (const auto& name : rig.model->physics)
      if (name != "torsion") model.included.push_back(name);
  return model;
}

rosin::contact_take contact_take_of(const rosin::rig& rig, const diagnosed_stroke& s, const rosin::pluck_diagnosis& plucks) {
  rosin::contact_take t{s.name, s.mean_N, s.mean_m_s, s.motion.velocity_near_m_s, s.motion.velocity_far_m_s};
  t.near_N = s.force_N[0], t.far_N = s.force_N[1];
  t.sides = rosin::sides_of(rosin::scene_of(plucks.data, plucks.best), s.calibration.at.delay_s);
  t.rate_Hz = s.rate_Hz, t.rod_speed_m_s = s.speed_m_s, t.normal_force_N = s.normal_force_N;
  t.delay_s = s.calibration.at.delay_s, t.stiffness_s2 = s.calibration.at.stiffness_s2;
  t.loss = s.calibration.at.loss;
  t.stretch = s.stretch;
  t.impedance_Ns_m = s.calibration.at.impedance_Ns_m, t.length_m = rig.string.length_m.value_or(0);
  t.noise_N = noise_of(s.calibration);
  t.force_sd_N = s.force_sd_N, t.velocity_sd_m_s = s.velocity_sd_m_s, t.level_sd_N = s.level_sd_N, t.edge_Hz = 0.45 * s.rate_Hz;
  rosin::leave_out_silence(t);
  rosin::follow_start(t, declared_contact(rig).torsion);
  return t;
}

std::vector<rosin::contact_take> contact_takes(const rosin::rig& rig, const std::vector<diagnosed_stroke>& strokes,
                                               const rosin::pluck_diagnosis& plucks) {
  std::vector<rosin::contact_take> takes;
  for (const auto& s : strokes) takes.push_back(contact_take_of(rig, s, plucks));
  return takes;
}

std::vector<std::string> approaches_of(const rosin::rig& rig, const std::vector<diagnosed_stroke>& strokes,
                                       const rosin::pluck_diagnosis& plucks) {
  std::vector<std::string> out;
  for (const diagnosed_stroke& s : strokes) {
    const rosin::contact_take t = contact_take_of(rig, s, plucks);
    if (t.approach.seen())
      out.push_back(t.name + ": the rod is still gathering speed, or the string settling, " +
                    in_digits(1000 * t.approach.time_s, "%.2g") + " ms to an e-th: examined from " +
                    in_digits(t.start_s, "%.3f") + " s on");
    else if (t.start_s > rosin::stick_take::usual_start_s)
      out.push_back(t.name + ": hardly a force in the beginning: examined from " + in_digits(t.start_s, "%.3f") + " s on");
    if (t.force_N.size() < s.mean_N.size())
      out.push_back(t.name + ": hardly a force in the end: examined to " +
                    in_digits(static_cast<double>(t.force_N.size()) / t.rate_Hz, "%.3f") + " s");
  }
  return out;
}

rosin::contact_findings contact_of(const rosin::rig& rig, const std::vector<diagnosed_stroke>& strokes,
                                   const rosin::pluck_diagnosis& plucks, const rosin::contact_model& model) {
  return rosin::contact_hypotheses(contact_takes(rig, strokes, plucks), model);
}

std::optional<rosin::width_and_drift> width_and_drift_of(const rosin::rig& rig, const std::vector<diagnosed_stroke>& strokes,
                                                         const rosin::pluck_diagnosis& plucks) {
  constexpr double parts = 0.1;  // a width that can be told makes the versions do so
  const rosin::contact_model model = declared_contact(rig);
  if (!model.torsion || std::none_of(strokes.begin(), strokes.end(), [](const diagnosed_stroke& s) { return s.delta > parts; }))
    return {};
  return rosin::find_width_and_drift(contact_takes(rig, strokes, plucks), *model.torsion);
}

std::optional<double> see_as_wide(const rosin::rig& rig, const rosin::pluck_diagnosis& plucks, double width_m,
                                  diagnosed_stroke& s) {
  rosin::contact_take take = contact_take_of(rig, s, plucks);
  rosin::contact_model model = declared_contact(rig);
  if (take.length_m > 0) model.width_s = width_m / take.length_m * (take.delay_s[0] + take.delay_s[1]);
  const auto one = rosin::as_one_contact({take}, model);
  if (!one) return std::nullopt;
  auto& m = s.motion;
  // what they part by stays
  const auto centre_on = [](std::vector<double>& a, std::vector<double>& b, const std::vector<double>& mean) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const double apart = 0.5 * (a[i] - b[i]);
      a[i] = mean[i] + apart, b[i] = mean[i] - apart;
    }
  };
  centre_on(m.force_near_N, m.force_far_N, one->force_N[0]);
  centre_on(m.velocity_near_m_s, m.velocity_far_m_s, one->velocity_m_s[0]);
  return one->takes[0].edge_Hz;
}

}  // namespace tool
