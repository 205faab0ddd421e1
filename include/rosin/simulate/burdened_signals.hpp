// tier: hosted
// SPDX-License-Identifier: MIT
//
// Takes of a string that carries something, or that ends on something that moves, sampled: the same signals through the same
// low-pass as those of the ideal rig (modal_pluck.hpp, modal_stroke.hpp), so that one may stand in for the other.
//
// A string that moves in two planes, slightly detuned, is two strings (of one tension, where motion adds to it): of a pluck of 1
// N the sensors see 1 / (1 + c) of the one and c / (1 + c) of the other, c = tan(angle of the pluck) tan(angle of the sensors),
// and 1 N in all as long as the wire holds. c does not tell the angles: they are taken to be alike.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/simulate/burdened_sensors.hpp>
#include <rosin/simulate/burdened_take.hpp>
#include <rosin/simulate/modal_pluck.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// What a rig is besides its string.
struct rig_burden {
  string_burden string{};
  sensor_faults sensors{};
  yielding_rod rod{};
  double pluck_width_m = 0, contact_width_m = 0;
  int contact_places = 2;             ///< over which that is spread, the outer ones at its edges
  double detuning = 0, coupling = 0;  ///< of the second plane; plucks only

  /// An ideal rig: nothing of all this.
  [[nodiscard]] bool none() const noexcept {
    const auto& [loads, supports, ends, axial, sensed, stop, clamping] = string;
    const auto& s = sensors;
    bool any = !loads.empty() || axial != 0 || stop.stiffness_N_m > 0 || rod.mass_kg > 0 || pluck_width_m > 0 ||
               contact_width_m > 0 || coupling != 0 || s.crosstalk != 0 || s.skew_s != 0 || s.clock_drift != 0;
    for (std::size_t e = 0; e < 2; ++e)
      any = any || clamping[e] != 0 || supports[e].mass_kg > 0 || !ends[e].modes.empty() || sensed[e] != 0 ||
            s.quadratic_per_N[e] != 0 || s.resonance_Hz[e] > 0;
    return !any;
  }
};

namespace detail {

/// The first thing about a burden that cannot be simulated; empty if nothing.
[[nodiscard]] inline std::string problem_with(const rig_burden& b, const modal_rig& rig, double position) {
  for (const auto& load : b.string.loads)
    if (!(load.position > 0 && load.position < 1)) return "load: its position must lie between 0 and 1";
  for (const auto& support : b.string.supports)
    if (support.mass_kg > 0 && !(support.frequency_Hz > 0 && support.quality > 0))
      return "support: frequency and Q must be above 0";
  for (const auto& end : b.string.ends)
    for (const auto& m : end.modes)
      if (!(m.frequency_Hz > 0 && m.q > 0 && m.per_mass_per_s >= 0))
        return "termination: frequency and Q must be above 0, and no mass negative";
  if (b.string.stop.stiffness_N_m > 0 && !(b.string.stop.position > 0 && b.string.stop.position < 1))
    return "obstacle: its position must lie between 0 and 1";
  for (const auto& [width_m, what] : {std::pair{b.contact_width_m, "contact"}, {b.pluck_width_m, "wire"}})
    if (const double half = width_m / rig.string.length_m / 2; !(width_m >= 0 && half < position && half < 1 - position))
      return std::string{what} + ": wider than the string has room for";
  if (b.contact_places < 2) return "contact: a width needs two places";
  for (const double clamping : b.string.clamping) {
    if (!(clamping >= 0 && clamping <= 1)) return "clamped end: the clamping must lie between 0 and 1";
    if (clamping > 0 &&
        (b.string.axial_stiffness_N > 0 || b.string.sensed_stiffness_N != std::array<double, 2>{} ||
         std::any_of(b.string.supports.begin(), b.string.supports.end(), [](const auto& s) { return s.mass_kg > 0; }) ||
         std::any_of(b.string.ends.begin(), b.string.ends.end(), [](const auto& m) { return !m.modes.empty(); })))
      return "clamped end: not together with ends that move, a tension that motion raises, or a sensor that feels the tension";
  }
  if (!(std::abs(b.sensors.clock_drift) <= 0.01)) return "clock: 0.01 off at most";
  if (!(b.coupling > -1 && b.detuning > -1)) return "second plane: coupling and detuning must be above -1";
  return {};
}

/// Steps so fine that samples fall on them, with those that the low-pass looks at before and after.
struct burdened_steps_of_take {
  double step_s, limit_Hz, lead_s;
  modal_decimator decimate;
  std::size_t samples;

  template <class = void>
  burdened_steps_of_take(const modal_settings& s, double duration_s)
      : step_s{1 / (s.sample_rate_Hz * s.oversampling)}, limit_Hz{std::min(s.mode_limit_Hz, 0.49 / step_s)},
        decimate{s.low_pass(), step_s, s.oversampling}, samples{static_cast<std::size_t>(
                                                            std::lround(duration_s * s.sample_rate_Hz))} {
    lead_s = static_cast<double>(decimate.reach()) * step_s;
    steps_ = (samples - 1) * static_cast<std::size_t>(s.oversampling) + 1 + 2 * decimate.reach();
  }
  /// So long that exactly these steps are taken.
  [[nodiscard]] double duration_s() const noexcept { return (static_cast<double>(steps_) + 0.5) * step_s; }

  template <class = void>
  [[nodiscard]] modal_take sampled(const burdened_steps& all, double rate_Hz) const {
    modal_take take{
        .sample_rate_Hz = rate_Hz, .force_near_N = decimate.points(all.end_N[0]), .force_far_N = decimate.points(all.end_N[1])};
    take.contact_force_N = decimate.lines(all.force_N);
    const auto rate = decimate.slopes(all.force_N);
    take.centre_velocity_m_s = decimate.points(all.centre_m_s);
    add_scaled(take.centre_velocity_m_s, all.centre_left_out_m_N, rate);
    take.torsion_velocity_m_s = all.twist_m_s.empty() ? std::vector<double>(samples, 0.0) : decimate.points(all.twist_m_s);
    add_scaled(take.torsion_velocity_m_s, all.twist_left_out_m_N,
               all.twist_m_s.empty() ? std::vector<double>(samples, 0.0) : rate);
    if (!all.rod_m_s.empty()) take.rod_velocity_m_s = decimate.points(all.rod_m_s);
    if (std::any_of(all.temperature_K.begin(), all.temperature_K.end(), [](double t) { return t != 0; }))
      take.temperature_rise_K = decimate.points(all.temperature_K);
    take.unconverged = all.unconverged, take.slips = all.slips, take.slipping = all.slipping;
    return take;
  }

private:
  std::size_t steps_;
};

/// A pluck in two planes, as the sensors see it.
template <class = void>
[[nodiscard]] burdened_steps step_in_two_planes(const modal_rig& rig, const rig_burden& burden, const burdened_pluck& wire,
                                                const burdened_steps_of_take& how) {
  auto other = rig;
  other.string.fundamental_Hz *= 1 + burden.detuning;
  other.string.tension_N *= std::pow(1 + burden.detuning, 2);
  const bool stretches = burden.string.axial_stiffness_N > 0;  // else both planes are as strong as the sensors' share needs them
  const double c = burden.coupling, along_share = stretches ? 1 / std::sqrt(1 + std::abs(c)) : 1,
               across_share = stretches ? std::sqrt(std::abs(c)) * along_share : 1;
  auto along_wire = wire, across_wire = wire;
  along_wire.force_N *= along_share, across_wire.force_N *= across_share;
  auto [along, across] =
      step_planes(rig, along_wire, other, across_wire, burden.string, how.duration_s(), how.limit_Hz, how.step_s);
  for (std::size_t e = 0; e < 2; ++e)
    for (std::size_t n = 0; n < along.end_N[e].size(); ++n)
      along.end_N[e][n] = (along.end_N[e][n] / along_share + c * across.end_N[e][n] / across_share) / (1 + c);
  for (auto* signal : {&along.force_N, &along.centre_m_s})
    for (double& x : *signal) x /= along_share;
  return std::move(along);
}

}  // namespace detail

/// A pluck of a burdened rig; fails where rig, burden, pluck or settings make no sense.
template <class = void>
[[nodiscard]] outcome<modal_take> simulate_pluck(const modal_rig& rig, const rig_burden& burden, const modal_pluck& pluck,
                                                 const modal_settings& settings = {}) {
  for (const auto& problem :
       {problem_with(rig, pluck.position), problem_with(settings), problem_with_duration(pluck.duration_s, settings),
        detail::problem_with(burden, rig, pluck.position)})
    if (!problem.empty()) return failure{problem};
  if (!(pluck.release_s > 0 && pluck.release_s < pluck.duration_s)) return failure{"pluck: the release must lie within the take"};
  if (!(pluck.release_duration_s >= 0 && pluck.release_duration_s <= 0.1))
    return failure{"pluck: the release must last for 0.1 s at most"};
  const detail::burdened_steps_of_take how{settings, pluck.duration_s};
  // A sudden release falls on a step; how much later it was meant to be, the whole take is.
  const double meant = (pluck.release_s + how.lead_s) / how.step_s,
               stepped = pluck.release_duration_s > 0 ? meant : std::round(meant);
  const burdened_pluck wire{pluck.position, pluck.force_N, stepped * how.step_s, pluck.release_duration_s, burden.pluck_width_m};
  auto steps = burden.coupling != 0 ? detail::step_in_two_planes(rig, burden, wire, how)
                                    : step_pluck(rig, burden.string, wire, how.duration_s(), how.limit_Hz, how.step_s);
  if (meant != stepped)
    for (auto* signal : {&steps.end_N[0], &steps.end_N[1], &steps.force_N, &steps.centre_m_s})
      *signal = detail::read_along(*signal, 1, stepped - meant);
  disturb(steps.end_N, burden.sensors, how.step_s, how.lead_s);
  return how.sampled(steps, settings.sample_rate_Hz);
}
ROSIN_INSTANTIATE(outcome<modal_take> simulate_pluck(const modal_rig&, const rig_burden&, const modal_pluck&,
                                                     const modal_settings&))

/// A stroke of a burdened rig; fails where rig, burden, stroke or settings make no sense.
template <FrictionLaw Law, RodMotion Motion>
[[nodiscard]] outcome<modal_take> simulate_stroke(const modal_rig& rig, const rig_burden& burden, Law law, const Motion& motion,
                                                  modal_stroke stroke = {}, const modal_settings& settings = {}) {
  for (const auto& problem :
       {problem_with(rig, stroke.position), problem_with(settings), problem_with_duration(stroke.duration_s, settings),
        detail::problem_with(burden, rig, stroke.position)})
    if (!problem.empty()) return failure{problem};
  const detail::burdened_steps_of_take how{settings, stroke.duration_s};
  auto steps = step_stroke(rig, burden.string, law, motion, burden.rod, stroke.position, burden.contact_width_m, how.duration_s(),
                           how.limit_Hz, how.step_s, how.decimate.reach(), burden.contact_places);
  disturb(steps.end_N, burden.sensors, how.step_s, how.lead_s);
  return how.sampled(steps, settings.sample_rate_Hz);
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
