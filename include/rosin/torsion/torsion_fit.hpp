// tier: hosted
// SPDX-License-Identifier: MIT
//
// Torsion from what the transducers cannot see of it: while the string sticks, its surface moves with the rod, so that the
// centre's velocity and the torsional velocity under the reconstructed force have to add up to a constant (Woodhouse, Schumacher
// & Garoff (2000), section IV, who chose the three parameters by eye). Here they are fitted to several takes together:
//
//     v_centre(t) + (h_T * f)(t) + (C1 d/dt + C3 d^3/dt^3) f(t) = level      wherever it sticks,
//
// with a level for each take (errors of the scales) and two small terms C1, C3 for what the contact yields besides (what a string
// of finite thickness, or a simulation of finitely many modes, does differently from a point on an ideal one). Sticking is
// found, not given, and found anew as torsion gets clearer. A grid of speeds, on a part of one take and with a cost that
// bears slips, finds where to start; Gauss-Newton steps do the rest, for each convention of damping; the likeliest wins.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/math/reweighted_regression.hpp>
#include <rosin/torsion/stick_data.hpp>
#include <rosin/torsion/torsion_modes.hpp>
#include <rosin/torsion/torsion_response.hpp>

#include <optional>
#include <string>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// The ratios torsional / transverse, and the quality.
struct torsion_values {
  double speed_ratio = 0, impedance_ratio = 0, q = 0;
  [[nodiscard]] Eigen::Vector3d logs() const { return {std::log(speed_ratio), std::log(impedance_ratio), std::log(q)}; }
  [[nodiscard]] static torsion_values from_logs(const Eigen::Vector3d& x) {
    return {std::exp(x[0]), std::exp(x[1]), std::exp(x[2])};
  }
};

/// Surface velocity for 1 N at the contact of a take.
struct torsion_at_contact {
  torsion_waveguide guide;
  torsion_modes modes;
  torsion_damping damping = torsion_damping::constant_q;
  double rest_m_N = 0;  ///< compliance of the modes beyond those that are summed

  torsion_at_contact(const stick_take& take, const torsion_values& v, torsion_damping d)
      : guide{torsion_of(take.delay_s, take.impedance_Ns_m, v.speed_ratio, v.impedance_ratio, v.q)},
        modes{guide.delay_s, guide.impedance_Ns_m, guide.q,
              torsion_modes::seen_below(take.window().edge_Hz, guide.delay_s[0] + guide.delay_s[1])},
        damping{d} {
    guide.causal = modes.causal = is_causal(d);
    if (in_modes(d)) rest_m_N = modes.rest_m_N();
  }
  [[nodiscard]] std::complex<double> operator()(double f) const noexcept {
    if (!in_modes(damping)) return guide(f);
    return modes(f) + std::complex<double>(0, 2 * std::numbers::pi * f * rest_m_N);
  }
  /// How long it rings, to a thousandth.
  [[nodiscard]] double memory_s() const noexcept { return guide.memory_s(1e-3); }
  [[nodiscard]] std::vector<std::complex<double>> on_grid(double step_Hz, std::size_t count) const {
    if (!in_modes(damping)) return guide.on_grid(step_Hz, count);
    auto out = modes.on_grid(step_Hz, count);
    for (std::size_t k = 0; k < count; ++k)
      out[k] += std::complex<double>(0, 2 * std::numbers::pi * step_Hz * static_cast<double>(k) * rest_m_N);
    return out;
  }
};

struct torsion_fit_result {
  torsion_values value{}, sd{};
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the logarithms
  torsion_damping damping = torsion_damping::constant_q;
  std::array<double, 2> rest{};          ///< C1 in m/N, C3 in m s^2/N
  double gain = 0;                       ///< log-likelihood over that of a string that does not turn
  double fluctuation = 0;                ///< of the surface while sticking, relative to the rod's speed
  double sticking = 0;                   ///< share of the samples that were used
  std::vector<std::string> undecided{};  ///< what these takes cannot tell, and why

  [[nodiscard]] bool decided() const noexcept { return undecided.empty(); }
};

namespace detail {

/// What no convention of damping nor C1, C3 absorb, in the logarithms: measured on simulated rigs of two conventions.
inline const Eigen::Vector3d torsion_model_error{0.0007, 0.008, 0.02};

inline void add_to(std::vector<double>& to, const std::vector<double>& what, double factor = 1) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * what[i];
}

/// Where the fit stands; `shared` are the coefficients of the compliance columns.
struct torsion_state {
  torsion_values at{};
  torsion_damping damping = torsion_damping::constant_q;
  Eigen::Vector2d rest = Eigen::Vector2d::Zero();
  stick_solution solution{};
  bool sane = true;
};

/// Log-likelihood of a section of a record with Cauchy's density, slips and all, for a torsional shape whose size is free.
template <class = void>
[[nodiscard]] double cauchy_cost(const std::vector<double>& target, const std::vector<double>& shape,
                                 const std::vector<double>& slope, std::size_t begin, std::size_t end, double speed,
                                 double& size) {
  Eigen::Vector3d value(0, size, 0);
  double cost = 0;
  const auto row = [&](Eigen::Index i) {
    const auto k = static_cast<std::size_t>(i);
    return regression_row<double, 3>{{1, shape[k], slope[k]}, -target[k]};
  };
  for (const double scale : {1.0, 0.5, 0.25, 0.12, 0.12, 0.12}) {
    cost = 2 * reweighted_pass(cauchy_loss<>{}, scale * speed, static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end),
                               row, value);
    value[1] = std::max(value[1], 0.0);
  }
  size = value[1];
  return cost;
}

/// A record of at most so many of another's samples that count, with a little of what was before.
[[nodiscard]] inline stick_take first_part(const stick_record& record, std::size_t samples) {
  stick_take part = record.take();
  const std::size_t begin = record.begin(), from = begin - std::min(begin, static_cast<std::size_t>(0.03 * part.rate_Hz));
  const std::size_t to = std::min(record.size(), begin + samples + record.reach());
  part.force_N = record.known(record.take().force_N).subspan(from, to - from);
  part.velocity_m_s = record.known(record.take().velocity_m_s).subspan(from, to - from);
  part.start_s = static_cast<double>(begin - from) / part.rate_Hz;
  part.approach = part.approach.from(static_cast<double>(record.origin() + from) / part.rate_Hz);
  return part;
}

/// The likeliest starting points, best first. Ratios that strings have hardly been seen to have must be likelier by `rarer`, as
/// what merely yields looks like fast torsion.
template <class = void>
[[nodiscard]] std::vector<torsion_values> torsion_starts(const stick_record& whole, std::size_t wanted) {
  stick_record record(first_part(whole, 12000));
  const std::size_t begin = static_cast<std::size_t>(std::lround(record.take().start_s * record.take().rate_Hz)),
                    end = record.end();
  const auto& slope = record.compliance()[0];
  constexpr double rarer = 200;
  std::vector<std::pair<double, torsion_values>> found;
  const auto attempt = [&](double speed, double q, double more) {
    const auto shape = record.force_through(torsion_at_contact(record.take(), {speed, 3.5, q}, torsion_damping::constant_q));
    double size = 1;
    const double cost = cauchy_cost(record.relative_m_s(), shape, slope, begin, end, std::abs(record.take().rod_speed_m_s), size);
    if (size > 0.05) found.push_back({cost + more, {speed, 3.5 / size, q}});
  };
  for (const double q : {13.0, 35.0})
    for (double speed = 4.2; speed < 11.5; speed *= 1.02) attempt(speed, q, 0);
  for (const auto& [from, to] : {std::pair{2.4, 4.2}, std::pair{11.5, 20.0}})
    for (double speed = from; speed < to; speed *= 1.04) attempt(speed, 13, rarer);
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<torsion_values> starts;
  for (const auto& candidate : found) {
    const torsion_values& v = candidate.second;
    if (starts.size() < wanted && std::none_of(starts.begin(), starts.end(), [&](const auto& s) {
          return std::abs(std::log(s.speed_ratio / v.speed_ratio)) < 0.05;
        }))
      starts.push_back(v);
  }
  return starts;
}

/// One Gauss-Newton step in the logarithms, everything linear solved for along with it. `move` false: evaluated only.
template <class = void>
void torsion_step(std::vector<stick_record>& records, torsion_state& state, bool move, double most = 0.6) {
  std::vector<stick_rows> rows;
  const Eigen::Vector3d here = state.at.logs();
  for (auto& record : records) {
    const torsion_at_contact now(record.take(), state.at, state.damping);
    auto base = record.force_through(now);
    std::vector<std::vector<double>> shared = record.compliance();
    for (int k = 0; move && k < 3; ++k) {
      Eigen::Vector3d aside = here;
      aside[k] += k == 0 ? 1e-4 : 1e-3;
      const torsion_at_contact up(record.take(), torsion_values::from_logs(aside), state.damping);
      shared.push_back(record.force_through(transfer_slope<torsion_at_contact>{up, now, 1 / (aside[k] - here[k])}));
    }
    add_to(base, record.relative_m_s());
    auto surface = base;
    for (Eigen::Index k = 0; k < 2; ++k) add_to(surface, shared[static_cast<std::size_t>(k)], state.rest[k]);
    const auto marked = sticking_samples(record, surface, {.most = most});
    for (auto& column : shared)
      for (double& v : column) v = -v;
    rows.push_back(pick(marked, base, shared, record.rod_columns()));
  }
  double total = 0;
  for (const auto& r : rows) total += static_cast<double>(r.target.size());
  if (total < 200) {
    state.sane = false;
    return;
  }
  state.solution = stick_regression(rows);
  state.rest = state.solution.shared.head(2);
  if (!move) return;
  Eigen::Vector3d step = state.solution.shared.tail(3);
  step = step.cwiseMax(Eigen::Vector3d(-0.03, -0.3, -0.5)).cwiseMin(Eigen::Vector3d(0.03, 0.3, 0.5));
  state.at = torsion_values::from_logs(here + step);
  const auto& v = state.at;
  state.sane =
      v.speed_ratio > 1.5 && v.speed_ratio < 40 && v.impedance_ratio > 0.2 && v.impedance_ratio < 60 && v.q > 1.5 && v.q < 1000;
}

template <class = void>
[[nodiscard]] torsion_state settle(std::vector<stick_record>& records, torsion_state state, int steps) {
  for (int i = 0; i < steps && state.sane; ++i) torsion_step(records, state, true, i < 2 ? 0.6 : 0.4);
  return state;
}

/// Likelihoods are comparable only if all agree on what sticks: mean log density per sample inside the phases of each, less what
/// is lost.
[[nodiscard]] inline double score(const torsion_state& s) {
  return s.sane ? s.solution.rows * std::log(1 / s.solution.scale) : -1e300;
}

[[nodiscard]] inline std::vector<stick_record> records_of(const std::vector<stick_take>& takes) {
  std::vector<stick_record> records;
  for (const auto& t : takes) {
    std::size_t known = 0;
    for (std::size_t i = 0; i < std::min(t.force_N.size(), t.velocity_m_s.size()); ++i)
      known += std::isfinite(t.force_N[i]) && std::isfinite(t.velocity_m_s[i]) ? 1U : 0U;
    if (known >= 500 && t.rod_speed_m_s != 0) records.emplace_back(t);
  }
  return records;
}

template <class = void>
void judge_torsion(const torsion_state& best, const std::vector<stick_record>& records, torsion_fit_result& r) {
  double usable = 0, speed = 0;
  for (const auto& record : records)
    usable += static_cast<double>(record.end() - record.begin()), speed += std::abs(record.take().rod_speed_m_s);
  r.sticking = best.solution.rows / std::max(1.0, usable);
  r.fluctuation = best.solution.scale * static_cast<double>(records.size()) / speed;
  r.covariance = best.solution.covariance.bottomRightCorner(3, 3);
  r.covariance.diagonal() += torsion_model_error.cwiseAbs2();
  const Eigen::Vector3d sd = r.covariance.diagonal().cwiseSqrt();
  r.sd = {r.value.speed_ratio * sd[0], r.value.impedance_ratio * sd[1], r.value.q * sd[2]};
  if (r.sticking < 0.02)
    r.undecided.emplace_back("the string hardly sticks: " + std::to_string(static_cast<long>(best.solution.rows)) +
                             " samples in all");
  if (sd[0] > 0.05)
    r.undecided.emplace_back("speed ratio: the contact lies near a node, or the takes are too noisy or too short");
  if (sd[1] > 0.25) r.undecided.emplace_back("impedance ratio: torsion hardly shows beside the noise");
  if (sd[2] > 0.5) r.undecided.emplace_back("q: the torsional resonance is not resolved");
  if (r.gain < 20) r.undecided.emplace_back("torsion: a string that does not turn explains the takes as well");
}

}  // namespace detail

/// Fits torsion to all takes together. `start`: declared values, tried beside the grid. Fails where nothing sticks.
template <class = void>
[[nodiscard]] outcome<torsion_fit_result> fit_torsion(const std::vector<stick_take>& takes,
                                                      std::optional<torsion_values> start = {}) {
  auto records = detail::records_of(takes);
  if (records.empty()) return failure{"torsion: no bowed take with 500 known samples and a known speed of the rod"};
  auto starts = detail::torsion_starts(records.front(), 3);
  if (start) starts.insert(starts.begin(), *start);
  detail::torsion_state best{.sane = false};
  for (const auto& s : starts) {
    const auto tried = detail::settle(records, {.at = s}, 3);
    if (detail::score(tried) > detail::score(best)) best = tried;
  }
  if (!best.sane) return failure{"torsion: the string does not stick to the rod for long enough anywhere in these takes"};
  auto other = best;
  other.damping = torsion_damping::viscous_modes;
  best = detail::settle(records, best, 3);
  other = detail::settle(records, other, 4);
  if (detail::score(other) > detail::score(best)) best = other;
  for (const auto another : {otherwise_dispersed, otherwise_shared}) {
    if (another == otherwise_shared && !is_causal(best.damping)) break;  // tried already
    other = best;
    other.damping = another(best.damping);
    other = detail::settle(records, other, 3);
    if (detail::score(other) > detail::score(best)) best = other;
  }
  if (!best.sane) return failure{"torsion: the fit ran away: no torsion makes the surface steady while it sticks"};
  torsion_fit_result result{.value = best.at, .damping = best.damping};
  result.rest = {
      best.rest[0] * stick_record::compliance_unit,
      -best.rest[1] * stick_record::compliance_unit / std::pow(2 * std::numbers::pi * stick_record::compliance_corner_Hz, 2)};
  detail::torsion_state rigid = best;
  rigid.at.impedance_ratio = 1e9;
  detail::torsion_step(records, rigid, false);
  result.gain =
      rigid.sane ? best.solution.effective * std::log(rigid.solution.scale / best.solution.scale) : best.solution.effective;
  detail::judge_torsion(best, records, result);
  return result;
}
ROSIN_INSTANTIATE(outcome<torsion_fit_result> fit_torsion(const std::vector<stick_take>&, std::optional<torsion_values>))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
