// tier: hosted
// SPDX-License-Identifier: MIT
//
// A string that meets an obstacle when it swings far enough: a force at one place, in one direction only, at the same
// displacement each time. Nothing else of the catalogue needs so much motion, so that the pluck that meets it contradicts softer
// ones.
//
// The place follows from both ends (mismatch_place.hpp); there the force is  f = D (A_1* r_1 + A_2* r_2) / (|A_1|^2 + |A_2|^2),
// and the string's displacement that of the pluck without an obstacle, plus what f makes of it:
//
//     y(s) = [y_0 - F M(p, x) / (s D) + M(x, x) f(s) / D] / s,     y_0 the held string's.
//
// Loads and yielding ends are left out of y. Where several plucks meet it, softer ones by themselves foretell each of them; where
// all do, what no force at one place changes of the softest (rattling_string.hpp).
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/mismatch_place.hpp>
#include <rosin/diagnose/odd_pluck.hpp>
#include <rosin/diagnose/rattling_string.hpp>

#include <algorithm>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// The record whose damped spectrum this is.
template <class Real = double>
[[nodiscard]] Eigen::VectorXd undamped(const damped_line_of_frequencies& line, std::vector<std::complex<double>> spectrum) {
  spectrum.resize(line.samples / 2 + 1, 0.0);
  std::vector<double> weighted(line.samples);
  eigen_fft<double>(line.samples).inverse(spectrum.data(), weighted.data());
  Eigen::VectorX<Real> x(static_cast<Eigen::Index>(line.samples));
  for (std::size_t n = 0; n < line.samples; ++n)
    x[static_cast<Eigen::Index>(n)] =
        weighted[n] * line.rate_Hz * std::exp(line.sigma_per_s * static_cast<double>(n) / line.rate_Hz);
  return x;
}

/// A pluck as the others foretell it from its first instants, and what is left.
struct foretold {
  unexplained_part left;
  std::array<Eigen::VectorXd, 2> recorded;
  pluck_scene scene;
  std::array<double, 2> gain{};
  double position = 0.5, strength_N = 0, release_s = 0, begin_s = 0;
  band limits{0, 0};
};

/// Release and strength from what precedes the release and less than half a period behind it, before the string can have swung
/// over, then with the place from what no force on the string changes.
template <class Real = double>
std::optional<foretold> foretell(const pluck_diagnosis& d, const pluck_take& take) {
  constexpr double untouched = 0.45;
  auto seen = see(d.data, d.best, take, untouched, freedom::release_only);
  if (!seen) return std::nullopt;
  seen->stage.periods = std::min(rattling_periods, d.best.horizon_periods);
  const pluck_take& nearest = d.data.takes[seen->nearest];
  const double place = d.best.value[d.data.layout.position(seen->nearest)] + take.position - nearest.position;
  const freedom free = take.position == nearest.position ? freedom::release_only : freedom::release_and_place;
  descend_from_places({seen->data, seen->fit.value, place, free, d.best.quality.noise}, seen->fit);
  seen->stage.free = free;
  const auto problem = seen->problem();
  const Eigen::VectorX<Real>& v = seen->fit.value;
  const pluck_layout& layout = seen->data.layout;
  foretold out;
  out.left = left_by(problem, v, 0);
  out.recorded = problem.part(0, 1).data, out.begin_s = problem.part(0, 1).begin_s;
  out.scene = scene_of(seen->data, seen->fit);
  for (std::size_t c = 0; c < 2; ++c) out.gain[c] = pluck_layout::gain(v, c);
  out.position = v[layout.position(0)], out.strength_N = std::exp(v[layout.at(0, pluck_layout::strength)]),
  out.release_s = layout.release_s(v, 0), out.limits = problem.limits();
  return out;
}

/// Where a stop begins that yields and damps, y = gap + f / stiffness - (resistance / stiffness) dy/dt, by weighted least squares over
/// where it is touched, and what that leaves of y, rms.
template <class Real = double>
[[nodiscard]] std::pair<double, double> stop_of(const Eigen::VectorXd& force_N, const Eigen::VectorXd& rise_m,
                                                const Eigen::VectorXd& weight) {
  std::vector<Eigen::Index> touched;
  for (Eigen::Index i = 1; i + 1 < weight.size(); ++i)
    if (weight[i] > 0.01 * weight.maxCoeff()) touched.push_back(i);
  Eigen::MatrixX<Real> law(static_cast<Eigen::Index>(touched.size()), 3);
  Eigen::VectorX<Real> rise(law.rows());
  for (Eigen::Index k = 0; k < law.rows(); ++k) {
    const Eigen::Index i = touched[static_cast<std::size_t>(k)];
    law.row(k) = std::sqrt(weight[i]) * Eigen::RowVector3d{1, force_N[i], rise_m[i + 1] - rise_m[i - 1]};
    rise[k] = std::sqrt(weight[i]) * rise_m[i];
  }
  if (law.rows() == 0) return {0, 1e300};
  if (law.rows() < 8) law.rightCols(2).setZero();  // too brief to tell a stop that yields from a wall
  const Eigen::VectorX<Real> found = law.completeOrthogonalDecomposition().solve(rise);
  return {found[0], (rise - law * found).norm() / law.col(0).norm()};
}

/// Force and displacement at one place.
struct obstacle_motion {
  Eigen::VectorXd force_N, rise_m;
  std::array<Eigen::VectorXd, 2> at_ends_N;  ///< what the force makes of the recordings
};

template <class = void>
obstacle_motion at_place(const foretold& t, double x, double impedance_Ns_m) {
  const auto& r = t.left.force_N;
  damped_line_of_frequencies line =
      place_search<>::line_over(static_cast<std::size_t>(r[0].size()), t.left.rate_Hz, t.limits.stop_Hz);
  line.first = 0;
  const std::array spectrum{damped_spectrum(line, {r[0].data(), line.samples}),
                            damped_spectrum(line, {r[1].data(), line.samples})};
  std::vector<std::complex<double>> force(line.bins()), rise(line.bins());
  std::array at_ends{force, force};
  const double p = t.position, held_m = t.strength_N * std::min(p, x) * (1 - std::max(p, x)) /
                                        (2 * t.scene.string.fundamental_Hz * impedance_Ns_m);
  for (std::size_t k = 0; k < line.bins(); ++k) {
    const std::complex<double> s = line.at(k), late = std::exp(s * (t.begin_s - t.release_s));
    const string_at string(t.scene, s);
    const loop_response loop = close_loop(t.scene, x, s);
    const Eigen::Vector2cd share = recorded_of(t.scene, t.gain, s, loop.times_determinant[0] / loop.determinant,
                                               loop.times_determinant[1] / loop.determinant);
    force[k] = share.dot(Eigen::Vector2cd{spectrum[0][k], spectrum[1][k]}) /
               share.squaredNorm();  // through the band, like all that is recorded
    for (std::size_t c = 0; c < 2; ++c) at_ends[c][k] = share[static_cast<Eigen::Index>(c)] * force[k];
    const std::complex<double> by_pluck = held_m - t.strength_N * string.mobility(p, x) / (string.sine() * impedance_Ns_m * s);
    rise[k] = (late * by_pluck + string.mobility(x, x) / (string.sine() * impedance_Ns_m) * force[k]) / s;
  }
  return {undamped(line, force), undamped(line, rise), {undamped(line, at_ends[0]), undamped(line, at_ends[1])}};
}
ROSIN_INSTANTIATE(obstacle_motion at_place(const foretold&, double, double))

}  // namespace detail

/// Whether a pluck that contradicts the others met an obstacle. impedance_Ns_m: the string's.
template <class Real = double>
[[nodiscard]] std::optional<rattle> find_rattle(const odd_pluck& odd, double impedance_Ns_m) {
  // twist: where wire and stop hold the surface, it is further aside than the string, whose motion this is, by that share of the gap
  constexpr double least_one_sided = 0.8, most_spread = 0.1, twist = 0.035;
  auto t = detail::foretell(odd.others, odd.take);
  if (!t || !(impedance_Ns_m > 0)) return std::nullopt;
  const auto& noise = odd.others.best.quality.noise;
  const place_search search(t->scene, t->gain, t->limits, t->left, noise);
  rattle out;
  out.place = search();
  if (out.place.on != acting::on_string || !search.is_mismatch() || !search.is_accounted_for(out.place)) return std::nullopt;
  const Eigen::VectorX<Real> moved = search.nuisances(out.place);
  for (std::size_t c = 0; c < 2; ++c)
    for (Eigen::Index k = 0; k < moved.size(); ++k)
      t->left.force_N[c] -= moved[k] * t->left.nuisances[static_cast<std::size_t>(k)][c];
  const detail::obstacle_motion at = detail::at_place(*t, out.place.position, impedance_Ns_m);
  const Eigen::Index used = at.force_N.size() / 2;  // the last of what is undamped is noise
  const Eigen::VectorX<Real> f = at.force_N.head(used), y = at.rise_m.head(used);
  const double up = f.cwiseMax(0).squaredNorm(), down = f.cwiseMin(0).squaredNorm(), side = up > down ? -1 : 1;  // the obstacle's
  const Eigen::VectorX<Real> weight = (-side * f).cwiseMax(0).array().square();
  out.one_sided = std::max(up, down) / (up + down);
  double spread = 0;
  std::tie(out.gap_m, spread) = detail::stop_of(f, y, weight);
  out.gap_sd_m = std::hypot(spread, twist * out.gap_m);
  const Eigen::Index first =
      std::find_if(weight.begin(), weight.end(), [&](double w) { return w > 0.01 * weight.maxCoeff(); }) - weight.begin();
  out.begin_s = t->begin_s, out.first_s = t->begin_s + static_cast<double>(first) / odd.take.rate_Hz;
  double recorded = 0, before = 0, after = 0, noise_power = 0;
  for (std::size_t c = 0; c < 2; ++c) {
    out.before_N[c] = t->left.force_N[c].head(used), out.left_N[c] = out.before_N[c] - at.at_ends_N[c].head(used);
    recorded += t->recorded[c].head(used).squaredNorm(), before += out.before_N[c].squaredNorm(),
        after += out.left_N[c].squaredNorm();
    noise_power += std::pow(noise[c], 2) * static_cast<double>(used) * (t->limits.pass_Hz + t->limits.stop_Hz) / odd.take.rate_Hz;
  }
  out.before = std::sqrt(before / recorded), out.after = std::sqrt(after / recorded),
  out.floor = std::sqrt(noise_power / recorded);
  if (!(out.one_sided > least_one_sided) || !(side * out.gap_m > 0 || std::abs(out.gap_m) < spread) ||
      !(spread < most_spread * y.cwiseAbs().maxCoeff()))
    return std::nullopt;
  return out;
}
ROSIN_INSTANTIATE(std::optional<rattle> find_rattle(const odd_pluck&, double))

namespace detail {

/// The obstacle, if all plucks that contradict the others met one and the same.
template <class = void>
[[nodiscard]] std::optional<rattle> met_by_all(const odd_pluck& odd, double impedance_Ns_m) {
  constexpr double most_apart = 0.01, sure = 3;
  const auto first = find_rattle(odd, impedance_Ns_m);
  const bool alike = first && std::all_of(odd.also.begin(), odd.also.end(), [&](const pluck_take& take) {
                       odd_pluck other = odd;
                       other.take = take;
                       const auto again = find_rattle(other, impedance_Ns_m);
                       return again && std::abs(again->place.position - first->place.position) < most_apart &&
                              std::abs(again->gap_m - first->gap_m) < sure * std::hypot(again->gap_sd_m, first->gap_sd_m);
                     });
  return alike ? first : std::nullopt;
}

/// Fitted ones and those that were set aside, the strongest first.
[[nodiscard]] inline std::vector<pluck_take> by_strength(std::vector<pluck_take> takes, const std::vector<pluck_take>& held) {
  takes.insert(takes.end(), held.begin(), held.end());
  std::stable_sort(takes.begin(), takes.end(),
                   [](const pluck_take& a, const pluck_take& b) { return a.strength_N > b.strength_N; });
  return takes;
}

}  // namespace detail

/// The strongest of three plucks or more and the next ones, or the stronger of two, where they met the same obstacle and the softer ones, diagnosed by
/// themselves, leave nothing unexplained. For what no single odd one (odd_pluck.hpp) accounts for.
template <class = void>
[[nodiscard]] std::optional<odd_pluck> find_rattling_plucks(
    const std::vector<pluck_take>& takes, const std::vector<pluck_take>& held, const pluck_guess& guess,
    const pluck_options& options, const std::function<std::vector<pluck_effect>(const pluck_fit_result&)>& catalogue_for,
    double impedance_Ns_m) {
  constexpr int beside_it = 1;  // effects that the softer ones show
  const std::vector<pluck_take> all = detail::by_strength(takes, held);
  const std::ptrdiff_t least = all.size() == 2 ? 1 : 2;
  for (std::ptrdiff_t strong = least; strong < static_cast<std::ptrdiff_t>(all.size()); ++strong) {
    std::vector<pluck_take> soft(all.begin() + strong, all.end()), kept;
    if (soft.size() > 1) kept.push_back(std::move(soft.back())), soft.pop_back();
    auto others = diagnose_plucks(soft, kept, guess, options, catalogue_for, beside_it);
    if (!others || !others->explained) continue;
    auto odd = detail::against(*std::move(others), all.front(), guess, options);
    if (!odd) continue;
    odd->also.assign(all.begin() + 1, all.begin() + strong);
    if ((odd->met = detail::met_by_all(*odd, impedance_Ns_m))) return odd;
  }
  return std::nullopt;
}
ROSIN_INSTANTIATE(std::optional<odd_pluck> find_rattling_plucks(
    const std::vector<pluck_take>&, const std::vector<pluck_take>&, const pluck_guess&, const pluck_options&,
    const std::function<std::vector<pluck_effect>(const pluck_fit_result&)>&, double))

/// At least two plucks, all of which met the same obstacle: the string is told by what no force at one place changes of the softest.
template <class = void>
[[nodiscard]] std::optional<odd_pluck> find_rattling_string(const std::vector<pluck_take>& takes,
                                                            const std::vector<pluck_take>& held, const pluck_guess& guess,
                                                            const pluck_options& options, double impedance_Ns_m) {
  const std::vector<pluck_take> all = detail::by_strength(takes, held);
  if (all.size() < 2) return std::nullopt;
  const pluck_layout layout({all.back()}, options, guess.ends);
  pluck_diagnosis by{{{all.back()}, guess, options, layout}, {}, {}, {}, {}, {}, {}, {}, false, true, 0, 0, 0, {}};
  auto fit = fit_past_a_force(by.data);
  if (!fit) return std::nullopt;
  by.best = by.base = *std::move(fit);
  by.declared.layout = layout, by.declared.value = by.best.value, by.declared.sd = by.best.sd,
  by.declared.covariance = by.best.covariance, by.declared.noise_N = by.best.quality.noise,
  by.declared.limits = options.limits_for(all.back().rate_Hz, layout.string(by.best.value)),
  by.declared.residual_ratio = by.best.quality.residual_ratio, by.declared.horizon_periods = by.best.horizon_periods;
  auto odd = detail::against(std::move(by), all.front(), guess, options);
  if (!odd) return std::nullopt;
  odd->also.assign(all.begin() + 1, all.end());
  odd->met = detail::met_by_all(*odd, impedance_Ns_m);
  return odd->met ? odd : std::nullopt;
}
ROSIN_INSTANTIATE(std::optional<odd_pluck> find_rattling_string(const std::vector<pluck_take>&, const std::vector<pluck_take>&,
                                                                const pluck_guess&, const pluck_options&, double))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
