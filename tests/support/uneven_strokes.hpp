// SPDX-License-Identifier: MIT
//
// A bowing machine's strokes on a string each of whose modes loses on its own: modes of the stiff string with Q scattered about a law,
// torsion, friction as a function of velocity, a rod that starts, draws and is lifted. No plucks; sensors with gains, skew and noise.
//
#pragma once

#include <rosin/calibrate/stroke_layout.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_stroke.hpp>

#include <rosin/friction/velocity_curve.hpp>

namespace test {

struct uneven_machine {
  rosin::modal_rig rig{};
  double q_scatter = 0.15;
  std::uint64_t seed = 1;
  rosin::velocity_curve<rosin::two_exponential_curve<double>> law{{0.35, 0.01, 0.38, 0.1, 0.35}};
  double rate_Hz = 50000, duration_s = 1, mode_limit_Hz = 40e3;
  int oversampling = 6;
  std::array<double, 2> gain{1.01, 0.985}, noise_N{1e-3, 1e-3};

  /// ln of Q of mode n over the law's.
  [[nodiscard]] double ln_own_q(int n) const {
    rosin::gaussian_source draw{seed * 7919 + static_cast<std::uint64_t>(n)};
    return q_scatter * draw();
  }
  [[nodiscard]] std::vector<rosin::string_mode> modes() const {
    auto all = rosin::transverse_modes(rig.string, mode_limit_Hz);
    for (auto& m : all) m.inverse_quality *= std::exp(-ln_own_q(m.number));
    return all;
  }
};

struct machine_stroke {
  double position = 0.1, speed_m_s = 0.1, normal_force_N = 0.5;
  double tension_drift = 0;  ///< ln of f0 in this stroke
  double width = 0;          ///< of the contact, as a fraction of the length: half of the force at either edge
};

inline rosin::rod_state rod_of(const uneven_machine& m, const machine_stroke& s, double t) {
  const double start = 0.03, rise = 0.05, lift = 0.85 * m.duration_s, u = (t - start) / rise;
  const double share = u <= 0 ? 0 : u < 1 ? (1 - std::cos(std::numbers::pi * u)) / 2 : 1;
  return {s.speed_m_s * share, t < lift ? s.normal_force_N : 0};
}

/// What happens, before sensors and noise.
inline rosin::modal_take bow(const uneven_machine& machine, const machine_stroke& stroke) {
  uneven_machine m = machine;
  m.rig.string.fundamental_Hz *= std::exp(stroke.tension_drift);
  m.rig.string.tension_N *= std::exp(2 * stroke.tension_drift);
  const rosin::modal_settings settings{
      .sample_rate_Hz = m.rate_Hz, .oversampling = m.oversampling, .mode_limit_Hz = m.mode_limit_Hz};
  const double h = 1 / (m.rate_Hz * m.oversampling), p = stroke.position;
  const rosin::modal_decimator decimate{settings.low_pass(), h, m.oversampling};
  const auto samples = static_cast<std::size_t>(m.duration_s * m.rate_Hz);
  const std::size_t first = decimate.reach(), steps = (samples - 1) * static_cast<std::size_t>(m.oversampling) + 1 + 2 * first;
  const auto transverse = m.modes(), twist = rosin::torsional_modes(m.rig, m.mode_limit_Hz);
  rosin::modal_bank<2> string{transverse, m.rig.damping, {p - stroke.width / 2, p + stroke.width / 2}, h};
  rosin::modal_bank<1> torsion{twist, rosin::damping_convention::viscous, {p}, h};
  const bool wide = stroke.width > 0;
  rosin::modes_left_out rest;
  rest.near = wide ? 0 : 1 - p - string.near_share(0), rest.far = wide ? 0 : p - string.far_share(0);
  rest.centre_m_N = wide ? 0 : rosin::static_compliance_m_N(m.rig.string, p) - string.compliance(0);
  rosin::detail::stroke_steps s{steps};
  s.rest.assign(1, rest), s.position.assign(1, p);
  rosin::modal_take take{.sample_rate_Hz = m.rate_Hz};
  std::array laws{m.law, m.law};
  for (auto& law : laws) law.reset();
  std::array<double, 2> before{};
  for (std::size_t i = first; i < steps; ++i) {
    auto rod = rod_of(m, stroke, static_cast<double>(i - first) * h);
    const double yields = rest.centre_m_N / h, own = string.mobility(0, 0), twists = torsion.mobility(0, 0);
    std::array<double, 2> f{};
    if (!wide) {
      const rosin::load_line<double> line{string.free().velocity[0] + torsion.free().velocity[0] - yields * before[0],
                                          own + twists + yields, rod.velocity_m_s, rod.normal_force_N, h};
      f[0] = laws[0](line).force_N;
    } else {  // each edge feels the other one step late
      rod.normal_force_N /= 2;
      for (std::size_t e = 0; e < 2; ++e) {
        const double other = before[1 - e];
        const rosin::load_line<double> line{
            string.free().velocity[e] + string.mobility(e, 1 - e) * other + torsion.free().velocity[0] + twists * other,
            string.mobility(e, e) + twists, rod.velocity_m_s, rod.normal_force_N, h};
        f[e] = laws[e](line).force_N;
      }
    }
    const double sum = f[0] + f[1];
    s.near[i] = string.free().near + string.near_gain(0) * f[0] + string.near_gain(1) * f[1];
    s.far[i] = string.free().far + string.far_gain(0) * f[0] + string.far_gain(1) * f[1];
    s.centre[i] = string.free().velocity[0] + own * f[0] + string.mobility(0, 1) * f[1];
    s.torsion[i] = torsion.free().velocity[0] + twists * sum;
    s.force[i] = sum, s.rod[i] = rod.velocity_m_s;
    string.advance({f[0], f[1]}), torsion.advance({sum});
    before = f;
  }
  rosin::detail::sample_steps(take, s, decimate, static_cast<std::size_t>(m.oversampling));
  return take;
}

/// As its sensors record it.
inline rosin::stroke_take record(const uneven_machine& m, const rosin::modal_take& take, double declared, std::uint64_t number,
                                 const std::string& name) {
  rosin::stroke_take out{name, take.sample_rate_Hz, {take.force_near_N, take.force_far_N}, declared};
  for (std::size_t c = 0; c < 2; ++c) {
    rosin::gaussian_source noise{m.seed * 1000 + 2 * number + c};
    for (double& x : out.force_N[c]) x = m.gain[c] * x + m.noise_N[c] * noise();
  }
  return out;
}

/// A machine that belongs to a seed, its strokes, and what its notebook says of it.
struct drawn_strokes {
  uneven_machine machine{};
  std::vector<machine_stroke> strokes{};
  std::vector<double> declared{};
  rosin::stroke_guess guess{};
  double declared_length_m = 0, declared_tension_N = 0;
};

inline drawn_strokes draw_strokes(std::uint64_t seed, std::size_t count, double duration_s = 1) {
  rosin::gaussian_source g{seed};
  drawn_strokes d;
  auto& m = d.machine;
  m.seed = seed, m.duration_s = duration_s;
  const bool violin = g.uniform() < 0.5;
  m.rig.string =
      violin ? rosin::string_parameters{g.uniform(0.32, 0.33), g.uniform(45, 70), g.uniform(200, 420), g.uniform(1e-5, 4e-5)}
             : rosin::string_parameters{g.uniform(0.68, 0.70), g.uniform(110, 160), g.uniform(95, 150), g.uniform(2e-4, 4.5e-4)};
  m.rig.string.loss = {.quality = g.uniform(450, 1100), .internal_s = g.uniform(2e-8, 6e-8)};
  m.rig.torsion = {g.uniform(5.3, 6.5), g.uniform(1.5, 3.4), g.uniform(20, 45)};
  m.q_scatter = g.uniform(0.05, 0.2);
  m.law = rosin::velocity_curve<rosin::two_exponential_curve<double>>{
      {g.uniform(0.3, 0.4), 0.01, g.uniform(0.34, 0.42), 0.1, g.uniform(0.3, 0.38)}};
  for (auto& x : m.gain) x = 1 + 0.02 * std::clamp(g(), -2.0, 2.0);
  const double noise = g.uniform(0.5e-3, 2e-3);
  for (auto& x : m.noise_N) x = noise * g.uniform(0.8, 1.2);
  const double z = m.rig.string.impedance_Ns_m();
  for (std::size_t i = 0; i < count; ++i) {
    const double beta = g.uniform(0.05, 0.19), v = g.uniform(0.05, 0.2);
    d.strokes.push_back({beta, v, g.uniform(2.5, 8) * z * v / beta});  // of Schelleng's triangle, both sides of its upper edge
    d.declared.push_back(beta + 0.0007 * std::clamp(g(), -2.0, 2.0));
  }
  const auto& s = m.rig.string;
  d.declared_length_m = s.length_m * (1 + 1e-3 * std::clamp(g(), -2.0, 2.0));
  d.declared_tension_N = s.tension_N * (1 + 0.01 * std::clamp(g(), -2.0, 2.0));
  d.guess = {.fundamental_Hz = s.fundamental_Hz * (1 + 0.005 * std::clamp(g(), -2.0, 2.0)),
             .inharmonicity = s.inharmonicity() * (1 + 0.15 * std::clamp(g(), -2.0, 2.0)),
             .position_tolerance = 0.003};
  return d;
}

inline std::vector<rosin::stroke_take> recorded(const drawn_strokes& d, std::vector<rosin::modal_take>* truth = nullptr) {
  std::vector<rosin::stroke_take> takes;
  for (std::size_t i = 0; i < d.strokes.size(); ++i) {
    auto take = bow(d.machine, d.strokes[i]);
    takes.push_back(record(d.machine, take, d.declared[i], i, "whole_" + std::to_string(i + 1)));
    if (truth != nullptr) truth->push_back(std::move(take));
  }
  return takes;
}

}  // namespace test
