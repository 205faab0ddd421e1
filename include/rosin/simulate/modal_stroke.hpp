// tier: hosted
// SPDX-License-Identifier: MIT
//
// A stroke of the rod: string at rest, rod set in motion, and in each step the law of friction finds the force on the
// load line that the modes offer. Any law (concept FrictionLaw), any motion of the rod (concept RodMotion).
//
#pragma once

#include <algorithm>
#include <utility>

#include <rosin/core/outcome.hpp>
#include <rosin/simulate/modal_contact.hpp>
#include <rosin/simulate/modal_decimator.hpp>

namespace rosin {

/// How the rod moves and presses: a function of time.
template <class M>
concept RodMotion = std::copyable<M> && requires(const M& motion, double t) {
  { motion(t) }
  noexcept->std::same_as<rod_state>;
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
};

namespace detail {

/// Everything at every step of the simulation.
struct stroke_steps {
  std::vector<double> near, far, centre, torsion, force, rod, temperature;

  explicit stroke_steps(std::size_t size) {
    for (auto* s : {&near, &far, &centre, &torsion, &force, &rod, &temperature}) s->assign(size, 0.0);
  }
};

template <class Law, class Motion>
void run_steps(stroke_steps& s, modal_take& take, modal_contact& contact, Law& law, const Motion& motion, std::size_t first,
               double step_s) {
  std::size_t slipped = 0;
  bool before = false;
  for (std::size_t i = first; i < s.force.size(); ++i) {
    const rod_state rod = motion(static_cast<double>(i - first) * step_s);
    const auto answer = law(contact.line(rod));
    const auto state = contact.apply(answer.force_N);
    s.near[i] = state.near_N, s.far[i] = state.far_N, s.centre[i] = state.centre_m_s, s.torsion[i] = state.torsion_m_s;
    s.force[i] = answer.force_N, s.rod[i] = rod.velocity_m_s, s.temperature[i] = answer.temperature_rise_K;
    take.unconverged += answer.converged ? 0U : 1U;
    take.slips += answer.slipping && !before ? 1U : 0U;
    before = answer.slipping;
    slipped += before && i > s.force.size() / 2 ? 1U : 0U;
  }
  take.slipping = static_cast<double>(slipped) / static_cast<double>(s.force.size() - s.force.size() / 2);
}

inline void add_scaled(std::vector<double>& to, double factor, const std::vector<double>& from) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
}

/// All signals through the low-pass, and into them what the modes left out contribute.
inline void sample_steps(modal_take& take, const stroke_steps& s, const modal_decimator& decimate, const modes_left_out& rest) {
  take.contact_force_N = decimate.lines(s.force);
  const auto rate = decimate.slopes(s.force);
  take.force_near_N = decimate.points(s.near);
  take.force_far_N = decimate.points(s.far);
  take.centre_velocity_m_s = decimate.points(s.centre);
  take.torsion_velocity_m_s = decimate.points(s.torsion);
  add_scaled(take.force_near_N, rest.near, take.contact_force_N);
  add_scaled(take.force_far_N, rest.far, take.contact_force_N);
  add_scaled(take.centre_velocity_m_s, rest.centre_m_N, rate);
  add_scaled(take.torsion_velocity_m_s, rest.torsion_m_N, rate);
  take.rod_velocity_m_s = decimate.points(s.rod);
  const bool warm = std::any_of(s.temperature.begin(), s.temperature.end(), [](double t) { return t != 0; });
  if (warm) take.temperature_rise_K = decimate.points(s.temperature);
}

}  // namespace detail

/// Simulates a stroke; fails where rig, stroke or settings make no sense.
template <FrictionLaw Law, RodMotion Motion = steady_rod>
[[nodiscard]] outcome<modal_take> simulate_stroke(const modal_rig& rig, Law law, Motion motion = {}, modal_stroke stroke = {},
                                                  const modal_settings& settings = {}) {
  for (const auto& problem :
       {problem_with(rig, stroke.position), problem_with(settings), problem_with_duration(stroke.duration_s, settings)})
    if (!problem.empty()) return failure{problem};
  const double step_s = 1 / (settings.sample_rate_Hz * settings.oversampling);
  const double limit_Hz = std::min(settings.mode_limit_Hz, 0.49 / step_s);
  const modal_decimator decimate{settings.low_pass(), step_s, settings.oversampling};
  const auto samples = static_cast<std::size_t>(std::lround(stroke.duration_s * settings.sample_rate_Hz));
  const auto steps = (samples - 1) * static_cast<std::size_t>(settings.oversampling) + 1 + 2 * decimate.reach();
  modal_contact contact{rig, stroke.position, limit_Hz, step_s};
  modal_take take{.sample_rate_Hz = settings.sample_rate_Hz};
  detail::stroke_steps at_steps{steps};
  law.reset();
  detail::run_steps(at_steps, take, contact, law, motion, decimate.reach(), step_s);
  detail::sample_steps(take, at_steps, decimate, contact.left_out());
  return take;
}

}  // namespace rosin
