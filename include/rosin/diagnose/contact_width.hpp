// tier: hosted
// SPDX-License-Identifier: MIT
//
// Whether the contact has some width. Each end of the string then tells of the place that is nearer to it, and a reconstruction
// of one point between them finds its two versions at odds. While they stick, both places (wide_record.hpp) move with the rod,
// torsion included. The width is the one that makes that so at both, with torsion free as far as it may be off; w = 0, the
// declared contact, is what it is measured against.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/wide_record.hpp>
#include <rosin/math/reweighted_regression.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

namespace detail {

/// How many samples do not stick, softly: sum of r^2 / (r^2 + s^2) (Geman and McClure 1985), s a twentieth of the rod's speed, with
/// an offset and a compliance free, found from far (with Cauchy's weights) to near. A slip counts no more for being fast: where
/// parts of a bow slide on while others hold, a loss that grows with r, be it as slowly as Cauchy's, would rather have the slips
/// slow than the places still.
template <class = void>
[[nodiscard]] double loose_samples(const std::vector<double>& relative_m_s, const std::vector<double>& compliance,
                                   std::size_t begin, std::size_t end, double speed_m_s) {
  Eigen::Vector2d value(0, 0);
  double loose = 0;
  const auto row = [&](Eigen::Index i) {
    const auto k = static_cast<std::size_t>(i);
    return regression_row<double, 2>{{1, compliance[k]}, -relative_m_s[k]};
  };
  const auto pass = [&](const auto& loss, double scale) {
    return reweighted_pass(loss, scale * speed_m_s, static_cast<Eigen::Index>(begin), static_cast<Eigen::Index>(end), row, value);
  };
  for (const double scale : {1.0, 0.5, 0.25}) pass(cauchy_loss<>{}, scale);
  for (const double scale : {0.12, 0.12, 0.06, 0.05, 0.05, 0.05}) loose = 2 * pass(geman_mcclure_loss<>{}, scale);
  return loose;
}

/// Of both places.
template <class = void>
[[nodiscard]] double width_cost(const wide_motion& m, const stick_record& record) {
  double cost = 0;
  for (const auto* v : {&m.near_m_s, &m.far_m_s})
    cost += loose_samples(*v, m.compliance[0], record.begin(), record.end(), std::abs(record.take().rod_speed_m_s));
  return cost;
}

/// The half delay that costs least in one take; 0: no width costs less than none.
template <class = void>
[[nodiscard]] double search_width(wide_record& wide, const stick_record& record, const torsion_values& torsion) {
  const auto& delay = record.take().delay_s;
  const auto cost = [&](double d) {
    return width_cost(wide.at(d, record.window(), torsion, torsion_damping::constant_q, 1), record);
  };
  const double most = std::min(2e-5, 0.2 * std::min(delay[0], delay[1]));
  double best = 0, least = cost(0);
  for (double d = 2.5e-7; d < most; d += std::max(2.5e-7, 0.08 * d))
    if (const double c = cost(d); c < least) least = c, best = d;
  for (double step = 0.04; best > 0 && step > 2e-3; step /= 2)
    for (const double d : {best * (1 - step), best * (1 + step)})
      if (const double c = cost(d); c < least) least = c, best = d;
  return best;
}

/// Samples at which both places stick, of each take.
[[nodiscard]] inline std::vector<std::vector<char>> sticking_at_both(const std::vector<stick_record>& records,
                                                                     std::vector<wide_record>& wide, double half_delay_s,
                                                                     double below, const torsion_values& torsion) {
  std::vector<std::vector<char>> marked;
  for (std::size_t t = 0; t < records.size(); ++t) {
    const smooth_window window = wide_record::below_pole(records[t].window(), below);
    const wide_motion motion = wide[t].at(half_delay_s, window, torsion, torsion_damping::constant_q, 0);
    auto both = sticking_samples(records[t], motion.near_m_s, {.least = 0.1, .most = 0.5}, window);
    const auto far = sticking_samples(records[t], motion.far_m_s, {.least = 0.1, .most = 0.5}, window);
    for (std::size_t i = 0; i < both.size(); ++i) both[i] = both[i] && far[i] ? 1 : 0;
    marked.push_back(std::move(both));
  }
  return marked;
}
[[nodiscard]] inline bool enough(const std::vector<std::vector<char>>& marked) {
  std::ptrdiff_t rows = 0;
  for (const auto& m : marked) rows += std::count(m.begin(), m.end(), 1);
  return rows >= 400;
}

/// What is assumed of a contact of some width.
struct width_model {
  double half_delay_s = 0;
  torsion_values torsion{};
  torsion_damping damping = torsion_damping::constant_q;
  double below = 0;  ///< the half delay whose pole ends the band
};

/// The stick equation at both places, of all takes, on the samples that are marked. Shared columns: compliance, the slopes of
/// torsion's three logarithms, and of the width's where there is one.
template <class = void>
[[nodiscard]] stick_design width_design(stick_bench& bench, std::vector<wide_record>& wide,
                                        const std::vector<std::vector<char>>& marked, const width_model& m) {
  stick_design d;
  for (std::size_t t = 0; t < wide.size(); ++t) {
    const smooth_window window = wide_record::below_pole(bench.records()[t].window(), m.below);
    const wide_motion here = wide[t].at(m.half_delay_s, window, m.torsion, m.damping);
    std::array<std::vector<std::vector<double>>, 2> shared{std::vector(here.compliance.begin(), here.compliance.end()),
                                                           std::vector(here.compliance.begin(), here.compliance.end())};
    const auto add_slope = [&](const width_model& up, const width_model& down, double step) {
      const wide_motion high = wide[t].at(up.half_delay_s, window, up.torsion, up.damping, 0),
                        low = wide[t].at(down.half_delay_s, window, down.torsion, down.damping, 0);
      for (const std::size_t place : {0U, 1U}) {
        auto slope = place == 0 ? high.near_m_s : high.far_m_s;
        add_to(slope, place == 0 ? low.near_m_s : low.far_m_s, -1);
        for (double& x : slope) x /= 2 * step;
        shared[place].push_back(std::move(slope));
      }
    };
    for (int k = 0; k < 3; ++k) {
      width_model up = m, down = m;
      const double step = k == 0 ? 2e-4 : 2e-3;
      Eigen::Vector3d high = m.torsion.logs(), low = high;
      high[k] += step, low[k] -= step;
      up.torsion = torsion_values::from_logs(high), down.torsion = torsion_values::from_logs(low);
      add_slope(up, down, step);
    }
    if (m.half_delay_s > 0) {
      width_model up = m, down = m;
      up.half_delay_s *= 1.01, down.half_delay_s /= 1.01;
      add_slope(up, down, 0.01);
    }
    for (const std::size_t place : {0U, 1U}) {
      for (auto& column : shared[place])
        for (double& x : column) x = -x;
      const auto& target = place == 0 ? here.near_m_s : here.far_m_s;
      d.rows.push_back(pick(marked[t], target, shared[place], bench.records()[t].rod_columns()));
    }
  }
  for (int k = 0; k < 2; ++k) d.add_bound(-30, 30);
  for (int k = 0; k < 3; ++k)
    d.add_bound(bench.model().torsion ? -2 * bench.model().torsion_tolerance[k] : -1.0,
                bench.model().torsion ? 2 * bench.model().torsion_tolerance[k] : 1.0);
  if (m.half_delay_s > 0) d.add_bound(-0.2, 0.2);
  return d;
}

struct settled_width {
  width_model model;
  stick_design design;
  design_fit fit;
};

/// The width settled by Gauss-Newton steps, and torsion with it where that is not declared, with whichever convention of torsional
/// damping leaves less.
template <class = void>
[[nodiscard]] settled_width settle_width(stick_bench& bench, std::vector<wide_record>& wide,
                                         const std::vector<std::vector<char>>& marked, double floor, width_model m) {
  const auto settled = [&](torsion_damping damping) {
    settled_width out{m, {}, {}};
    out.model.damping = damping;
    stick_prior held;
    for (int step = 0; step < 2 && m.half_delay_s > 0; ++step) {
      const auto shared = bounded_regression(width_design(bench, wide, marked, out.model), floor, held).shared;
      out.model.half_delay_s *= std::exp(shared[5]);
      if (bench.model().torsion) continue;
      const Eigen::Vector3d turned = shared.segment<3>(2).cwiseMax(-0.1).cwiseMin(0.1);
      out.model.torsion = torsion_values::from_logs(out.model.torsion.logs() + turned);
    }
    out.design = width_design(bench, wide, marked, out.model);
    out.fit = fit_design(out.design, floor);
    return out;
  };
  auto best = settled(torsion_damping::constant_q);
  for (const auto other : {otherwise_shared, otherwise_dispersed})
    if (auto tried = settled(other(best.model.damping)); tried.fit.density > best.fit.density) best = std::move(tried);
  return best;
}

struct sought_width {
  double searched = 0, below = 0;  ///< half delays: found by search; whose pole ends the band
  std::vector<std::vector<char>> marked;
  settled_width settled;
};

/// Sought, then settled. What torsion seems to be depends on the width, and the other way round: where it is not declared, in turn.
template <class = void>
[[nodiscard]] std::optional<sought_width> seek_width(stick_bench& bench, std::vector<wide_record>& wide, double floor,
                                                     torsion_values torsion) {
  std::optional<sought_width> out;
  for (int round = 0; round < (bench.model().torsion ? 1 : 3); ++round) {
    const double searched = search_width(wide[0], bench.records()[0], torsion);
    if (!(searched > 0)) break;
    sought_width now{searched, searched, sticking_at_both(bench.records(), wide, searched, searched, torsion), {}};
    if (!enough(now.marked))  // too little sticks for as long as such a band smears
      now.below = 0, now.marked = sticking_at_both(bench.records(), wide, searched, 0, torsion);
    if (!enough(now.marked)) break;
    now.settled =
        settle_width(bench, wide, now.marked, floor, {.half_delay_s = searched, .torsion = torsion, .below = now.below});
    torsion = now.settled.model.torsion;
    out = std::move(now);
  }
  return out;
}

}  // namespace detail

/// Nothing where the terminations' forces are not given, or both versions agree so well that there is no width to see.
template <class = void>
[[nodiscard]] std::optional<contact_hypothesis> width_hypothesis(stick_bench& bench, const std::vector<contact_take>& takes) {
  const auto torsion = bench.model().torsion  ? bench.model().torsion
                       : bench.free_torsion() ? std::optional(bench.free_torsion()->value)
                                              : std::nullopt;
  if (bench.records().empty() || !torsion || bench.floor_m_s() < 0.01 * bench.speed_m_s()) return std::nullopt;
  for (const auto& t : takes)
    if (t.near_N.size() != t.force_N.size() || t.far_N.size() != t.force_N.size()) return std::nullopt;
  auto& records = bench.records();
  std::vector<wide_record> wide;
  for (std::size_t t = 0; t < takes.size(); ++t) wide.emplace_back(takes[t], records[t]);
  const double floor = 1e-3 * bench.speed_m_s();
  const auto sought = detail::seek_width(bench, wide, floor, *torsion);
  if (!sought) return std::nullopt;
  const auto& [searched, below, marked, found] = *sought;
  const auto point = detail::settle_width(bench, wide, marked, floor, {.torsion = *torsion, .below = below});
  const auto &wide_fit = found.fit, &point_fit = point.fit;
  const double best = found.model.half_delay_s;
  contact_hypothesis h{.effect = "finite-contact-width"};
  h.free_parameters = 1;
  h.statistic = "stick-fluctuation at both places";
  h.share = wide_fit.share;
  h.density = wide_fit.density - point_fit.density;
  h.held_out_density = wide_fit.held_out - point_fit.held_out;
  h.gain = h.share * h.density;
  h.held_out_gain = h.share * h.held_out_density;
  h.fluctuation = wide_fit.solution.scale / bench.speed_m_s();
  for (std::size_t t = 0; t < takes.size(); ++t)
    h.noise = std::max(h.noise, wide[t].noise_m_s(best, wide_record::below_pole(records[t].window(), below), found.model.torsion,
                                                  found.model.damping) /
                                    bench.speed_m_s());
  for (std::size_t t = 0; t < takes.size(); ++t) {  // the place that is nearer to the near end stands for both
    h.before.push_back(
        detail::sticking_trace(bench, found.design.rows[2 * t], point_fit.solution.residual[2 * t], t, takes[t].name));
    h.after.push_back(
        detail::sticking_trace(bench, found.design.rows[2 * t], wide_fit.solution.residual[2 * t], t, takes[t].name));
  }
  const double one_way = takes[0].delay_s[0] + takes[0].delay_s[1],
               metres = takes[0].length_m > 0 ? takes[0].length_m / one_way : 0;
  // Of what rolling and near field do between the two places; and of a contact whose parts do not all hold at once, of which
  // those samples that hold together tell more or less.
  const double doubt = std::hypot(0.02 + 2e-7 / best, std::log(best / searched));
  h.parameters = {{metres > 0 ? "width_m" : "width_s", 2 * best * (metres > 0 ? metres : 1.0),
                   2 * best * doubt * (metres > 0 ? metres : 1.0)}};
  h.width_s = 2 * best;
  // both really stick
  h.decided = best > 5e-7 && wide_fit.solution.scale < 0.7 * point_fit.solution.scale && h.fluctuation < 0.07;
  return h;
}
ROSIN_INSTANTIATE(std::optional<contact_hypothesis> width_hypothesis(stick_bench&, const std::vector<contact_take>&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
