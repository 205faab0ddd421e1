// tier: hosted
// SPDX-License-Identifier: MIT
//
// A stroke of the rod: string at rest, rod set in motion, and in each step the law of friction finds the force on the
// load line that the modes offer. Any law (concept FrictionLaw), any motion of the rod (concept RodMotion), also along the
// string (TravellingRod).
//
#pragma once

#include <algorithm>
#include <utility>

#include <rosin/core/number_text.hpp>
#include <rosin/core/outcome.hpp>
#include <rosin/simulate/energy_account.hpp>
#include <rosin/simulate/modal_contact.hpp>
#include <rosin/simulate/modal_decimator.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// How the rod moves and presses: a function of time.
template <class M>
concept RodMotion = std::copyable<M> && requires(const M& motion, double t) {
  { motion(t) }
  noexcept->std::same_as<rod_state>;
};

/// One that may also travel along the string: its place (distance from the near end / length) as a function of time. Where
/// travels() is false it stays where the stroke has it.
template <class M>
concept TravellingRod = RodMotion<M> && requires(const M& motion, double t) {
  { motion.travels() }
  noexcept->std::same_as<bool>;
  { motion.position(t) }
  noexcept->std::same_as<double>;
};

/// Lies on the string with its full force from the start, waits, and gathers speed along half a cosine.
struct steady_rod {
  double speed_m_s = 0.2;
  double normal_force_N = 0.3;
  double start_s = 0.004;
  double rise_s = 0.01;

  [[nodiscard]] rod_state operator()(double t) const noexcept {
    constexpr double pi = 3.14159265358979323846;
    const double u = t - start_s;
    if (u <= 0) return {0, normal_force_N};
    return {u < rise_s ? speed_m_s * (1 - std::cos(pi * u / rise_s)) / 2 : speed_m_s, normal_force_N};
  }
};

struct modal_stroke {
  double position = 0.3;  ///< distance from the near end / length
  double duration_s = 0.36;
  bool account = false;  ///< keep the books of energy; takes half as long again
};

namespace detail {

/// Everything at every step of the simulation.
struct stroke_steps {
  std::vector<double> near, far, centre, torsion, force, rod, temperature, slip;
  std::vector<double> position;      ///< one for all where the rod does not travel
  std::vector<modes_left_out> rest;  ///< the same

  explicit stroke_steps(std::size_t size) {
    for (auto* s : {&near, &far, &centre, &torsion, &force, &rod, &temperature, &slip}) s->assign(size, 0.0);
  }
};

template <class Motion>
[[nodiscard]] bool travels(const Motion& motion) noexcept {
  if constexpr (TravellingRod<Motion>) return motion.travels();
  else return false;
}

/// The place of the contact at t; `start`: where it stays if it does not travel.
template <class Motion>
[[nodiscard]] double place_of(const Motion& motion, double t, double start) noexcept {
  if constexpr (TravellingRod<Motion>) return motion.travels() ? motion.position(t) : start;
  else return start;
}

/// Before the first step the contact is where it is at the first.
template <class Motion>
void set_out(stroke_steps& s, modal_contact& contact, const Motion& motion, std::size_t first, double start) {
  const bool moves = travels(motion);
  if (moves) contact.move_to(place_of(motion, 0, start));
  s.position.assign(moves ? first : 1, place_of(motion, 0, start));
  s.rest.assign(moves ? first : 1, contact.left_out());
}

/// Steps up to which the rod presses; all, where it never does. `first`: the one at t = 0.
template <class Motion>
[[nodiscard]] std::size_t pressed_steps(const Motion& motion, std::size_t first, std::size_t steps, double step_s) noexcept {
  for (std::size_t end = steps; end > first; --end)
    if (motion(static_cast<double>(end - 1 - first) * step_s).normal_force_N > 0) return end;
  return steps;
}

template <class Law, class Motion>
void run_steps(stroke_steps& s, modal_take& take, modal_contact& contact, Law& law, const Motion& motion, std::size_t first,
               double step_s) {
  std::size_t slipped = 0;
  bool before = false;
  const std::size_t end = pressed_steps(motion, first, s.force.size(), step_s);
  for (std::size_t i = first; i < s.force.size(); ++i) {
    const double t = static_cast<double>(i - first) * step_s;
    const rod_state rod = motion(t);
    if (travels(motion)) {
      contact.move_to(s.position.emplace_back(place_of(motion, t, 0)));
      s.rest.push_back(contact.left_out());
    }
    const auto line = contact.line(rod);
    const auto answer = law(line);
    s.slip[i] = line.slip(answer.force_N);
    const auto state = contact.apply(answer.force_N);
    s.near[i] = state.near_N, s.far[i] = state.far_N, s.centre[i] = state.centre_m_s, s.torsion[i] = state.torsion_m_s;
    s.force[i] = answer.force_N, s.rod[i] = rod.velocity_m_s, s.temperature[i] = answer.temperature_rise_K;
    take.unconverged += answer.converged ? 0U : 1U;
    take.slips += answer.slipping && !before ? 1U : 0U;
    before = answer.slipping;
    slipped += before && i > end / 2 && i < end ? 1U : 0U;
  }
  take.slipping = static_cast<double>(slipped) / static_cast<double>(end - end / 2);
}

inline void add_scaled(std::vector<double>& to, double factor, const std::vector<double>& from) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
}

/// All signals through the low-pass, and into them what the modes left out contribute: their share of the force, their
/// compliance times its rate (a contact that travels changes the compliance too slowly to count).
template <class = void>
void sample_steps(modal_take& take, const stroke_steps& s, const modal_decimator& decimate, std::size_t stride) {
  take.contact_force_N = decimate.lines(s.force);
  const auto rate = decimate.slopes(s.force);
  take.force_near_N = decimate.points(s.near);
  take.force_far_N = decimate.points(s.far);
  take.centre_velocity_m_s = decimate.points(s.centre);
  take.torsion_velocity_m_s = decimate.points(s.torsion);
  for (std::size_t n = 0; n < rate.size(); ++n) {
    const auto& rest = s.rest.size() == 1 ? s.rest[0] : s.rest[decimate.reach() + n * stride];
    take.force_near_N[n] += rest.near * take.contact_force_N[n];
    take.force_far_N[n] += rest.far * take.contact_force_N[n];
    take.centre_velocity_m_s[n] += rest.centre_m_N * rate[n];
    take.torsion_velocity_m_s[n] += rest.torsion_m_N * rate[n];
  }
  take.rod_velocity_m_s = decimate.points(s.rod);
  const bool warm = std::any_of(s.temperature.begin(), s.temperature.end(), [](double t) { return t != 0; });
  if (warm) take.temperature_rise_K = decimate.points(s.temperature);
}

/// Integral of a b over the take, both straight between the steps.
[[nodiscard]] inline double integral_of_product(const std::vector<double>& a, const std::vector<double>& b,
                                                double step_s) noexcept {
  double sum = 0;
  for (std::size_t i = 1; i < a.size(); ++i) sum += 2 * (a[i - 1] * b[i - 1] + a[i] * b[i]) + a[i - 1] * b[i] + a[i] * b[i - 1];
  return sum * step_s / 6;
}

template <class = void>
[[nodiscard]] stroke_energy account_of(const modal_rig& rig, const stroke_steps& s, double limit_Hz, double step_s) {
  stroke_energy out{.rod_J = integral_of_product(s.force, s.rod, step_s),
                    .friction_J = -integral_of_product(s.force, s.slip, step_s)};
  energy_account transverse{transverse_modes(rig, limit_Hz), step_s}, torsion{torsional_modes(rig, limit_Hz), step_s};
  transverse.follow(s.force, s.position);
  torsion.follow(s.force, s.position);
  out.transverse = transverse.total(), out.torsion = torsion.total();
  const double f = s.force.back();
  out.left_out_J = (s.rest.back().centre_m_N + s.rest.back().torsion_m_N) * f * f / 2;
  return out;
}

/// The first thing about the way of the rod along the string that cannot be; empty if nothing.
template <class Motion>
[[nodiscard]] std::string problem_with_way(const Motion& motion, const modal_stroke& stroke, double sample_rate_Hz) {
  if (!travels(motion)) return {};
  for (double t = 0; t <= stroke.duration_s; t += 1 / sample_rate_Hz)
    if (const double x = place_of(motion, t, 0); !(x > 0 && x < 1))
      return "contact: it travels beyond an end of the string at " + number_text(t) + " s";
  return {};
}

}  // namespace detail

/// Simulates a stroke; fails where rig, stroke or settings make no sense.
template <FrictionLaw Law, RodMotion Motion = steady_rod>
[[nodiscard]] outcome<modal_take> simulate_stroke(const modal_rig& rig, Law law, Motion motion = {}, modal_stroke stroke = {},
                                                  const modal_settings& settings = {}) {
  for (const auto& problem : {problem_with(rig, detail::place_of(motion, 0, stroke.position)), problem_with(settings),
                              problem_with_duration(stroke.duration_s, settings)})
    if (!problem.empty()) return failure{problem};
  if (const auto problem = detail::problem_with_way(motion, stroke, settings.sample_rate_Hz); !problem.empty())
    return failure{problem};
  const double step_s = 1 / (settings.sample_rate_Hz * settings.oversampling);
  const double limit_Hz = std::min(settings.mode_limit_Hz, 0.49 / step_s);
  const modal_decimator decimate{settings.low_pass(), step_s, settings.oversampling};
  const auto samples = static_cast<std::size_t>(std::lround(stroke.duration_s * settings.sample_rate_Hz));
  const auto steps = (samples - 1) * static_cast<std::size_t>(settings.oversampling) + 1 + 2 * decimate.reach();
  modal_contact contact{rig, detail::place_of(motion, 0, stroke.position), limit_Hz, step_s};
  modal_take take{.sample_rate_Hz = settings.sample_rate_Hz};
  detail::stroke_steps at_steps{steps};
  law.reset();
  detail::set_out(at_steps, contact, motion, decimate.reach(), stroke.position);
  detail::run_steps(at_steps, take, contact, law, motion, decimate.reach(), step_s);
  detail::sample_steps(take, at_steps, decimate, static_cast<std::size_t>(settings.oversampling));
  if (stroke.account) take.energy = detail::account_of(rig, at_steps, limit_Hz, step_s);
  return take;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
