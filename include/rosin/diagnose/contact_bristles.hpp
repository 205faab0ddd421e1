// tier: hosted
// SPDX-License-Identifier: MIT
//
// Bristles that bend before they give way, and let go bit by bit before the string slips.
// While the string sticks, with eps = velocity of the surface less that of the rod, and f the force,
//
//     eps = -(s / (s0 (1 + s d))) f / (1 - p)
//
// s0 and s0 d their spring and damping, p the part of the motion that is flow (bristle_yield.hpp). Delay and stiffness first as
// if they only bent, then the limit of their flow on a grid, then all again with it. The force is measured: its noise is in the
// column, adds to what is left, and makes bristles look stiffer than they are, by its share of the column's power: where that is
// much, a narrower band is asked for the stiffness.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/contact_stick_effects.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// What contacts are known to yield besides (micrometres a newton, less), and how sure that is.
inline constexpr double other_compliance = 0.7;

/// Bristles' columns of all takes for a delay; `softer`: each take's compliance against the stated one (empty: all alike).
[[nodiscard]] inline std::vector<std::vector<double>> bending_columns(stick_bench& bench, double delay_s,
                                                                      const std::vector<double>& softer) {
  std::vector<std::vector<double>> out;
  for (auto& r : bench.records()) {
    const double own = softer.empty() ? 1.0 : softer[out.size()];
    out.push_back(r.force_through([&](double f) { return own * bristle_bending(f, delay_s); }));
  }
  return out;
}

/// Bristles of a delay and a flow, fitted together with all else that is linear.
struct bending_fit {
  double delay_s = 0, delay_relative_sd = 1, size = 0;  ///< size: compliance, micrometres a newton
  bristle_yield yields{};
  stick_design design{};
  stick_solution solution{};

  [[nodiscard]] double density() const noexcept {
    return solution.log_likelihood * solution.rows / std::max(1.0, solution.effective);
  }
  [[nodiscard]] double share() const noexcept { return solution.effective / std::max(1.0, solution.rows); }
};

/// `size`: about what the compliance is, which flow depends on.
template <class = void>
[[nodiscard]] bending_fit fit_bending(stick_bench& bench, double delay_s, const bristle_yield& yields, double size,
                                      const std::vector<double>& softer) {
  bending_fit out{.delay_s = delay_s, .yields = yields, .design = bench.declared()};
  const auto bends = bending_columns(bench, delay_s, softer);
  for (std::size_t t = 0; t < bends.size(); ++t) out.design.add_shared(t, bench.flowing(t, yields, bends[t], size));
  out.design.bounds[0] = {-other_compliance, -other_compliance}, out.design.bounds[1] = {0, 0};
  out.design.add_bound(0, 1e30);
  stick_prior held;
  out.solution = bounded_regression(out.design, bench.floor_m_s(), held);
  out.size = out.solution.shared[out.solution.shared.size() - 1];
  return out;
}

/// The likeliest delay near `delay_s`, by parabolas through three logarithms of it.
template <class = void>
[[nodiscard]] bending_fit find_delay(stick_bench& bench, double delay_s, const bristle_yield& yields, double size,
                                     const std::vector<double>& softer, double step) {
  constexpr double least_s = 1e-8, most_s = 1e-4;
  const auto at = [&](double delay) { return fit_bending(bench, std::clamp(delay, least_s, most_s), yields, size, softer); };
  bending_fit middle = at(delay_s), low = at(delay_s * std::exp(-step)), high = at(delay_s * std::exp(step));
  for (int moves = 0; moves < 6 && std::max(low.density(), high.density()) > middle.density(); ++moves) {
    if (low.density() > high.density())
      high = std::move(middle), middle = std::move(low), low = at(middle.delay_s * std::exp(-step));
    else low = std::move(middle), middle = std::move(high), high = at(middle.delay_s * std::exp(step));
  }
  const double bend = 2 * middle.density() - low.density() - high.density();
  if (!(bend > 0)) return middle;
  bending_fit best = at(middle.delay_s * std::exp(0.5 * step * std::clamp((high.density() - low.density()) / bend, -1.0, 1.0)));
  if (!(best.density() > middle.density())) best = std::move(middle);
  best.delay_relative_sd = std::min(1.0, step / std::sqrt(best.share() * bend));
  return best;
}

/// Where to begin: the delay by the measure of `quick`; size 0: nothing bends.
template <class = void>
[[nodiscard]] bending_fit start_bending(stick_bench& bench, const explained& quick, const std::vector<double>& softer) {
  bending_fit out;
  double best = 0;
  for (double delay = 1.25e-7; delay < 5e-5; delay *= 2) {
    double size = 0;
    const double gain = quick.by(bending_columns(bench, delay, softer), size);
    if (size > 0 && gain > best) best = gain, out.delay_s = delay, out.size = size;
  }
  return out;
}

/// The flow that explains most, for bristles of a compliance that bend as `bends` says.
template <class = void>
[[nodiscard]] bristle_yield find_yield(stick_bench& bench, const explained& quick, const std::vector<std::vector<double>>& bends,
                                       double compliance) {
  double best = 0;
  bristle_yield out;
  const auto attempt = [&](const bristle_yield& y) {
    std::vector<std::vector<double>> columns;
    for (std::size_t t = 0; t < bends.size(); ++t) columns.push_back(bench.flowing(t, y, bends[t], compliance));
    double size = 0;
    if (const double gain = quick.by(columns, size); size > 0 && gain > best) best = gain, out = y;
  };
  for (const double weakening : {0.0, 4.0, 16.0})
    for (const double elastic : {bristle_yield::at_once, 0.1, 0.4, 0.7})
      for (double limit = 0.2; limit < 3; limit *= 1.2) attempt({limit, elastic, weakening});
  for (double step = 0.1; step > 4e-3; step /= 2)
    for (int round = 0; round < 2; ++round)
      for (const double way : {-1.0, 1.0}) {
        attempt({out.limit * (1 + way * step), out.elastic, out.weakening_s_m});
        attempt({out.limit, out.elastic, std::max(0.0, out.weakening_s_m + way * 40 * step)});
        if (out.elastic >= 0) attempt({out.limit, std::clamp(out.elastic + way * step, 0.0, 0.9), out.weakening_s_m});
      }
  return out;
}

/// Noise's share in the power of the bristles' column, beyond what the other columns explain of that; and its rms in the
/// equation.
struct bending_noise {
  double share = 0, rms_m_s = 0;
};
template <class Real = double>
[[nodiscard]] bending_noise noise_of(const stick_bench& bench, const bending_fit& fit, const std::vector<double>& softer) {
  const stacked s = stack(fit.design.rows);
  const Eigen::Index at = fit.design.rows.front().shared.cols() - 1;
  const Eigen::VectorX<Real> column = s.x.col(at);
  Eigen::MatrixX<Real> others = s.x;
  others.leftCols(2).setZero();
  others.col(at).setZero();
  const Eigen::MatrixX<Real> square = others.transpose() * others;
  const Eigen::VectorX<Real> along = others.transpose() * column;
  const double loose = 1e-9 * std::max(1e-300, square.diagonal().maxCoeff());
  const double left =
      column.squaredNorm() -
      along.dot((square + loose * Eigen::MatrixX<Real>::Identity(square.rows(), square.cols())).ldlt().solve(along));
  double noise = 0;
  for (std::size_t t = 0; t < fit.design.rows.size(); ++t) {
    const double own = fit.size * (softer.empty() ? 1.0 : softer[t]);
    noise += static_cast<double>(fit.design.rows[t].target.size()) *
             std::pow(bench.noise_through(t, [&](double f) { return own * bristle_bending(f, fit.delay_s); }), 2);
  }
  return {left > 0 ? std::min(1.0, noise / (left * fit.size * fit.size)) : 1.0,
          std::sqrt(noise / static_cast<double>(s.y.size()))};
}
ROSIN_INSTANTIATE(bending_noise noise_of(const stick_bench&, const bending_fit&, const std::vector<double>&))

/// The hypothesis, and how much of what it rests on is noise.
struct bristle_estimate {
  contact_hypothesis hypothesis;
  double noise_share = 0;
};

template <class = void>
[[nodiscard]] bristle_estimate estimate_bristles(stick_bench& bench, const std::vector<double>& softer) {
  constexpr double clearly = 10;  // nats by which flow has to be likelier than none
  contact_hypothesis h{.effect = "elasto-plastic-friction"};
  h.free_parameters = 2;
  // What bristles yield is to first order what the declared equation's own compliance terms are: the search goes without these.
  stick_design bare = bench.declared();
  for (auto& rows : bare.rows) {
    rows.target += other_compliance * rows.shared.col(0);
    rows.shared.leftCols(2).setZero();
  }
  stick_prior held;
  const explained quick(bare, bounded_regression(bare, bench.floor_m_s(), held));
  const auto start = start_bending(bench, quick, softer);
  if (!(start.size > 0)) return {nothing(bench, h)};
  auto found = find_delay(bench, start.delay_s, {}, start.size, softer, 0.35);
  for (int round = 0; round < 2 && found.size > 0; ++round) {
    const auto bends = bending_columns(bench, found.delay_s, softer);
    const explained nearer(bare, found.solution.residual, found.solution.scale);
    auto flowing = find_delay(bench, found.delay_s, find_yield(bench, nearer, bends, found.size), found.size, softer, 0.2);
    if (!(flowing.size > 0 && flowing.share() * (flowing.density() - found.density()) > clearly)) break;
    found = std::move(flowing);
  }
  if (!(found.size > 0)) return {nothing(bench, h)};
  settle_hypothesis(bench, fit_design(found.design, bench.floor_m_s()), h);
  const auto noise = noise_of(bench, found, softer);
  h.noise = std::hypot(bench.doubt_m_s(), noise.rms_m_s) / bench.speed_m_s();
  const double stiffness = 1e6 / found.size,
               last = found.solution.covariance(found.solution.covariance.rows() - 1, found.solution.covariance.cols() - 1);
  const double doubt = std::hypot(std::sqrt(std::max(0.0, last)), other_compliance, 0.3 * noise.share * found.size);
  h.parameters = {
      {"bristle_stiffness_N_m", stiffness, stiffness * std::hypot(stiffness * 1e-6 * doubt, contact_faults::bristles)},
      {"bristle_delay_s", found.delay_s, found.delay_s * found.delay_relative_sd}};
  const bristle_yield& yields = found.yields;
  if (yields.limit > 0)
    h.free_parameters += 2, h.parameters.push_back({"friction_limit", yields.limit, 0.1 * yields.limit}),
        h.parameters.push_back({"weakening_s_m", yields.weakening_s_m, 2});
  if (yields.limit > 0 && yields.elastic >= 0)
    h.free_parameters += 1, h.parameters.push_back({"elastic_share", yields.elastic, 0.1});
  h.decided = found.size > 3 * doubt;
  return {h, noise.share};
}

}  // namespace detail

/// The contact yields elastically before it slides. `softer`: each take's compliance against the stated one, where stiffness goes
/// with the normal force (empty: all alike).
template <class = void>
[[nodiscard]] contact_hypothesis bristle_hypothesis(stick_bench& bench, const std::vector<double>& softer = {}) {
  return detail::estimate_bristles(bench, softer).hypothesis;
}

/// The same; where noise takes much of it, the parameters are those of narrower bands: noise bends bristles most at high
/// frequencies.
template <class = void>
[[nodiscard]] contact_hypothesis bristle_hypothesis(stick_bench& bench, std::vector<contact_take> takes) {
  constexpr double much = 0.1, clearly_less = 0.8;
  auto found = detail::estimate_bristles(bench, {});
  while (found.hypothesis.decided && found.noise_share > much) {
    for (auto& t : takes) t.edge_Hz = 0.5 * (t.edge_Hz > 0 ? t.edge_Hz : 0.45 * t.rate_Hz);
    stick_bench narrow(takes, bench.model());
    if (!narrow.usable()) break;
    narrow.use_damping(bench.damping());
    const auto next = detail::estimate_bristles(narrow, {});
    if (!next.hypothesis.decided || next.noise_share > clearly_less * found.noise_share) break;
    found.hypothesis.parameters = next.hypothesis.parameters, found.hypothesis.edge_Hz = takes.front().edge_Hz,
    found.noise_share = next.noise_share;
  }
  return found.hypothesis;
}
ROSIN_INSTANTIATE(contact_hypothesis bristle_hypothesis(stick_bench&, std::vector<contact_take>))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
