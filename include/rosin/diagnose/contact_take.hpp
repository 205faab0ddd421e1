// tier: hosted
// SPDX-License-Identifier: MIT
//
// What the diagnosis of the contact works on, and what it says. In: the bowed takes of one rig, reconstructed, and what the rig's
// model declares of the contact. Out: hypotheses, each one effect of the catalogue with its parameters, and by how much the takes
// are likelier with it than without. All gains are in nats and counted in independent samples, so that they can be set
// against each other: of the same data, what was declared is the common measure (gain 0).
//
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/bristle_yield.hpp>
#include <rosin/diagnose/string_side.hpp>
#include <rosin/torsion/torsion_fit.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

/// One bowed take after reconstruction; arrays of one length, NaN at both ends where a sample cannot be known.
struct contact_take {
  std::string name{};
  std::span<const double> force_N{}, velocity_m_s{};                ///< mean of both versions; the string's centre
  std::span<const double> velocity_near_m_s{}, velocity_far_m_s{};  ///< the versions, if there are: how far they can be trusted
  std::span<const double> near_N{},
      far_N{};  ///< calibrated forces on the terminations, if a contact of some width is to be tried
  double rate_Hz = 0;
  double rod_speed_m_s = 0, normal_force_N = 0;  ///< declared; steady
  std::array<double, 2> delay_s{};               ///< transverse travel times to the ends
  std::array<string_side, 2> sides{};            ///< what the string carries and ends on, for the same
  double stiffness_s2 = 0;                       ///< of the transverse waves, for a contact of some width
  loss_law loss{.quality = 1e300};               ///< likewise
  double impedance_Ns_m = 0, length_m = 0;       ///< length 0: unknown
  double force_sd_N = 0, velocity_sd_m_s = 0;    ///< random, of one sample
  std::array<double, 2> noise_N{};               ///< of one sample of near_N, far_N
  double level_sd_N = 0;                         ///< of the force's mean, where AC-coupled sensors lost it; 0: known
  double edge_Hz = 0;                            ///< where the reconstruction's band ends; 0: 0.45 of the rate
  double start_s = stick_take::usual_start_s;    ///< until the stroke is steady
  rod_approach approach{};                       ///< to that speed, where it is slower still
  double stretch = 0;                            ///< by which the stroke itself raises the tension, relatively

  /// At the tension at rest: torsion, which feels none, is declared relatively to these.
  [[nodiscard]] std::array<double, 2> rest_delay_s() const noexcept {
    const double slower = std::sqrt(1 + stretch);
    return {delay_s[0] * slower, delay_s[1] * slower};
  }
  [[nodiscard]] double rest_impedance_Ns_m() const noexcept { return impedance_Ns_m / std::sqrt(1 + stretch); }
};

/// The velocity of the string's surface at the contact, as torsion under the force has it; where that is not known, of the centre.
[[nodiscard]] inline std::vector<double> surface_m_s(const contact_take& t, const std::optional<torsion_values>& torsion) {
  std::vector<double> out(t.velocity_m_s.begin(), t.velocity_m_s.end());
  if (!torsion || t.force_N.size() != out.size()) return out;
  const auto is_known = [](double force_N) { return std::isfinite(force_N); };
  const auto begin = std::find_if(t.force_N.begin(), t.force_N.end(), is_known),
             end = std::find_if_not(begin, t.force_N.end(), is_known);
  const auto guide =
      torsion_of(t.rest_delay_s(), t.rest_impedance_Ns_m(), torsion->speed_ratio, torsion->impedance_ratio, torsion->q);
  const auto rolling = torsion_velocity(guide, std::span(begin, end), t.rate_Hz);
  const auto first = static_cast<std::size_t>(begin - t.force_N.begin());
  for (std::size_t i = 0; i < rolling.size(); ++i) out[first + i] += rolling[i];
  return out;
}

/// A bow that is set on late, or taken off before the end: without the periods in which hardly a force is there at either end.
inline void leave_out_silence(contact_take& t) {
  constexpr double hardly = 0.2, surely = 6, sure = 12, least_periods = 3;  // of the force's rms; of its noise
  double power = 0, count = 0;
  for (const double f : t.force_N)
    if (std::isfinite(f)) power += f * f, count += 1;
  const double rms = count > 0 ? std::sqrt(power / count) : 0, period = 2 * (t.delay_s[0] + t.delay_s[1]) * t.rate_Hz;
  if (!(rms > sure * t.force_sd_N)) return;
  const double least_N = std::max(hardly * rms, surely * t.force_sd_N);
  const auto acts = [&](double f) { return std::abs(f) > least_N; };
  const auto first = std::find_if(t.force_N.begin(), t.force_N.end(), acts);
  const auto last = std::find_if(t.force_N.rbegin(), t.force_N.rend(), acts).base();
  if (static_cast<double>(first - t.force_N.begin()) > least_periods * period)
    t.start_s += static_cast<double>(first - t.force_N.begin()) / t.rate_Hz;
  if (!(static_cast<double>(t.force_N.end() - last) > least_periods * period)) return;
  const auto kept = static_cast<std::size_t>(last - t.force_N.begin());
  for (auto* x : {&t.force_N, &t.velocity_m_s, &t.velocity_near_m_s, &t.velocity_far_m_s, &t.near_N, &t.far_N})
    *x = x->first(std::min(kept, x->size()));
}

/// Finds how a stroke's rod approaches its speed, and until when too much of that is missing to count; nothing changes where the rod
/// is as fast as declared by start_s. What sticks to the rod is the surface: the centre's median rises besides while a string settles.
template <class = void>
void follow_start(contact_take& t, const std::optional<torsion_values>& torsion = {}) {
  constexpr double missing = 0.1;
  const double period_s = 2 * (t.delay_s[0] + t.delay_s[1]);
  t.approach = find_rod_approach(surface_m_s(t, torsion), t.rate_Hz, period_s, t.rod_speed_m_s, t.start_s);
  t.start_s = std::max(t.start_s, t.approach.within_s(missing));
}
ROSIN_INSTANTIATE(void follow_start(contact_take&, const std::optional<torsion_values>&))

enum class contact_law { velocity_curve, thermal, elasto_plastic };

/// What is taken for granted of the contact; effects that were found are added by include().
struct contact_model {
  std::optional<torsion_values> torsion{};
  Eigen::Vector3d torsion_tolerance{0.002, 0.01, 0.03};  ///< relative sd of declared speed, impedance and q
  contact_law law = contact_law::velocity_curve;
  std::vector<std::string> included{};         ///< effects found before and kept
  std::optional<std::array<double, 3>> rod{};  ///< frequency (Hz), q, mass (kg) of a rod that resonates
  std::optional<double> bristle_stiffness_N_m{}, bristle_delay_s{};
  bristle_yield yields{};
  std::optional<double> speed_ripple_Hz{}, normal_ripple_Hz{};
  std::optional<double> creep_sharpness{};
  std::optional<std::array<double, 2>> heat{};  ///< layer (m) and area per newton (m^2) of a contact that remembers heat
  double width_s = 0;                           ///< travel time of transverse waves over a contact of some width; 0: a point
  double edge_Hz = 0;                           ///< beyond it noise takes over what is included; 0: nowhere
};

/// By how much the contact's parameters come out wrong beside what noise does, as a share of each: what band, gains and torsion
/// leave in a reconstruction. Found on strokes of another simulator (rosin challenge), where noise alone would have given a tenth
/// of it. A rod's mass has the tension's doubt besides, which the velocity goes with; and noise that stands in the force that drives
/// it scatters what is found by rod_scatter times what a regression says.
namespace contact_faults {
inline constexpr double rod_frequency = 6e-4, rod_q = 0.012, rod_mass = 0.0164, rod_scatter = 1.5, ripple = 0.0135,
                        slip_tone = 7e-5, bristles = 0.035, creep = 0.1;
/// Of a rod under bristles, whose flow is followed to first order only.
inline constexpr double bristly_rod_frequency = 2e-3, bristly_rod_q = 0.12, bristly_rod_mass = 0.07;
}  // namespace contact_faults

struct contact_parameter {
  std::string name;  ///< as in the catalogue
  double value = 0, sd = 0;
  [[nodiscard]] std::array<double, 2> ci95() const noexcept { return {value - 1.96 * sd, value + 1.96 * sd}; }
};

/// What a model leaves of one take at the samples that it speaks of: of the rod's speed, or as a coefficient of friction.
struct contact_trace {
  std::string take;
  std::vector<double> time_s, left;  ///< time in the take
};

struct contact_hypothesis {
  std::string effect;  ///< name in the catalogue
  std::vector<contact_parameter> parameters{};
  double gain = 0;           ///< log-likelihood of all takes over that of the model as declared, nats
  double held_out_gain = 0;  ///< of each take predicted from the others (or half from half), nats
  int free_parameters = 0;
  double density = 0, held_out_density = 0,
         share = 1;         ///< sums of log densities over the declared model's, and independent rows / rows
  double fluctuation = 0;   ///< what is left of the statistic: relative to the rod's speed, or to the force
  double noise = 0;         ///< what the sensors' noise alone leaves of it, where that differs from the findings' floor; else 0
  double edge_Hz = 0;       ///< band that its parameters are from, where that is narrower than the takes'; else 0
  double width_s = 0;       ///< travel time over the width, where that is the effect
  double of_samples = 0;    ///< independent samples that it was told from, where these are not the findings'; else 0
  std::string statistic{};  ///< begins with "stick-fluctuation" or "friction-residual"
  bool decided = true;      ///< the parameters are determined
  bool peculiar = false;    ///< imperfect models of a contact as declared do not look like it
  std::vector<contact_trace> before{}, after{};  ///< where that is not what the findings show of the models with and without it

  /// Gain less half a logarithm of the independent samples for each parameter (Schwarz).
  [[nodiscard]] double evidence(double independent) const noexcept {
    return gain - 0.5 * free_parameters * std::log(std::max(1.0, independent));
  }
};

/// The model with an effect that was found.
[[nodiscard]] inline contact_model include(contact_model model, const contact_hypothesis& found) {
  const auto value = [&](const char* name) -> double {
    for (const auto& p : found.parameters)
      if (p.name == name) return p.value;
    return 0;
  };
  model.included.push_back(found.effect);
  if (found.edge_Hz > 0) model.edge_Hz = found.edge_Hz;
  if (found.width_s > 0) model.width_s = found.width_s;
  if (found.effect == "torsion") model.torsion = torsion_values{value("speed_ratio"), value("impedance_ratio"), value("q")};
  if (found.effect == "rod-resonance") model.rod = {value("frequency_Hz"), value("q"), value("mass_kg")};
  if (found.effect == "elasto-plastic-friction") {
    model.bristle_stiffness_N_m = value("bristle_stiffness_N_m"), model.bristle_delay_s = value("bristle_delay_s");
    model.yields.limit = value("friction_limit"), model.yields.weakening_s_m = value("weakening_s_m");
    if (value("elastic_share") > 0) model.yields.elastic = value("elastic_share");
  }
  if (found.effect == "creep") model.creep_sharpness = value("sharpness");
  if (found.effect == "speed-ripple") model.speed_ripple_Hz = value("frequency_Hz");
  if (found.effect == "normal-force-ripple") model.normal_ripple_Hz = value("frequency_Hz");
  if (found.effect == "thermal-friction") {
    model.law = contact_law::thermal;
    if (value("layer_m") > 0) model.heat = {value("layer_m"), value("area_per_newton_m2")};
  }
  return model;
}

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
