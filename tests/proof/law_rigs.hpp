// SPDX-License-Identifier: MIT
// Random rigs under three kinds of friction, played by the modal simulator, recorded by 16-bit converters, calibrated from
// plucks, tuned and reconstructed as any rig is. What is made here knows nothing of the fit of a law: that sees only what
// `reconstructed` holds.
#pragma once

#include "chain.hpp"

#include <rosin/condition/ac_coupling.hpp>
#include <rosin/diagnose/contact_take.hpp>
#include <rosin/friction/elasto_plastic.hpp>

namespace proof {

using steady_curve = rosin::two_exponential_curve<double>;

struct law_rig {
  rosin::random_rig base;  ///< string, notebook, gains, plucks; its own strokes and law are not used
  rosin::contact_law kind = rosin::contact_law::velocity_curve;
  std::variant<rosin::velocity_curve<steady_curve>, rosin::velocity_curve<rosin::hyperbolic_curve<double>>,
               rosin::thermal_plastic<double>, rosin::elasto_plastic<steady_curve>>
      law{};
  std::array<rosin::steady_rod, 3> strokes{};
  std::array<double, 3> declared_normal_N{}, declared_speed_m_s{};
  rosin::torsion_values declared_torsion{};
  double stiffness_1_m = 0, presliding_s = 0;  ///< bristles: s0 / N; shortest mu N / (s0 v) of the three strokes
  rosin::contact_heat_parameters<double> heat{};
};

/// Thermal friction with a layer and an area of its own, that shows the steady curve; or bristles that take `presliding_s` at
/// least to give way; or a curve: two exponentials or a hyperbola.
inline void draw_law(law_rig& r, rosin::gaussian_source& source) {
  const auto& steady = r.base.steady_friction;
  const double at_rest = steady(0).value;
  double fastest = 0;
  for (const auto& s : r.strokes) fastest = std::max(fastest, s.speed_m_s);
  if (r.kind == rosin::contact_law::thermal) {
    r.heat = {.layer_m = source.uniform(1e-6, 5e-6), .area_per_newton_m2 = source.uniform(0.7e-7, 1.5e-7)};
    const auto strength = rosin::design_yield_curve(steady, r.heat.without_string(), r.strokes[0].normal_force_N);
    if (strength) r.law = rosin::thermal_plastic<double>{*strength, r.heat};
  } else if (r.kind == rosin::contact_law::elasto_plastic) {
    r.presliding_s = 50e-6 * std::pow(4, source.uniform());
    r.stiffness_1_m = at_rest / (fastest * r.presliding_s);
    r.law = rosin::elasto_plastic<steady_curve>{steady,
                                                {.stiffness_1_m = r.stiffness_1_m,
                                                 .damping_Ns_m = source.uniform(1e-3, 6e-3),
                                                 .kinetic = steady.c,
                                                 .breakaway = source.uniform(0.4, 0.9)}};
  } else if (source.uniform() < 0.5) {
    r.law = rosin::velocity_curve<steady_curve>{steady};
  } else {
    r.law = rosin::velocity_curve<rosin::hyperbolic_curve<double>>{
        {source.uniform(0.25, 0.4), source.uniform(0.8, 1.1), source.uniform(0.05, 0.2)}};
  }
}

/// Strings besides the E: lower, slacker, stiffer. The notebook stays as far off as it was drawn.
inline void draw_other_string(rosin::random_rig& r, rosin::gaussian_source& source) {
  const double tension = source.uniform(0.6, 1.25), pitch = 0.45 * std::pow(1.25 / 0.45, source.uniform()),
               stiff = 0.4 * std::pow(5, source.uniform());
  for (auto* s : {&r.rig.string, &r.declared.string})
    s->tension_N *= tension, s->fundamental_Hz *= pitch, s->bending_stiffness_Nm2 *= stiff;
}

/// Errors of the notebook: normal force 1.5 % in common and 0.5 % each, speed 0.5 %, torsion as wires' data are known.
inline law_rig draw_law_rig(rosin::contact_law kind, std::uint64_t seed) {
  law_rig r{.base = rosin::draw_rig(seed), .kind = kind};
  rosin::gaussian_source source{seed ^ 0x51a7e0f1c3d2b4a5ULL};
  draw_other_string(r.base, source);
  r.base.rig.damping = source.uniform() < 0.5 ? rosin::damping_convention::viscous : rosin::damping_convention::kelvin_voigt;
  for (auto& s : r.strokes)
    s = {.speed_m_s = source.uniform(0.1, 0.3),
         .normal_force_N = source.uniform(0.25, 0.5),
         .rise_s = source.uniform(0.005, 0.02)};
  draw_law(r, source);
  const double common = 1 + rosin::detail::slip_of_the_pen(source, 0.015);
  for (std::size_t i = 0; i < r.strokes.size(); ++i) {
    r.declared_normal_N[i] = r.strokes[i].normal_force_N * common * (1 + rosin::detail::slip_of_the_pen(source, 0.005));
    r.declared_speed_m_s[i] = r.strokes[i].speed_m_s * (1 + rosin::detail::slip_of_the_pen(source, 0.005));
  }
  const auto& t = r.base.rig.torsion;
  r.declared_torsion = {t.speed_ratio * (1 + rosin::detail::slip_of_the_pen(source, 0.002)),
                        t.impedance_ratio * (1 + rosin::detail::slip_of_the_pen(source, 0.01)),
                        t.quality * (1 + rosin::detail::slip_of_the_pen(source, 0.03))};
  return r;
}

/// One stroke as far as a laboratory knows it; owns what a contact_take looks at.
struct reconstructed {
  std::vector<double> force, velocity, velocity_near, velocity_far, near, far;
  rosin::contact_take take{};
  double true_mean_N = 0;  ///< of the force over the known samples, for whoever wants to know a lost level
  void look() {
    take.force_N = force, take.velocity_m_s = velocity, take.velocity_near_m_s = velocity_near,
    take.velocity_far_m_s = velocity_far, take.near_N = near, take.far_N = far;
  }
};

inline reconstructed bring_back(const rosin::calibration& plucked, const rosin::band& limits,
                                const std::array<std::vector<double>, 2>& recorded) {
  reconstructed out;
  const auto tuned = rosin::fine_tune(plucked, recorded[0], recorded[1], limits, rate_Hz).tuned;
  const auto force = rosin::detail::calibrated(tuned, recorded[0], recorded[1]);
  const auto motion = rosin::reconstructor<double>(tuned.at, limits, rate_Hz)(force[0], force[1]);
  for (std::size_t i = 0; i < recorded[0].size(); ++i)
    out.force.push_back(motion.force_N(i)), out.velocity.push_back(motion.velocity_m_s(i));
  out.velocity_near = motion.velocity_near_m_s, out.velocity_far = motion.velocity_far_m_s, out.near = force[0],
  out.far = force[1];
  const auto slopes = rosin::sensitivity<rosin::full_physics>(tuned, force[0], force[1], limits, rate_Hz);
  const auto sd = rosin::uncertainty<rosin::full_physics>(
      tuned, motion, slopes, {tuned.noise_N[0] / tuned.gain[0], tuned.noise_N[1] / tuned.gain[1]}, limits, rate_Hz);
  auto& t = out.take;
  t.rate_Hz = rate_Hz, t.delay_s = tuned.at.delay_s, t.stiffness_s2 = tuned.at.stiffness_s2,
  t.impedance_Ns_m = tuned.at.impedance_Ns_m;
  t.loss = tuned.at.loss;
  t.force_sd_N = sd.force_sd_N[out.force.size() / 2], t.velocity_sd_m_s = sd.velocity_sd_m_s[out.force.size() / 2],
  t.edge_Hz = limits.stop_Hz;
  return out;
}

/// Plays three strokes, 0.2 s each, and three plucks. Empty: a stroke did not stick and slip, or no strength shows the steady
/// curve: draw another.
inline rosin::outcome<std::vector<reconstructed>> play_rig(const law_rig& r, double ac_coupled_Hz = 0, double duration_s = 0.2) {
  if (r.kind == rosin::contact_law::thermal && r.law.index() != 2) return std::vector<reconstructed>{};
  const rosin::modal_settings settings;
  std::vector<rosin::modal_take> truth;
  for (const auto& stroke : r.strokes) {
    auto take = std::visit(
        [&](const auto& law) {
          return rosin::simulate_stroke(r.base.rig, law, stroke, {.position = r.base.position, .duration_s = duration_s},
                                        settings);
        },
        r.law);
    if (!take) return rosin::failure{take.error()};
    if (rosin::motion_of(*take) != rosin::bowed_motion::stick_slip) return std::vector<reconstructed>{};
    truth.push_back(*std::move(take));
  }
  const std::size_t strokes = truth.size();
  for (const auto& pluck : r.base.plucks) {
    auto take = rosin::simulate_pluck(r.base.rig, pluck, settings);
    if (!take) return rosin::failure{take.error()};
    truth.push_back(*std::move(take));
  }
  std::vector<std::array<std::vector<double>, 2>> recorded(truth.size());
  for (std::size_t c = 0; c < 2; ++c) {
    const auto force = [c](const rosin::modal_take& t) {
      return std::span<const double>{c == 0 ? t.force_near_N : t.force_far_N};
    };
    double peak = 0;
    for (const auto& take : truth)
      for (const double f : force(take)) peak = std::max(peak, std::abs(r.base.gain[c] * f));
    const rosin::converter channel{.gain = r.base.gain[c],
                                   .newtons_per_full_scale = peak / r.base.peak_share,
                                   .noise_N = r.base.noise_N,
                                   .ac_coupled_Hz = ac_coupled_Hz};
    for (std::size_t i = 0; i < truth.size(); ++i) {
      recorded[i][c] = rosin::convert(force(truth[i]), rate_Hz, channel, r.base.seed * 1000 + 10 * i + c).newtons();
      if (i < strokes) rosin::restore_ac_coupled(std::span<double>(recorded[i][c]), ac_coupled_Hz, rate_Hz);
    }
  }
  std::vector<rosin::pluck_take> plucks;
  for (std::size_t i = 0; i < r.base.plucks.size(); ++i)
    plucks.push_back({"pluck",
                      rate_Hz,
                      {recorded[strokes + i][0], recorded[strokes + i][1]},
                      r.base.declared.pluck_N[i],
                      0.03,
                      r.base.declared.position});
  const auto fit = rosin::fit_plucks(plucks, {.fundamental_Hz = r.base.declared.string.fundamental_Hz,
                                              .inharmonicity = r.base.declared.string.inharmonicity(),
                                              .ac_coupled_Hz = {ac_coupled_Hz, ac_coupled_Hz}});
  if (!fit) return rosin::failure{fit.error()};
  const auto plucked = rosin::calibration_from(*fit, r.base.declared.position, r.base.declared.string.impedance_Ns_m(), 0.01);
  std::vector<reconstructed> out;
  for (std::size_t i = 0; i < strokes; ++i) {
    out.push_back(bring_back(plucked, {0.30 * rate_Hz, 0.45 * rate_Hz}, recorded[i]));
    auto& s = out.back();
    s.take.name = "bow-" + std::to_string(i + 1), s.take.rod_speed_m_s = r.declared_speed_m_s[i],
    s.take.normal_force_N = r.declared_normal_N[i];
    s.take.length_m = r.base.declared.string.length_m;
    double count = 0;
    for (std::size_t n = 0; n < s.force.size(); ++n)
      if (std::isfinite(s.force[n])) s.true_mean_N += truth[i].contact_force_N[n], ++count;
    s.true_mean_N /= count;
  }
  for (auto& s : out) s.look();
  return out;
}

}  // namespace proof
