// tier: hosted
// SPDX-License-Identifier: MIT
//
// A contact of some width w holds the string at two places, not at one. Each end of the string then tells of the place that is
// nearer to it, and a reconstruction of one point between them finds its two versions at odds (specification sheet, 6.1, item 30).
// With a width assumed the two places follow exactly from the two ends' forces, F_1 and F_2, by what waves do between them:
//
//     v_a = F_1 sinh(g a) / Z_w,   v_b = F_2 sinh(g b) / Z_w,   f_a +- f_b = F_1 cosh(g a) +- F_2 cosh(g b) + Z_w (v_a +- v_b) tanh(g d)^(+-1)
//
// with a = tau_1 - d, b = tau_2 - d, d = w / (2 c). While they stick, both move with the rod, torsion included. The width
// is the one that makes that so at both places; w = 0, the declared contact, is what it is measured against.
//
#pragma once

#include <rosin/diagnose/contact_stick.hpp>
#include <rosin/propagate/dispersion.hpp>

namespace rosin {

/// Both places of a wide contact, smoothed.
struct wide_motion {
  std::vector<double> near_m_s, far_m_s;        ///< surface velocities less the rod's
  std::array<std::vector<double>, 2> compliance;  ///< columns as in stick_record
};

/// A take's terminations, transformed once.
class wide_record {
  using complex = std::complex<double>;

public:
  wide_record(const contact_take& take, const stick_record& record)
      : take_{take}, near_{record.known(take.near_N), take.rate_Hz}, far_{record.known(take.far_N), take.rate_Hz} {}

  [[nodiscard]] wide_motion at(double half_delay_s, const smooth_window& window, const torsion_waveguide& torsion) {
    wide_motion m;
    std::array<std::vector<double>*, 4> to{&m.near_m_s, &m.far_m_s, &m.compliance[0], &m.compliance[1]};
    std::vector<std::array<complex, 8>> table;
    for (std::size_t k = 0; static_cast<double>(k) * near_.bin_Hz() < window.edge_Hz; ++k) table.push_back(passage(static_cast<double>(k) * near_.bin_Hz(), half_delay_s, torsion));
    for (const std::size_t side : {0U, 1U})
      for (std::size_t row = 0; row < 4; ++row) {
        const auto part = (side == 0 ? near_ : far_).through(window, [&](double f) { return table[static_cast<std::size_t>(std::lround(f / near_.bin_Hz()))][2 * row + side]; });
        to[row]->resize(part.size(), 0.0);
        detail::add_to(*to[row], part);
      }
    for (auto* v : {&m.near_m_s, &m.far_m_s})
      for (double& x : *v) x -= take_.rod_speed_m_s;
    return m;
  }

  static constexpr double pole_width = 0.1;  ///< where the piece between both places is a quarter wave long, their sum is all noise

private:

  /// Rolling at one place under a newton at the same (`across` false) or at the other; `first`, `rest`: delays to the ends.
  [[nodiscard]] static complex rolling(const torsion_waveguide& t, double w, double first, double rest, double between, bool across) {
    const complex g(0.5 * w / t.q, w);
    return std::sinh(g * first) * std::sinh(g * (across ? rest : rest + between)) / std::sinh(g * (first + rest + between)) / t.impedance_Ns_m;
  }

  /// Rows: surface at a, surface at b, two columns of compliance; columns: F_1, F_2.
  [[nodiscard]] std::array<complex, 8> passage(double f, double d, const torsion_waveguide& torsion) const {
    if (f == 0) return {};
    const double w = 2 * std::numbers::pi * f, eps = take_.stiffness_s2, Z = take_.impedance_Ns_m * wave_impedance_ratio(w, eps);
    const complex g(0.5 * w * take_.inverse_q * slowness_ratio(w, eps), phase_rate(w, eps));
    const complex near_field(0, -near_field_ratio(w, eps) / (2 * Z * force_factor(w, eps)));
    const double a = take_.delay_s[0] - d, b = take_.delay_s[1] - d, faster = take_.delay_s[0] / torsion.delay_s[0];
    const complex cosh_d = std::cosh(g * d), sinh_d = std::sinh(g * d), tanh_d = sinh_d * std::conj(cosh_d) / (std::norm(cosh_d) + pole_width * pole_width);
    const complex haa = rolling(torsion, w, a / faster, b / faster, 2 * d / faster, false), hbb = rolling(torsion, w, b / faster, a / faster, 2 * d / faster, false);
    const complex hab = rolling(torsion, w, a / faster, b / faster, 2 * d / faster, true);
    std::array<complex, 8> out;
    for (const std::size_t side : {0U, 1U}) {
      const double own = side == 0 ? a : b, sign = side == 0 ? 1 : -1;
      const complex v = std::sinh(g * own) / Z, c = std::cosh(g * own), sum = c + tanh_d * Z * v;
      const complex difference = d > 0 ? sign * (c + Z * v * cosh_d * std::conj(sinh_d) / (std::norm(sinh_d) + 1e-12)) : complex(0);
      const complex fa = 0.5 * (sum + difference), fb = 0.5 * (sum - difference);
      out[side] = (side == 0 ? v : complex(0)) + (haa + near_field) * fa + hab * fb;
      out[2 + side] = (side == 1 ? v : complex(0)) + (hbb + near_field) * fb + hab * fa;
      out[4 + side] = sum * complex(0, w * stick_record::compliance_unit);
      out[6 + side] = out[4 + side] * std::pow(f / stick_record::compliance_corner_Hz, 2);
    }
    return out;
  }

  contact_take take_;
  contact_signal<> near_, far_;
};

namespace detail {

/// Cost of a width with slips and all: Cauchy's density at both places, compliance free.
[[nodiscard]] inline double width_cost(const wide_motion& m, const stick_record& record) {
  double cost = 0;
  std::vector<double> flat(m.near_m_s.size(), 0.0);
  for (const auto* v : {&m.near_m_s, &m.far_m_s}) {
    double size = 0;
    cost += cauchy_cost(*v, flat, m.compliance[0], record.begin(), record.end(), std::abs(record.take().rod_speed_m_s), size);
  }
  return cost;
}

/// Rows of the stick equation at both places; the same samples for every width.
[[nodiscard]] inline stick_design width_design(const std::vector<wide_motion>& motions, const std::vector<std::vector<char>>& marked) {
  stick_design d;
  for (std::size_t t = 0; t < motions.size(); ++t)
    for (const auto* v : {&motions[t].near_m_s, &motions[t].far_m_s}) {
      auto shared = std::vector<std::vector<double>>(motions[t].compliance.begin(), motions[t].compliance.end());
      for (auto& column : shared)
        for (double& x : column) x = -x;
      d.rows.push_back(pick(marked[t], *v, shared, {std::vector<double>(v->size(), 1.0)}));
    }
  for (int k = 0; k < 2; ++k) d.add_bound(-30, 30);
  return d;
}

}  // namespace detail

/// Nothing where the terminations' forces are not given, or both versions agree so well that there is no width to see.
[[nodiscard]] inline std::optional<contact_hypothesis> width_hypothesis(stick_bench& bench, const std::vector<contact_take>& takes) {
  const auto torsion = bench.model().torsion ? bench.model().torsion : bench.free_torsion() ? std::optional(bench.free_torsion()->value) : std::nullopt;
  if (bench.records().empty() || !torsion || bench.floor_m_s() < 0.01 * bench.speed_m_s()) return std::nullopt;
  for (const auto& t : takes)
    if (t.near_N.size() != t.force_N.size() || t.far_N.size() != t.force_N.size()) return std::nullopt;
  auto& records = bench.records();
  std::vector<wide_record> wide;
  std::vector<torsion_waveguide> rolling;
  for (std::size_t t = 0; t < takes.size(); ++t) {
    wide.emplace_back(takes[t], records[t]);
    rolling.push_back(torsion_of(takes[t].delay_s, takes[t].impedance_Ns_m, torsion->speed_ratio, torsion->impedance_ratio, torsion->q));
  }
  const auto cost = [&](double d) { return detail::width_cost(wide[0].at(d, records[0].window(), rolling[0]), records[0]); };
  const double most = std::min(2e-5, 0.2 * std::min(takes[0].delay_s[0], takes[0].delay_s[1]));
  double best = 0, least = cost(0);
  for (double d = 2.5e-7; d < most; d += std::max(2.5e-7, 0.08 * d))
    if (const double c = cost(d); c < least) least = c, best = d;
  if (!(best > 0)) return std::nullopt;
  for (double step = 0.04; step > 2e-3; step /= 2)
    for (const double d : {best * (1 - step), best * (1 + step)})
      if (const double c = cost(d); c < least) least = c, best = d;
  std::vector<wide_motion> with, without;
  std::vector<std::vector<char>> marked;
  for (std::size_t t = 0; t < takes.size(); ++t) {
    with.push_back(wide[t].at(best, records[t].window(), rolling[t]));
    without.push_back(wide[t].at(0, records[t].window(), rolling[t]));
    auto both = sticking_samples(records[t], with.back().near_m_s, {.least = 0.1, .most = 0.5});
    const auto far = sticking_samples(records[t], with.back().far_m_s, {.least = 0.1, .most = 0.5});
    for (std::size_t i = 0; i < both.size(); ++i) both[i] = both[i] && far[i] ? 1 : 0;
    marked.push_back(std::move(both));
  }
  const auto design = detail::width_design(with, marked);
  double rows = 0;
  for (const auto& r : design.rows) rows += static_cast<double>(r.target.size());
  if (rows < 400) return std::nullopt;
  const double floor = 1e-3 * bench.speed_m_s();
  const auto wide_fit = fit_design(design, floor), point_fit = fit_design(detail::width_design(without, marked), floor);
  contact_hypothesis h{.effect = "finite-contact-width"};
  h.free_parameters = 1;
  h.statistic = "stick-fluctuation at both places";
  h.share = wide_fit.share;
  h.density = wide_fit.density - point_fit.density;
  h.held_out_density = wide_fit.held_out - point_fit.held_out;
  h.gain = h.share * h.density;
  h.held_out_gain = h.share * h.held_out_density;
  h.fluctuation = wide_fit.solution.scale / bench.speed_m_s();
  const double one_way = takes[0].delay_s[0] + takes[0].delay_s[1], metres = takes[0].length_m > 0 ? takes[0].length_m / one_way : 0;
  const double doubt = 0.02 + 2e-7 / best;  // of what rolling and near field do between the two places
  h.parameters = {{metres > 0 ? "width_m" : "width_s", 2 * best * (metres > 0 ? metres : 1.0), 2 * best * doubt * (metres > 0 ? metres : 1.0)}};
  h.decided = best > 5e-7 && wide_fit.solution.scale < 0.7 * point_fit.solution.scale && h.fluctuation < 0.07;  // both really stick
  return h;
}

}  // namespace rosin
