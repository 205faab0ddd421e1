// SPDX-License-Identifier: MIT
//
// What is wrong with single takes: samples that were lost, a pluck that contradicts the others, one that was made elsewhere.
//
#include "diagnose_parts.hpp"
#include "digits.hpp"

namespace tool {

namespace {

/// Rms residual / rms recorded of a take with and without what lies between two instants (and what a band's filter makes of
/// them).
std::array<double, 2> with_and_without(const rosin::pluck_diagnosis& p, const rosin::pluck_take& take, double from_s,
                                       double to_s) {
  constexpr double blurred = 80;
  const rosin::take_and_model t = rosin::detail::compare_late(p, take);
  double recorded = 0, off = 0, inside = 0;
  for (std::size_t c = 0; c < 2; ++c)
    for (Eigen::Index i = 0; i < t.recorded[c].size(); ++i) {
      const double square = std::pow(t.recorded[c][i] - t.model[c][i], 2), at = t.begin_s + static_cast<double>(i) / t.rate_Hz;
      recorded += std::pow(t.recorded[c][i], 2), off += square;
      if (at > from_s - blurred / t.rate_Hz && at < to_s + blurred / t.rate_Hz) inside += square;
    }
  return {std::sqrt(off / std::max(1e-300, recorded)), std::sqrt((off - inside) / std::max(1e-300, recorded))};
}

missing_effect lost(const std::string& take, const std::string& channel, double samples, double time_s, double time_sd_s = 0) {
  missing_effect m;
  m.effect = "dropouts", m.channel = channel;
  m.parameters = {{"samples", samples, 0}, {"time_s", time_s, time_sd_s}};
  m.statement = take + (channel.empty() ? "" : ", channel " + channel) + ": " + in_digits(samples, "%.0f") +
                " samples were lost, from " + in_digits(time_s, "%.4f") + " s on.";
  return m;
}

missing_effect made_at(const std::string& take, double position, double sd, double declared) {
  missing_effect m;
  m.effect = "pluck-position", m.position = position;
  m.parameters = {{"position", position, sd}};
  m.statement = (take.empty() ? std::string{"The string"} : take + ": the string") + " was plucked at " +
                in_digits(position, "%.4f") + " of its length, not at " + in_digits(declared, "%.4f") + ".";
  return m;
}

missing_effect met(const rosin::rattle& r, const rosin::rig_values& values) {
  missing_effect m;
  m.effect = "rattle", m.position = r.place.position;
  m.parameters = {{"position", r.place.position, r.place.sd}, in_si("gap_m", std::abs(r.gap_m), r.gap_sd_m, values, 0)};
  m.statement = statement_of(m);
  return m;
}

/// What accounts for the odd one, and by how much the others' prediction of it gets better.
void add_cause(missing_effect m, rig_diagnosis& d) {
  const double gain = static_cast<double>(d.residual->before.force_N[0].size()) * std::log10(d.before / std::max(1e-9, *d.after));
  for (auto& r : d.ranking) r.log10_evidence -= gain;
  d.ranking.insert(d.ranking.begin(), {{m.effect}, 0.0});
  d.missing.push_back(std::move(m));
}

std::string contradiction(const rosin::odd_pluck& odd) {
  std::string names = odd.take.name;
  const std::string& told_by = odd.others.data.takes[0].name;
  for (const rosin::pluck_take& take : odd.also) names += ", " + take.name;
  if (std::any_of(odd.also.begin(), odd.also.end(), [&](const auto& take) { return take.name == told_by; }))
    return names + ": something acts on the string in each of them; it is told by what that leaves unchanged of " + told_by;
  const std::string out = names + (odd.also.empty() ? " contradicts" : " contradict") + " the other plucks: ";
  if (odd.lost) return out + in_digits(static_cast<double>(odd.lost->count), "%.0f") + " samples are missing in it";
  const double others_Hz = odd.others.best.value[rosin::pluck_layout::fundamental],
               apart = odd.own_fundamental_Hz / others_Hz - 1;
  const std::string strongest = odd.strongest ? "; it is the strongest: something that only large motion meets?" : "";
  if (odd.moved) return out + "it was made elsewhere";
  if (odd.own_fundamental_Hz > 0 && std::abs(apart) > 1e-5)
    return out + "by itself it rings at " + in_digits(odd.own_fundamental_Hz, "%.6g") + " Hz, the others at " +
           in_digits(others_Hz, "%.6g") + " Hz; another tuning or another string?" + strongest;
  return out + "off from " + in_digits(odd.time_s[0], "%.4f") + " s on" + strongest;
}

}  // namespace

bool add_odd(const rosin::odd_pluck& odd, const rosin::rig_values& values, const std::function<bool(const char*)>& knows,
             rig_diagnosis& d) {
  const bool lost_some = odd.lost && knows("dropouts"), moved = odd.moved && knows("pluck-position");
  d.warnings.push_back(contradiction(odd));
  d.take = odd.take.name, d.channel.clear(), d.time_s = odd.time_s, d.band_Hz.reset(), d.position.reset(), d.acts.clear();
  d.before = odd.before, d.after = lost_some || moved ? odd.after : odd.before, d.noise_floor = odd.floor;
  d.residual_over_noise = odd.floor > 0 ? odd.before / odd.floor : 0;
  d.held_out = {odd.take.name};
  d.residual = residuals_of(odd);
  if (lost_some) add_cause(lost(odd.take.name, {}, static_cast<double>(odd.lost->count), odd.lost->time_s, odd.lost->sd_s), d);
  if (moved) add_cause(made_at(odd.take.name, odd.moved->position, odd.moved->sd, odd.take.position), d);
  if (lost_some || moved) return true;
  if (!odd.met) return false;
  const rosin::rattle* rattle = &*odd.met;
  d.position = rattle->place.position, d.time_s = {rattle->first_s, rattle->first_s + odd.time_s[1] - odd.time_s[0]};
  d.before = rattle->before, d.after = rattle->after, d.noise_floor = rattle->floor,
  d.residual_over_noise = rattle->before / rattle->floor;
  d.residual = residuals_of(odd, *rattle);
  add_cause(met(*rattle, values), d);
  return true;
}

void name_dropouts(const rosin::rig& rig, const rosin::pluck_diagnosis& p, provenance& from, rig_diagnosis& d) {
  for (const rosin::take& take : rig.takes) {
    const auto read = read_take(rig, take, from);
    const auto position = rig.position_of(take);
    if (!read) continue;
    for (const rosin::finding& f : read->check.findings) {
      if (f.kind != "dropouts" || (f.channel != "near" && f.channel != "far")) continue;
      d.missing.push_back(lost(take.name, f.channel, static_cast<double>(f.samples), f.start_s));
      if (!d.take.empty()) continue;
      d.take = take.name, d.channel = f.channel, d.time_s = {f.start_s, f.end_s};
      d.after = d.before;
      if (take.kind != rosin::take_kind::pluck || !position || !take.force_N) continue;
      const auto [before, after] = with_and_without(p,
                                                    {take.name,
                                                     read->signals.sample_rate_Hz,
                                                     {read->signals.near_N(), read->signals.far_N()},
                                                     *take.force_N,
                                                     rosin::force_tolerance_of(take),
                                                     *position},
                                                    f.start_s, f.end_s);
      d.before = before, d.after = after, d.held_out = {take.name};
      d.residual_over_noise = d.noise_floor > 0 ? before / d.noise_floor : 0;
    }
  }
}

double tolerated_offset(const rosin::rig_values& values) {
  constexpr double least = 0.02, clearly = 6;
  return std::max(least, values.position ? clearly * values.position->sd : 0.0);
}

void name_pluck_position(const rosin::rig_values& values, const rosin::pluck_diagnosis& p, rig_diagnosis& d) {
  for (std::size_t t = 0; t < p.data.takes.size(); ++t) {
    const Eigen::Index at = p.data.layout.position(t);
    const double declared = p.data.takes[t].position, found = p.best.value[at];
    if (!(std::abs(found - declared) > tolerated_offset(values))) continue;
    d.missing.push_back(made_at({}, found, p.best.sd[at], declared));
    if (!d.take.empty()) return;
    rosin::scene_fit as_declared = p.best;
    as_declared.value[at] = declared;
    const auto seen = rosin::detail::predicted(p.data, as_declared, p.data.takes[t], rosin::detail::rms_of(p.best.quality.noise));
    d.take = p.data.takes[t].name, d.before = seen[0], d.after = p.after;
    d.residual_over_noise = d.noise_floor > 0 ? d.before / d.noise_floor : 0;
    return;
  }
}

void assume_of_plucks(const rosin::pluck_diagnosis& p, rig_diagnosis& d) {
  using layout = rosin::pluck_layout;
  if (p.slow_noise > 0)
    d.assumed.push_back("the plucks' noise is slow, at the pitch " + in_digits(p.slow_noise, "%.2g") +
                        " times (power) what it is at high frequencies: what lies between the first partials was taken out");
  if (p.data.options.causality)
    d.assumed.push_back("the string's loss is causal: waves are faster by " + in_digits(p.best.value[layout::causality], "%.3f") +
                        " / (pi Q) per e-fold of frequency");
  if (p.data.options.uneven_loss) {
    const double highest_Hz = p.data.options.limits_for(p.data.takes.front().rate_Hz).stop_Hz,
                 most = rosin::detail::largest_unevenness(p.data.layout.string(p.best.value), highest_Hz);
    d.assumed.push_back("the string's loss is uneven: 1/Q is up to " + in_digits(100 * most, "%.2g") +
                        " % off its law at a partial");
  }
  if (p.data.layout.has_own_losses(p.best.value))
    d.assumed.push_back("each mode of the string loses in its own way: 1/Q is off its law by " +
                        in_digits(100 * p.best.value[p.data.layout.loss_scatter()], "%.2g") + " % (standard deviation)");
  if (p.data.options.own_places) {
    double least = 1, most = -1;
    for (std::size_t t = 0; t < p.data.takes.size(); ++t) {
      const double off = p.best.value[p.data.layout.position(t)] - p.data.takes[t].position;
      least = std::min(least, off), most = std::max(most, off);
    }
    d.assumed.push_back("the plucks were not made at quite the same place: " + in_digits(most - least, "%.2g") +
                        " of the length apart");
  }
}

}  // namespace tool
