// tier: hosted
// SPDX-License-Identifier: MIT
//
// Where plucks leave something unexplained: is it one of them that contradicts the others? Another string, another tuning, an
// obstacle that only the strongest meets, samples that a recorder lost, a place where nobody meant to pluck. Each is left out in
// turn; if the declared model fits the others far better without one, these are diagnosed by themselves, and if nothing is left
// unexplained there, that one is the odd one. It is predicted like a take that was held out, and searched for an instant from
// which on it runs ahead by a whole number of samples, and for another place from which the others' model predicts it.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_diagnosis.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// Frames that a recorder left out.
struct lost_samples {
  std::size_t count = 0;
  double time_s = 0, sd_s = 0;  ///< of the first that is missing, from the take's beginning
};

/// Where a pluck was made, against where it was declared to be.
struct moved_pluck {
  double position = 0, sd = 0;
};

/// An obstacle that a pluck met (rattle_effect.hpp).
struct rattle {
  acting_place place;
  double gap_m = 0, gap_sd_m = 0;  ///< of the obstacle from the string at rest, positive towards the pluck's side
  double one_sided = 0;            ///< share of the force's square that pushes away from the obstacle; 1: all of it
  double first_s = 0;              ///< first contact, from the take's beginning
  double begin_s = 0;              ///< of what follows
  std::array<Eigen::VectorXd, 2> before_N{}, left_N{};  ///< residual, and what a force at that place leaves of it
  double before = 0, after = 0, floor = 0;              ///< rms residual / rms recorded without and with it; the noise's share
};

/// The part of a take after its release, and what it should be, in the band.
struct take_and_model {
  std::array<Eigen::VectorXd, 2> recorded, model;
  double begin_s = 0, rate_Hz = 0;
};

/// A pluck that contradicts the others.
struct odd_pluck {
  pluck_take take;
  pluck_diagnosis others;
  std::vector<pluck_take> also{};  ///< weaker ones that contradict the others as well
  take_and_model ringing{};        ///< by release and strength of its first periods
  double own_fundamental_Hz = 0;   ///< of this pluck fitted by itself; 0: it cannot be
  bool strongest = false;
  std::array<double, 2> time_s{};      ///< from when on it is off: a window of half a period
  double before = 0, floor = 0;        ///< rms residual / rms recorded, as the others predict it; the noise's share
  std::optional<lost_samples> lost{};  ///< if that is what is odd
  std::optional<moved_pluck> moved{};  ///< or this
  std::optional<rattle> met{};         ///< or this, where it was looked for
  take_and_model elsewhere{};          ///< `ringing` from there
  double after = 0;                    ///< with the loss, or from there
};

namespace detail {

/// A pluck is off by so many times the noise, or foretold.
inline constexpr double clearly_off = 3;

/// By release and strength of the first periods: what comes later is not to bend them.
template <class = void>
take_and_model compare_late(const pluck_diagnosis& d, const pluck_take& take, double first_periods = 5) {
  auto seen = see(d.data, d.best, take, first_periods);
  if (!seen) return {};
  seen->stage.periods = d.best.horizon_periods;
  const auto problem = seen->problem();
  const auto left = residual_of(problem, seen->fit.value, 0);
  take_and_model out{problem.part(0, 1).data, {}, problem.part(0, 1).begin_s, take.rate_Hz};
  for (std::size_t c = 0; c < 2; ++c) out.model[c] = out.recorded[c] - left[c];
  return out;
}
ROSIN_INSTANTIATE(take_and_model compare_late(const pluck_diagnosis&, const pluck_take&, double))

/// What a lost piece leaves: samples before `from` against the model, those a gap behind it against the model `lag` later.
struct loss_search {
  std::size_t from = 0, lag = 0;
  double mean_square = 1e300;
};

inline loss_search find_loss(const take_and_model& t, std::size_t most_lag, std::size_t gap) {
  const auto n = static_cast<std::size_t>(t.recorded[0].size());
  loss_search best;
  const auto error = [&](std::size_t i, std::size_t lag) {
    double sum = 0;
    for (std::size_t c = 0; c < 2; ++c)
      sum += std::pow(t.recorded[c][static_cast<Eigen::Index>(i)] - t.model[c][static_cast<Eigen::Index>(i + lag)], 2);
    return sum;
  };
  std::vector<double> before(n + 1, 0.0), behind(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) before[i + 1] = before[i] + error(i, 0);
  for (std::size_t lag = 1; lag <= most_lag && lag + 4 * gap < n; ++lag) {
    const std::size_t end = n - lag;
    behind[end] = 0;
    for (std::size_t i = end; i-- > 0;) behind[i] = behind[i + 1] + error(i, lag);
    for (std::size_t from = 0; from + 2 * gap < end; ++from)
      if (const double mean = (before[from] + behind[from + gap]) / static_cast<double>(2 * (end - gap)); mean < best.mean_square)
        best = {from, lag, mean};
  }
  return best;
}

/// A whole number of samples that is missing from some instant on, where that accounts for nearly all.
template <class = void>
void search_loss(odd_pluck& odd, const take_and_model& t) {
  constexpr std::size_t most_lag = 1024, gap = 80;  // a band's filter blurs the gap
  if (t.recorded[0].size() < static_cast<Eigen::Index>(8 * gap)) return;
  const loss_search found = find_loss(t, most_lag, gap);
  double recorded = 0, off = 0, samples = 0;
  for (std::size_t c = 0; c < 2; ++c)
    recorded += t.recorded[c].squaredNorm(), off += (t.recorded[c] - t.model[c]).squaredNorm(),
        samples += static_cast<double>(t.recorded[c].size());
  if (!(found.mean_square < 0.02 * off / samples)) return;
  odd.lost =
      lost_samples{found.lag, t.begin_s + (static_cast<double>(found.from) + 0.5 * gap) / t.rate_Hz, 0.25 * gap / t.rate_Hz};
  odd.after = std::sqrt(found.mean_square * samples / recorded);
}

/// Another place from which the model of the others predicts the pluck. What a wrong place leaves of the first periods falls
/// steadily towards the right one; there, of the whole take, it is a parabola.
template <class = void>
void search_place(odd_pluck& odd) {
  constexpr double ends = 0.02, step = 0.06, near = 1e-3, few_periods = 3;
  const auto from = [&](double position) {
    auto take = odd.take;
    take.position = position;
    return take;
  };
  const auto early = [&](double x) {
    const auto seen = see(odd.others.data, odd.others.best, from(x), few_periods, freedom::release_only);
    return seen ? seen->fit.quality.residual_ratio[0] : 1.0;
  };
  const auto whole = [&](double x) {
    return predicted(odd.others.data, odd.others.best, from(x), rms_of(odd.others.best.quality.noise), freedom::release_only);
  };
  double best = ends, least = early(best), bend = 0;
  const auto attempt = [&](double x) {
    if (const double left = early(x); left < least) least = left, best = x;
  };
  for (double x = ends + step; x <= 1 - ends; x += step) attempt(x);
  for (double reach = step / 2; reach > near; reach /= 2) attempt(best - reach), attempt(best + reach);
  for (const double h : {near, near / 10}) {
    const double below = std::pow(whole(best - h)[0], 2), here = std::pow(whole(best)[0], 2),
                 above = std::pow(whole(best + h)[0], 2);
    bend = (below + above - 2 * here) / (h * h);
    if (!(bend > 0)) return;
    best -= std::clamp((above - below) / (2 * h * bend), -2 * h, 2 * h);
  }
  const auto [left, floor, samples] = whole(best);
  if (!(left < 0.15 * odd.before && left < clearly_off * floor)) return;
  // A place counts from the nearest one that was declared and fitted: as much as that is off, so is this.
  const auto& data = odd.others.data;
  const Eigen::Index first = data.layout.position(0);
  odd.moved = moved_pluck{best + odd.others.best.value[first] - data.takes[0].position,
                          std::hypot(left / std::sqrt(0.5 * samples * bend), odd.others.best.sd[first])};
  odd.after = left;
  odd.elsewhere = compare_late(odd.others, from(best));
}

/// The first half period in which a take is off by a tenth (in amplitude) of the most.
template <class = void>
std::array<double, 2> first_off(const take_and_model& t, double fundamental_Hz) {
  const auto window = static_cast<Eigen::Index>(std::max(8.0, 0.5 * t.rate_Hz / fundamental_Hz));
  std::vector<double> power;
  for (Eigen::Index i = 0; i + window <= t.recorded[0].size(); i += window) {
    double sum = 0;
    for (std::size_t c = 0; c < 2; ++c) sum += (t.recorded[c] - t.model[c]).segment(i, window).squaredNorm();
    power.push_back(sum);
  }
  if (power.empty()) return {0, 0};
  const double enough = 0.01 * *std::max_element(power.begin(), power.end());
  const auto first = std::find_if(power.begin(), power.end(), [&](double p) { return p >= enough; }) - power.begin();
  const double begin = t.begin_s + static_cast<double>(first * window) / t.rate_Hz;
  return {begin, begin + static_cast<double>(window) / t.rate_Hz};
}

/// Against plucks that are explained by themselves; nothing if they foretell it.
template <class = void>
std::optional<odd_pluck> against(pluck_diagnosis others, const pluck_take& take, const pluck_guess& guess,
                                 const pluck_options& options) {
  odd_pluck odd{.take = take, .others = std::move(others), .strongest = true};
  const auto seen = predicted(odd.others.data, odd.others.best, take, rms_of(odd.others.best.quality.noise));
  odd.before = seen[0], odd.floor = seen[1];
  if (!(odd.before > clearly_off * odd.floor)) return std::nullopt;
  if (const auto own = fit_declared({take}, guess, options)) odd.own_fundamental_Hz = own->value[pluck_layout::fundamental];
  odd.ringing = compare_late(odd.others, take);
  if (odd.ringing.rate_Hz > 0) odd.time_s = first_off(odd.ringing, odd.others.best.value[pluck_layout::fundamental]);
  return odd;
}

/// Plucks at places of their own never contradict each other, as every place is free: of three or more the one that is farther
/// from where it is declared than a notebook could be, if the others are not: by four times the tolerance, 0.02 at least.
inline std::optional<std::size_t> misplaced(const std::vector<pluck_take>& takes, const outcome<pluck_fit_result>& fit,
                                            double position_tolerance) {
  constexpr double alike = 0.01;
  const double most_off = std::max(0.02, 4 * position_tolerance);
  if (!fit || fit->horizon_periods < 1e8 || fit->layout.positions().size() < takes.size()) return std::nullopt;
  const auto off = [&](std::size_t t) { return fit->value[fit->layout.position(t)] - takes[t].position; };
  for (std::size_t i = 0; i < takes.size(); ++i) {
    double low = 1, high = -1;
    for (std::size_t t = 0; t < takes.size(); ++t)
      if (t != i) low = std::min(low, off(t)), high = std::max(high, off(t));
    if (high - low < alike && (off(i) > high + most_off || off(i) < low - most_off)) return i;
  }
  return std::nullopt;
}

/// What the declared model leaves of the worst take; 1 where it cannot be fitted to all of their decay.
inline double worst_of(const outcome<pluck_fit_result>& fit) { return fit && fit->horizon_periods > 1e8 ? worst(*fit) : 1.0; }

}  // namespace detail

/// The odd one of at least three plucks (fitted and held out), if there is one.
template <class = void>
[[nodiscard]] std::optional<odd_pluck> find_odd_pluck(
    const std::vector<pluck_take>& takes, const std::vector<pluck_take>& held, const pluck_guess& guess,
    const pluck_options& options, const std::function<std::vector<pluck_effect>(const pluck_fit_result&)>& catalogue_for) {
  constexpr double far_better = 0.3;
  std::vector<pluck_take> all = takes;
  all.insert(all.end(), held.begin(), held.end());
  if (all.size() < 3) return std::nullopt;
  const auto without = [](std::vector<pluck_take> from, std::size_t i) {
    if (i < from.size()) from.erase(from.begin() + static_cast<std::ptrdiff_t>(i));
    return from;
  };
  const auto fit_of = [&](const std::vector<pluck_take>& some) { return detail::fit_declared(some, guess, options); };
  const auto together = fit_of(all);
  const auto elsewhere = detail::misplaced(all, together, guess.position_tolerance);
  std::size_t which = elsewhere.value_or(0);
  double least = 1;
  for (std::size_t i = 0; i < all.size() && !elsewhere; ++i)
    if (const double left = detail::worst_of(fit_of(without(all, i))); left < least) least = left, which = i;
  if (!elsewhere && !(least < far_better * detail::worst_of(together))) return std::nullopt;
  std::vector<pluck_take> fitted = without(takes, which),
                          kept = which < takes.size() ? held : without(held, which - takes.size());
  if (kept.empty() && fitted.size() > 1) kept.push_back(std::move(fitted.back())), fitted.pop_back();
  if (fitted.empty()) std::swap(fitted, kept);
  auto others = diagnose_plucks(fitted, kept, guess, options, catalogue_for);
  if (!others || !others->explained) return std::nullopt;
  auto odd = detail::against(*std::move(others), all[which], guess, options);
  if (!odd) return std::nullopt;
  for (const pluck_take& take : all) odd->strongest = odd->strongest && take.strength_N <= odd->take.strength_N;
  detail::search_loss(*odd, odd->ringing);
  if (!odd->lost) detail::search_loss(*odd, detail::compare_late(odd->others, odd->take, 1));  // an early one bends the release
  if (!odd->lost) detail::search_place(*odd);
  return odd;
}
ROSIN_INSTANTIATE(std::optional<odd_pluck> find_odd_pluck(
    const std::vector<pluck_take>&, const std::vector<pluck_take>&, const pluck_guess&, const pluck_options&,
    const std::function<std::vector<pluck_effect>(const pluck_fit_result&)>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
