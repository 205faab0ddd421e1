// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the plucks of a rig say of physics that was left out. The declared model is fitted first; then effects are added one by one,
// each time the one that explains most, as long as it is worth it:
//
//     significance   the gain in ln L, divided by the misfit that is left (model error counts as noise), is at least 14;
//     prediction     it gains 3 on takes that were set aside, where it does not gain very much in all;
//     worth          a further effect takes away at least two thirds of what the model so far leaves beyond the noise, and that is
//                    at least a hundredth (in amplitude) of what there was to explain: no model of a bead is exact either.
//
// Two effects found one after the other may stand in one another's place; each is then taken out and sought anew.
//
// The first threshold holds the false-alarm rate of the whole search over the catalogue (its largest gain on plucks without
// an effect is 3 to 7). Evidence is  ln L - (k / 2) ln n.  Takes that were not fitted are predicted: of them only the instant of
// release and the strength are free.
//
#pragma once

#include <rosin/diagnose/nonlinear_effects.hpp>
#include <rosin/diagnose/pluck_candidates.hpp>

namespace rosin {

/// One model that was tried.
struct pluck_hypothesis {
  std::vector<std::string> ids;  ///< effects, with their place
  double log_evidence = 0;       ///< relative to the best, natural logarithm
};

/// Where the declared model and the recordings part.
struct pluck_mismatch {
  std::size_t take = 0, channel = 0;
  std::array<double, 2> time_s{}, band_Hz{};
  double residual_over_noise = 0;
};

struct pluck_diagnosis {
  scene_data data;
  pluck_fit_result declared;               ///< the fit of the declared model
  scene_fit base, best;                    ///< the same over the horizon of the best; and with what was found
  std::vector<pluck_hypothesis> ranking;
  std::vector<std::string> alternatives;   ///< to the last effect found: within 5 nats, cannot be told from it
  std::vector<double> found_gain;          ///< tempered gain of ln L of each effect found
  pluck_mismatch mismatch;
  bool mismatched = false, explained = true;
  double before = 0, after = 0, floor = 0; ///< rms residual / rms recorded, on held-out takes where there are any
  std::vector<std::string> held_out;
};

namespace detail {

inline std::vector<std::string> ids_of(const scene_fit& f) {
  std::vector<std::string> ids;
  for (const pluck_effect& e : f.effects) ids.push_back(e.id());
  return ids;
}

inline int free_parameters(const scene_fit& f) {
  int k = 0;
  for (const pluck_effect& e : f.effects) k += static_cast<int>(e.parameters.size());
  return k;
}

/// Narrowest band around the strongest bin that holds four fifths of a residual's power, by a plain periodogram of at most 4096 samples.
inline std::array<double, 2> band_of(const Eigen::VectorXd& r, double rate_Hz) {
  const auto n = static_cast<int>(std::min<Eigen::Index>(r.size(), 4096));
  const int bins = std::min(n / 2, 400);
  std::vector<double> power(static_cast<std::size_t>(bins), 0.0);
  for (int k = 0; k < bins; ++k) {
    const double w = std::numbers::pi * (k + 0.5) / bins;
    std::complex<double> sum = 0;
    const std::complex<double> turn = std::polar(1.0, -w);
    for (Eigen::Index i = n; i-- > 0;) sum = sum * turn + r[i];
    power[static_cast<std::size_t>(k)] = std::norm(sum);
  }
  const double all = std::accumulate(power.begin(), power.end(), 0.0);
  std::size_t low = static_cast<std::size_t>(std::max_element(power.begin(), power.end()) - power.begin()), high = low;
  double held = power[low];
  while (held < 0.8 * all && (low > 0 || high + 1 < power.size())) {
    const double below = low > 0 ? power[low - 1] : -1, above = high + 1 < power.size() ? power[high + 1] : -1;
    if (below > above) held += power[--low];
    else held += power[++high];
  }
  const double width = rate_Hz / 2 / bins;
  return {static_cast<double>(low) * width, static_cast<double>(high + 1) * width};
}

/// Channel, quarter period and band in which the residual of the first periods is largest.
inline pluck_mismatch locate(const scene_data& data, const scene_fit& base, double noise) {
  const auto problem = data.problem(base.effects, base.value, {1000, base.horizon_periods, true, freedom::all}, {1, 1});
  pluck_mismatch m;
  double most = 0, power = 0, count = 0;
  for (std::size_t t = 0; t < problem.takes(); ++t) {
    const auto r = residual_of(problem, base.value, t);
    const double rate = problem.rate_Hz(t);
    const auto window = static_cast<Eigen::Index>(std::max(16.0, 0.25 * rate / base.value[0]));
    for (std::size_t c = 0; c < 2; ++c) {
      power += r[c].squaredNorm(), count += static_cast<double>(r[c].size());
      for (Eigen::Index i = 0; i + window <= r[c].size(); i += window / 2)
        if (const double p = r[c].segment(i, window).squaredNorm(); p > most) {
          most = p;
          m.take = t, m.channel = c;
          const double begin = problem.part(t, 1).begin_s + static_cast<double>(i) / rate;
          m.time_s = {begin, begin + static_cast<double>(window) / rate};
          m.band_Hz = band_of(r[c], rate);
        }
    }
  }
  m.residual_over_noise = std::sqrt(power / std::max(1.0, count)) / noise;
  return m;
}

/// Of a take that was not fitted: rms residual / rms recorded; the noise's share; samples.
inline std::array<double, 3> predicted(const scene_data& data, const scene_fit& fit, const pluck_take& held, double noise) {
  scene_data one{{held}, data.guess, data.options, pluck_layout({held}, data.options)};
  const auto start = find_start(one.takes, data.guess);
  if (!start) return {1, 0, 0};
  Eigen::VectorXd v(one.layout.size());
  v.head(pluck_layout::first_position) = fit.value.head(pluck_layout::first_position);
  std::size_t nearest = 0;
  for (std::size_t t = 1; t < data.takes.size(); ++t)
    if (std::abs(data.takes[t].position - held.position) < std::abs(data.takes[nearest].position - held.position)) nearest = t;
  v[one.layout.position(0)] = fit.value[data.layout.position(nearest)] + held.position - data.takes[nearest].position;
  const auto from = [&](int which) { return fit.value[data.layout.at(nearest, which)]; };
  v[one.layout.at(0, pluck_layout::release)] = start->release_s[0] + 0.25 / start->fundamental_Hz - 0.25 / fit.value[0];
  v[one.layout.at(0, pluck_layout::strength)] = std::log(held.strength_N);
  v[one.layout.at(0, pluck_layout::offset_near)] = from(pluck_layout::offset_near);
  v[one.layout.at(0, pluck_layout::offset_far)] = from(pluck_layout::offset_far);
  std::vector<pluck_effect> effects;
  Eigen::Index at = data.layout.size();
  double horizon = 1e9;
  for (const pluck_effect& e : fit.effects) {
    pluck_effect mine = e;
    std::erase_if(mine.parameters, [](const effect_parameter& p) { return p.take > 0; });
    for (const effect_parameter& p : mine.parameters) {
      v.conservativeResize(v.size() + 1);
      v[v.size() - 1] = p.take < 0 ? fit.value[at + (&p - mine.parameters.data())] : 0.0;
    }
    horizon = std::min(horizon, e.horizon_periods);
    at += static_cast<Eigen::Index>(e.parameters.size());
    effects.push_back(std::move(mine));
  }
  std::vector<fit_stage> stages{{12, 8, false, freedom::release_only}, {1000, 12, true, freedom::release_only}, {1000, std::min(horizon, fit.horizon_periods), true, freedom::release_only}};
  const scene_fit seen = fit_scene(one, effects, v, stages, {1e-3, 1e-3});
  const auto problem = one.problem(effects, seen.value, stages.back(), {1, 1});
  double power = 0, samples = 0;
  for (const auto& part : {problem.part(0, 0), problem.part(0, 1)})
    for (const auto& d : part.data) power += d.squaredNorm(), samples += static_cast<double>(d.size());
  const double mean_square = (seen.quality.samples[0] + seen.quality.samples[1]) / std::max(1.0, samples);
  return {seen.quality.residual_ratio[0], noise * std::sqrt(mean_square * samples / std::max(1e-300, power)), samples};
}

/// By how much ln L of the takes in `held` is higher with the last effect of a fit than without it, misfit counted as noise.
inline double held_out_gain(const scene_data& data, const scene_fit& fit, const std::vector<pluck_take>& held, double noise) {
  scene_fit less = without(data, fit, fit.effects.size() - 1);
  less = fit_scene(data, less.effects, less.value, {{1000, fit.horizon_periods, true}}, {noise, noise});
  less.horizon_periods = fit.horizon_periods;
  double gain = 0;
  for (const pluck_take& take : held) {
    const auto b = predicted(data, less, take, noise), a = predicted(data, fit, take, noise);
    gain += 0.5 * a[2] * (b[0] * b[0] - a[0] * a[0]) / std::max(a[1] * a[1], a[0] * a[0]);
  }
  return gain;
}

/// Whether there is a mismatch of which the best of `fits` leaves more than half (in amplitude): over all of a record, what is small
/// per period may have turned partials too far for a score test.
inline bool leaves_much(const scene_data& data, const scene_fit& before, const std::vector<scene_fit>& fits, std::array<double, 2> noise) {
  if (fits.empty() || !(fits.front().quality.inflation() > 1.5)) return false;
  const scene_fit plain = fit_scene(data, before.effects, before.value, {{1000, fits.front().horizon_periods, true}}, noise);
  double expected = 0;
  for (const double n : fits.front().quality.samples) expected += n;
  return cost_of(fits.front(), noise) - expected > 0.25 * (cost_of(plain, noise) - expected);
}

}  // namespace detail

/// `catalogue`: effects that the declared model does not contain. Takes in `held` are predicted only.
[[nodiscard]] inline outcome<pluck_diagnosis> diagnose_plucks(const std::vector<pluck_take>& takes, const std::vector<pluck_take>& held, const pluck_guess& guess,
                                                              const pluck_options& options, const std::function<std::vector<pluck_effect>(const pluck_fit_result&)>& catalogue_for,
                                                              int most_effects = 3) {
  constexpr double most_residual = 0.95;  // a heavy bead leaves little of the declared string
  auto declared = fit_plucks(takes, guess, options, most_residual);
  if (!declared) return failure{declared.error()};
  pluck_diagnosis d{{takes, guess, options, declared->layout}, *declared, {}, {}, {}, {}, {}, {}, false, true, 0, 0, 0, {}};
  const std::array<double, 2> weigh = declared->noise_N;
  scene_fit now{{}, declared->value, declared->sd, declared->covariance, {}, {}, declared->horizon_periods, 0, true};
  now.quality.residual_ratio = declared->residual_ratio;
  const std::vector<pluck_effect> all = catalogue_for(*declared);
  std::array<double, 2> noise{1e300, 1e300};
  double all_there_was = 0;
  for (int round = 0; round < most_effects; ++round) {
    std::vector<pluck_effect> catalogue;
    for (const pluck_effect& e : all)
      if (std::none_of(now.effects.begin(), now.effects.end(), [&](const pluck_effect& h) { return h.id() == e.id(); })) catalogue.push_back(e);
    const bool strong = round == 0 ? declared->horizon_periods < 1e8 || declared->residual_ratio[0] > 0.05 : now.quality.residual_ratio[0] > 0.1;
    std::vector<scene_fit> fits = one_more_effect(d.data, now, catalogue, strong, weigh);
    if (round == 0 && !strong && detail::leaves_much(d.data, now, fits, weigh)) fits = one_more_effect(d.data, now, catalogue, true, weigh);
    if (fits.empty() && round == 0) {  // nothing is worth a fit
      d.base = fit_scene(d.data, {}, now.value, {{1000, now.horizon_periods, true}}, weigh);
      noise = d.base.quality.noise;
      d.ranking.push_back({{}, 0.0});
    }
    if (fits.empty()) break;
    const scene_fit& tried = fits.front();
    const scene_fit before = fit_scene(d.data, now.effects, now.value, {{1000, tried.horizon_periods, true, freedom::all}}, weigh);
    if (round == 0) d.base = before;
    for (std::size_t c = 0; c < 2; ++c) noise[c] = std::min({noise[c], before.quality.noise[c], tried.quality.noise[c]});
    const double temper = std::max(1.0, tried.quality.inflation());
    const double gain = 0.5 * (detail::cost_of(before, noise) - detail::cost_of(tried, noise)) / temper;
    double expected = 0;
    for (std::size_t c = 0; c < 2; ++c) expected += tried.quality.samples[c];
    const double left = std::max(0.0, detail::cost_of(tried, noise) - expected), was = std::max(1e-9, detail::cost_of(before, noise) - expected);
    if (round == 0) all_there_was = was;
    const bool worth = round == 0 || (left < was / 3 && was > 1e-4 * all_there_was);
    const double n_eff = expected;
    for (const scene_fit& f : fits)
      if (round == 0 || &f == &fits.front() || worth)
        d.ranking.push_back({detail::ids_of(f), -0.5 * detail::cost_of(f, noise) / temper - 0.5 * detail::free_parameters(f) * std::log(n_eff)});
    if (round == 0) d.ranking.push_back({{}, -0.5 * detail::cost_of(before, noise) / temper});
    // Linear parameters of which there are many (hum) gain half a unit each from noise alone.
    const double chance = std::max(0, static_cast<int>(tried.effects.back().parameters.size()) - 3);
    if (!(gain > 14 + 0.5 * chance + 2 * std::sqrt(chance)) || !worth) break;
    d.mismatched = true;
    d.found_gain.push_back(gain);
    d.alternatives.clear();
    for (const scene_fit& f : fits)
      if (&f != &tried && f.horizon_periods == tried.horizon_periods && 0.5 * (detail::cost_of(f, noise) - detail::cost_of(tried, noise)) / temper < 5 && detail::free_parameters(f) <= detail::free_parameters(tried) + 2)
        d.alternatives.push_back(f.effects.back().id());
    now = tried;
    if (now.quality.inflation() == 1.0 && round > 0) break;
  }
  d.best = exchanged(d.data, now, all, 1, noise);
  if (d.best.effects.empty()) d.best = d.base;
  const double typical = std::sqrt((noise[0] * noise[0] + noise[1] * noise[1]) / 2);
  // What is real shows in takes that were not fitted, too: half of what it must gain in the others, at least.
  while (!held.empty() && !d.best.effects.empty() && d.found_gain[d.best.effects.size() - 1] < 200 && detail::held_out_gain(d.data, d.best, held, typical) < 3) {
    const double horizon = d.best.horizon_periods;
    scene_fit less = detail::without(d.data, d.best, d.best.effects.size() - 1);
    d.best = fit_scene(d.data, less.effects, less.value, {{1000, horizon, true, freedom::all}}, {typical, typical});
    d.found_gain.resize(d.best.effects.size());
    d.alternatives.clear();
  }
  d.mismatched = d.mismatched && !d.best.effects.empty();
  std::sort(d.ranking.begin(), d.ranking.end(), [](const auto& a, const auto& b) { return a.log_evidence > b.log_evidence; });
  if (!d.ranking.empty())
    for (double top = d.ranking.front().log_evidence; auto& h : d.ranking) h.log_evidence -= top;
  d.mismatch = detail::locate(d.data, d.base, typical);

  double before2 = 0, after2 = 0, floor2 = 0;
  const std::vector<pluck_take>& judged = held.empty() ? takes : held;
  scene_fit plain = d.base;
  plain.horizon_periods = d.best.horizon_periods;
  for (const pluck_take& take : judged) {
    const auto b = detail::predicted(d.data, plain, take, typical), a = detail::predicted(d.data, d.best, take, typical);
    before2 += b[0] * b[0], after2 += a[0] * a[0], floor2 += a[1] * a[1];
    d.held_out.push_back(take.name);
  }
  const double count = static_cast<double>(judged.size());
  d.before = std::sqrt(before2 / count), d.after = std::sqrt(after2 / count), d.floor = std::sqrt(floor2 / count);
  const double excess = std::sqrt(std::max(0.0, d.after * d.after - d.floor * d.floor)), was = std::sqrt(std::max(0.0, d.before * d.before - d.floor * d.floor));
  const bool complete = d.best.quality.inflation() == 1.0 || excess < std::max(0.5 * d.floor, 0.12 * was);
  d.mismatched = d.mismatched || d.best.quality.inflation() > 1.5;
  d.explained = !d.mismatched || (complete && !d.best.effects.empty());
  if (!d.explained && excess > 0.5 * was) {  // what leaves more than half is no part of the answer; the ranking keeps it
    d.best = plain;
    d.found_gain.clear(), d.alternatives.clear();
    d.after = d.before;
  }
  return d;
}

/// The catalogue without what the declared model already contains.
[[nodiscard]] inline std::vector<pluck_effect> catalogue_without(const std::vector<std::string>& physics, const string_facts& facts, const band& limits) {
  std::vector<pluck_effect> all = pluck_effects(facts);
  for (const int channel : {0, 1}) all.push_back(sensor_nonlinearity_effect(facts, channel));
  if (facts.impedance_Ns_m > 0 && facts.length_m > 0) all.push_back(tension_modulation_effect(facts, limits));
  std::erase_if(all, [&](const pluck_effect& e) { return std::find(physics.begin(), physics.end(), e.name) != physics.end(); });
  return all;
}

}  // namespace rosin
