// tier: hosted
// SPDX-License-Identifier: MIT
//
// Effects that show while the string slips. The declared model says: force = normal force times a curve of the slip speed, the
// same in all takes, whatever the curve. Against it:
//
//     normal-force-ripple   N (1 + relative sin(2 pi frequency t + phase)): a tone in force / curve
//     thermal-friction      the force follows a temperature that the slips so far have left
//
// or the other way about, where the declared law is thermal. (docs/explain/catalogue.md.)
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/slip_bench.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

inline void settle_hypothesis(const law_fit& declared, const design_fit& fit, contact_hypothesis& h) {
  h.share = fit.share;
  h.density = fit.density - declared.fit.density;
  h.held_out_density = fit.held_out - declared.fit.held_out;
  h.gain = h.share * h.density;
  h.held_out_gain = h.share * h.held_out_density;
  h.fluctuation = fit.solution.scale;
  h.statistic = "friction-residual";
}

/// Slips may come once a period, so that a faster ripple looks like a slower one: it has to be likelier, by `rarer` nats.
template <class = void>
[[nodiscard]] tone_fit likely_tone(const std::vector<tone_rows>& takes, const std::vector<stroke_pitch>& pitches, double scale,
                                   double share) {
  constexpr double rarer = 10, highest_ripple_Hz = 900;
  double lowest_Hz = highest_ripple_Hz / 0.75;
  for (const auto& p : pitches) lowest_Hz = std::min(lowest_Hz, p.pitch_Hz);
  const tone_fit slow = find_tone(takes, {0.75 * lowest_Hz}), any = find_tone(takes, {highest_ripple_Hz, pitches});
  const tone_power all(takes);
  const double likelier =
      0.5 * share * all.rows * std::log(all.without(slow.explained, scale) / all.without(any.explained, scale));
  return likelier > rarer ? any : slow;
}

/// What a law leaves of each take, over what it says: rows for a tone of the normal force.
template <class = void>
[[nodiscard]] std::vector<tone_rows> left_by(const slip_bench& bench, const law_fit& law) {
  const auto& s = law.fit.solution;
  std::vector<tone_rows> takes;
  for (std::size_t t = 0; t < bench.records().size(); ++t)
    takes.push_back({s.residual[t], bench.predicted(t), student_row_factors(s.residual[t], s.scale), law.design.rows[t].sample,
                     bench.records()[t].rate_Hz});
  return takes;
}
ROSIN_INSTANTIATE(std::vector<tone_rows> left_by(const slip_bench&, const law_fit&))

}  // namespace detail

template <class = void>
[[nodiscard]] contact_hypothesis normal_ripple_hypothesis(const slip_bench& bench) {
  contact_hypothesis h{.effect = "normal-force-ripple"};
  h.statistic = "friction-residual";
  const auto& s = bench.declared().fit.solution;
  const auto takes = detail::left_by(bench, bench.declared());
  auto tone = detail::likely_tone(takes, bench.pitches(), s.scale, bench.declared().fit.share);
  if (!(tone.frequency_Hz > 0)) {
    h.decided = false, h.share = bench.declared().fit.share, h.fluctuation = bench.declared().residual();
    return h;
  }
  stick_design d = bench.declared().design;
  bench.add_tone(d, tone.frequency_Hz);
  const auto fit = fit_design(d, bench.floor());
  detail::finish_tone(takes, s.scale, fit.share, tone, h);
  const double predicted = h.held_out_gain;
  detail::settle_hypothesis(bench.declared(), fit, h);
  h.held_out_gain = std::min(h.held_out_gain, predicted);
  h.held_out_density = h.held_out_gain / h.share;
  double size = 0;
  if (constexpr double worth_it = 20; h.gain > worth_it)
    size = bench.fit_under(tone.frequency_Hz, bench.declared().law == contact_law::thermal).size();
  else
    for (const auto& own : fit.solution.own)
      size += std::hypot(own[own.size() - 2], own[own.size() - 1]) / static_cast<double>(takes.size());
  h.parameters[0].sd = std::hypot(h.parameters[0].sd, contact_faults::slip_tone * tone.frequency_Hz);  // seen once a period only
  h.parameters[1].value = size;
  double mu = 0;
  for (std::size_t t = 0; t < bench.records().size(); ++t)
    mu += std::abs(bench.predicted(t).mean()) / static_cast<double>(bench.records().size());
  // the level divides
  h.parameters[1].sd = std::hypot(h.parameters[1].sd, size * bench.level_sd() / std::max(0.1, mu - bench.level_sd()));
  return h;
}
ROSIN_INSTANTIATE(contact_hypothesis normal_ripple_hypothesis(const slip_bench&))

namespace detail {

/// Marks the rows of one part at which the others tell of a law's spline: none beyond what they hold, and none that keep it smooth.
template <class Real = double>
[[nodiscard]] std::vector<char> told_by_others(const std::vector<stick_rows>& parts, std::size_t which) {
  constexpr double few = 5, hardly = 0.1;  // samples under a piece of the spline; a row's share in pieces with no more
  Eigen::VectorX<Real> seen = Eigen::VectorX<Real>::Zero(parts[which].shared.cols());
  for (std::size_t t = 0; t < parts.size(); ++t)
    for (Eigen::Index i = 0; t != which && i < parts[t].shared.rows(); ++i)
      if (parts[t].shared.row(i).sum() > 0.5) seen += parts[t].shared.row(i).transpose();
  std::vector<char> told;
  for (Eigen::Index i = 0; i < parts[which].shared.rows(); ++i) {
    const auto row = parts[which].shared.row(i).transpose().array();
    told.push_back(row.sum() > 0.5 && (seen.array() < few).select(row, 0.0).sum() < hardly ? 1 : 0);
  }
  return told;
}
ROSIN_INSTANTIATE(std::vector<char> told_by_others(const std::vector<stick_rows>&, std::size_t))

/// By how many nats one law predicts each take better than another, from the other takes, where these tell of either.
template <class Real = double>
[[nodiscard]] double predicts_better(const stick_design& law, const stick_design& than, double floor) {
  const auto mine = at_least_two(law.rows), other = at_least_two(than.rows);
  const auto none = [](const std::vector<stick_rows>& parts) {
    const Eigen::VectorX<Real> zero = Eigen::VectorX<Real>::Zero(parts.front().shared.cols());
    return stick_prior{zero, zero};
  };
  double nats = 0;
  for (std::size_t t = 0; t < mine.size(); ++t) {
    std::vector<char> told = told_by_others(mine, t);
    const std::vector<char> as_well = told_by_others(other, t);
    for (std::size_t i = 0; i < told.size(); ++i) told[i] = told[i] && as_well[i] ? 1 : 0;
    if (std::count(told.begin(), told.end(), 1) > 100)
      nats += predict_part(mine, t, floor, none(mine), told) - predict_part(other, t, floor, none(other), told);
  }
  return nats;
}
ROSIN_INSTANTIATE(double predicts_better(const stick_design&, const stick_design&, double))

/// The same within each take, one half from the other; nothing where a take is not predicted better.
template <class = void>
[[nodiscard]] double predicts_halves_better(const stick_design& law, const stick_design& than, double floor) {
  double nats = 0;
  for (std::size_t t = 0; t < law.rows.size(); ++t) {
    stick_design mine = law, other = than;
    mine.rows = {law.rows[t]}, other.rows = {than.rows[t]};
    const double here = predicts_better(mine, other, floor);
    if (!(here > 0)) return 0;
    nats += here;
  }
  return nats;
}
ROSIN_INSTANTIATE(double predicts_halves_better(const stick_design&, const stick_design&, double))

/// What a thermal law remembers heat by.
[[nodiscard]] inline std::vector<contact_parameter> heat_of(const law_fit& law) {
  if (law.heat_memory)
    return {{"layer_m", law.heat.layer_m, law.heat.layer_m},
            {"area_per_newton_m2", law.heat.area_per_newton_m2, law.heat.area_per_newton_m2}};
  return {{"conduction_1_s", law.rates.conduction_1_s, 0.2 * law.rates.conduction_1_s},
          {"renewal", law.rates.renewal, 0.3 * law.rates.renewal + 100},
          {"capacity_power", law.rates.capacity_power, 0.5},
          {"exchange_1_m", law.rates.exchange_1_m, 0.2 * law.rates.exchange_1_m + 100}};
}

/// Whether a tone of the normal force accounts for as much of what the declared law leaves as a hypothesis does.
template <class = void>
[[nodiscard]] bool is_a_tone_as_well(const slip_bench& bench, const law_fit& declared, double floor,
                                     const contact_hypothesis& h) {
  const auto& fit = declared.fit;
  const tone_fit tone = likely_tone(left_by(bench, declared), bench.pitches(), fit.solution.scale, fit.share);
  if (!(tone.frequency_Hz > 0)) return false;
  stick_design d = declared.design;
  bench.add_tone(d, tone.frequency_Hz);
  return fit_design(d, floor).density - fit.density > h.density;
}

}  // namespace detail

/// The other law than the declared one. What the declared curve leaves may be as little as imperfect models leave: another law has
/// to explain it the better then, and no tone may do as well. Heat is the cause of what it takes the most away of; of what else is
/// wrong with a contact or a sensor it takes hardly anything.
template <class = void>
[[nodiscard]] contact_hypothesis law_hypothesis(const slip_bench& bench) {
  const bool thermal = bench.declared().law != contact_law::thermal;
  contact_hypothesis h{.effect = thermal ? "thermal-friction" : "velocity-curve-friction"};
  h.statistic = "friction-residual";
  h.free_parameters = thermal ? 3 : 0;
  law_fit declared = bench.declared();
  double floor = bench.floor();
  const bool faint = thermal && declared.residual() < 2 * floor;
  if (faint) floor = bench.least_floor(), declared.fit = fit_design(declared.design, floor);
  if (thermal && declared.residual() < 2 * floor) {  // nothing is left to explain
    h.decided = false;
    h.fluctuation = declared.residual();
    h.share = declared.fit.share;
    return h;
  }
  law_fit other = bench.fit(thermal);
  if (faint) other.fit = fit_design(other.design, floor);
  detail::settle_hypothesis(declared, other.fit, h);
  h.held_out_density = detail::predicts_better(other.design, declared.design, floor);
  if (constexpr double far_less = 1.0 / 3; thermal && other.residual() < far_less * declared.residual())  // not of one material
    h.held_out_density = std::max(h.held_out_density, detail::predicts_halves_better(other.design, declared.design, floor));
  h.held_out_gain = h.share * h.held_out_density;
  h.decided =
      other.heat_memory || (other.rates.exchange_1_m < 1.1e4 && other.rates.conduction_1_s < 4.5e3 && other.rates.renewal < 9e3);
  if (faint && detail::is_a_tone_as_well(bench, declared, floor, h)) h.decided = false;
  const double most_left = faint ? 0.6 : 0.85;  // strokes that were warm: 0.25, under a ripple 0.65; others 0.7, 0.95
  if (thermal && other.residual() > most_left * declared.residual()) h.decided = false, h.gain = h.held_out_gain = 0;
  if (thermal) h.parameters = detail::heat_of(other);
  return h;
}
ROSIN_INSTANTIATE(contact_hypothesis law_hypothesis(const slip_bench&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
