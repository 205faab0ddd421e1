// tier: hosted
// SPDX-License-Identifier: MIT
//
// A contact of some width w holds the string at two places, not at one. Each end of the string then tells of the place that is
// nearer to it, and a reconstruction of one point between them finds its two versions at odds (specification sheet, 6.1, item 30).
// With a width assumed the two places follow exactly from the two ends' forces, F_1 and F_2, by what waves do between them:
//
//     v_a = F_1 sinh(g a) / Z_w,   v_b = F_2 sinh(g b) / Z_w,   f_a + f_b = F_1 cosh(g a) + F_2 cosh(g b) + Z_w (v_a + v_b) tanh(g d)
//
// with a = tau_1 - d, b = tau_2 - d, d = w / (2 c). While they stick, both move with the rod, torsion included. The width
// is the one that makes that so at both places; w = 0, the declared contact, is what it is measured against.
//
#pragma once

#include <rosin/diagnose/contact_stick.hpp>
#include <rosin/propagate/dispersion.hpp>

namespace rosin {

/// Both places of a wide contact, smoothed, less the rod's speed, with and without rolling.
struct wide_motion {
  std::vector<double> near_m_s, far_m_s;        ///< surface velocities less the rod's
  std::array<std::vector<double>, 2> compliance;  ///< columns as in stick_record
};

/// A take's terminations, transformed once.
class wide_record {
public:
  wide_record(const contact_take& take, const stick_record& record)
      : take_{take}, near_{record.known(take.near_N), take.rate_Hz}, far_{record.known(take.far_N), take.rate_Hz} {}

  template <class Torsion>
  [[nodiscard]] wide_motion at(double half_delay_s, const smooth_window& window, const Torsion& torsion) {
    const auto parts = [this, half_delay_s](double f) { return passage(f, half_delay_s); };
    wide_motion m;
    for (const int side : {0, 1}) {
      auto& signal = side == 0 ? near_ : far_;
      const auto velocity = signal.through(window, [&](double f) { return parts(f)[side == 0 ? 0 : 1]; });
      const auto rolled = signal.through(window, [&](double f) { return parts(f)[side == 0 ? 2 : 3] * torsion(f); });
      const auto slow = signal.through(window, [&](double f) { return parts(f)[side == 0 ? 2 : 3] * std::complex<double>(0, 2 * std::numbers::pi * f * stick_record::compliance_unit); });
      const auto slower = signal.through(window, [&](double f) {
        return parts(f)[side == 0 ? 2 : 3] * std::complex<double>(0, 2 * std::numbers::pi * f * stick_record::compliance_unit) * std::pow(f / stick_record::compliance_corner_Hz, 2);
      });
      auto& surface = side == 0 ? m.near_m_s : m.far_m_s;
      surface = velocity;
      for (auto* to : {&m.near_m_s, &m.far_m_s, &m.compliance[0], &m.compliance[1]}) to->resize(velocity.size(), 0.0);
      for (std::size_t i = 0; i < velocity.size(); ++i) {
        rolled_at(m, i, rolled[i]);
        m.compliance[0][i] += slow[i];
        m.compliance[1][i] += slower[i];
      }
    }
    for (auto* s : {&m.near_m_s, &m.far_m_s})
      for (std::size_t i = 0; i < s->size(); ++i) (*s)[i] += rolling_[i] - take_.rod_speed_m_s;
    rolling_.clear();
    return m;
  }

  static constexpr double pole_width = 0.1;  ///< where the piece between both places is a quarter wave long, their sum is all noise

private:
  void rolled_at(const wide_motion& m, std::size_t i, double v) {
    rolling_.resize(m.near_m_s.size(), 0.0);
    rolling_[i] += v;
  }
  /// {v_a / F_1, v_b / F_2, (f_a + f_b) / F_1, the same / F_2}.
  [[nodiscard]] std::array<std::complex<double>, 4> passage(double f, double d) const {
    const double w = 2 * std::numbers::pi * f, eps = take_.stiffness_s2, Z = take_.impedance_Ns_m * wave_impedance_ratio(w, eps);
    const std::complex<double> g(0.5 * w * take_.inverse_q * slowness_ratio(w, eps), phase_rate(w, eps));
    const auto sa = std::sinh(g * (take_.delay_s[0] - d)), sb = std::sinh(g * (take_.delay_s[1] - d)), cosh_d = std::cosh(g * d), t = std::sinh(g * d) * std::conj(cosh_d) / (std::norm(cosh_d) + pole_width * pole_width);
    return {sa / Z, sb / Z, std::cosh(g * (take_.delay_s[0] - d)) + t * sa, std::cosh(g * (take_.delay_s[1] - d)) + t * sb};
  }

  contact_take take_;
  contact_signal<> near_, far_;
  std::vector<double> rolling_;
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

}  // namespace rosin
