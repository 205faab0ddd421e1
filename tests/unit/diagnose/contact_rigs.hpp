// SPDX-License-Identifier: MIT
//
// Strokes for the tests of the contact's diagnosis: simulated, recorded by 16-bit converters, brought back to the bow.
//
#pragma once

#include <rosin/diagnose/contact_take.hpp>
#include <rosin/friction/elasto_plastic.hpp>
#include <rosin/friction/thermal_plastic.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/friction/yield_curve_design.hpp>
#include <rosin/propagate/bow_point.hpp>
#include <rosin/reconstruct/reconstructor.hpp>
#include <rosin/simulate/burdened_signals.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_stroke.hpp>

namespace contact_rigs {

constexpr double rate = 128e3;
const rosin::string_parameters e_string{
    .length_m = 0.314, .tension_N = 72.5, .fundamental_Hz = 660, .bending_stiffness_Nm2 = 4.7e-5, .loss = {.quality = 1000}};
const rosin::modal_torsion rolls{7, 3.5, 15};

struct stroke {
  std::vector<double> force, velocity, velocity_near, velocity_far, near, far;
  double speed = 0, normal = 0, position = 0.27, noise = 0.3e-3;

  [[nodiscard]] rosin::contact_take take() const {
    const auto at = rosin::contact_at(e_string, position);
    rosin::contact_take t;
    t.name = "bow";
    t.force_N = force, t.velocity_m_s = velocity, t.velocity_near_m_s = velocity_near, t.velocity_far_m_s = velocity_far;
    t.near_N = near, t.far_N = far, t.rate_Hz = rate, t.rod_speed_m_s = speed, t.normal_force_N = normal;
    t.delay_s = at.delay_s, t.stiffness_s2 = at.stiffness_s2, t.loss = at.loss, t.impedance_Ns_m = at.impedance_Ns_m,
    t.length_m = e_string.length_m;
    t.force_sd_N = 4 * noise / 3, t.velocity_sd_m_s = 5 * noise, t.noise_N = {noise, noise}, t.edge_Hz = 57600, t.start_s = 0.02;
    return t;
  }
};

/// A steady stroke whose speed and normal force carry tones; it may leave the string at equal intervals.
struct rippled_rod {
  rosin::steady_rod steady;
  double speed_Hz = 100, speed_relative = 0, normal_Hz = 100, normal_relative = 0;
  double leaves_every_s = 1e9, leaves_for_s = 0;
  [[nodiscard]] rosin::rod_state operator()(double t) const noexcept {
    rosin::rod_state s = steady(t);
    s.velocity_m_s *= 1 + speed_relative * std::sin(6.283185307179586 * speed_Hz * t + 0.7);
    s.normal_force_N *= 1 + normal_relative * std::sin(6.283185307179586 * normal_Hz * t + 0.3);
    if (std::fmod(t, leaves_every_s) > leaves_every_s - leaves_for_s) s.normal_force_N = 0;
    return s;
  }
};

/// A law whose rod gives way: a mass on a damped spring, its speed under the force that acts back.
template <class Law>
struct springy_rod {
  using scalar = double;
  Law law;
  double frequency_Hz = 1500, q = 15, mass_kg = 0.003;
  double u = 0, x = 0, a = 0;  // velocity, displacement and acceleration against the force

  rosin::contact_force<double> operator()(const rosin::load_line<double>& line) noexcept {
    const double h = line.step_s / 2, w = 6.283185307179586 * frequency_Hz, k = 1 + h * w / q + h * h * w * w;
    rosin::load_line<double> both = line;  // trapezoidal rule of u' = f / m - w / q u - w^2 x, x' = u
    const double free = (u + h * a - h * w * w * (x + h * u)) / k, yields = h / mass_kg / k;
    both.rod_velocity_m_s -= free;
    both.mobility_m_Ns += yields;
    const auto answer = law(both);
    const double next = free + yields * answer.force_N;
    x += h * (u + next);
    u = next;
    a = answer.force_N / mass_kg - w / q * u - w * w * x;
    return answer;
  }
  void reset() noexcept { law.reset(), u = x = a = 0; }
};

template <class Law>
[[nodiscard]] stroke play(const Law& law, const rippled_rod& rod, const rosin::modal_torsion& torsion, std::uint64_t seed,
                          double position = 0.27, double duration_s = 0.1, double noise_N = 0.3e-3, double width_m = 0,
                          int places = 2) {
  stroke r;
  const rosin::modal_rig rig{.string = e_string, .torsion = torsion};
  const rosin::modal_stroke how{.position = position, .duration_s = duration_s};
  const auto take = width_m > 0
                        ? rosin::simulate_stroke(rig, rosin::rig_burden{.contact_width_m = width_m, .contact_places = places},
                                                 law, rod, how, {.oversampling = 4})
                        : rosin::simulate_stroke(rig, law, rod, how, {.oversampling = 4});
  if (!take) return r;
  const rosin::converter sensor{.gain = 1, .newtons_per_full_scale = 2, .noise_N = noise_N, .bits = 16};
  r.near = rosin::convert(take->force_near_N, rate, sensor, seed).newtons();
  r.far = rosin::convert(take->force_far_N, rate, sensor, seed + 1).newtons();
  rosin::reconstructor<double> reconstruct(rosin::contact_at(e_string, position), {38400, 57600}, rate, 1e-5);
  const auto motion = reconstruct(r.near, r.far);
  for (std::size_t i = 0; i < take->size(); ++i)
    r.force.push_back(motion.force_N(i)), r.velocity.push_back(motion.velocity_m_s(i));
  r.velocity_near = motion.velocity_near_m_s, r.velocity_far = motion.velocity_far_m_s;
  r.speed = rod.steady.speed_m_s, r.normal = rod.steady.normal_force_N, r.position = position, r.noise = noise_N;
  return r;
}

inline rosin::velocity_curve<rosin::two_exponential_curve<>> curve() {
  return rosin::velocity_curve<rosin::two_exponential_curve<>>{};
}

inline rippled_rod slow() { return {{.speed_m_s = 0.16, .normal_force_N = 0.3, .start_s = 0.002, .rise_s = 0.005}}; }
inline rippled_rod fast() { return {{.speed_m_s = 0.22, .normal_force_N = 0.4, .start_s = 0.002, .rise_s = 0.005}}; }

inline rosin::contact_model declared() {
  rosin::contact_model m;
  m.torsion = rosin::torsion_values{rolls.speed_ratio, rolls.impedance_ratio, rolls.quality};
  return m;
}

}  // namespace contact_rigs
