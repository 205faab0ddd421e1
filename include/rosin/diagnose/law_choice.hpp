// tier: hosted
// SPDX-License-Identifier: MIT
//
// Which law of friction do reconstructed strokes follow: a curve of the slip speed, the contact's temperature, or bristles that
// bend before they give way? None of them runs freely: each is driven by the reconstructed motion and asked, through the window
// that the data went through, for what the contact does.
//
//     velocity curve   while it sticks the surface moves with the rod; while it slips f = N mu(|v_r|)
//     thermal          the same while it sticks; while it slips f = N mu(Theta), Theta what the slips so far have left
//     elasto-plastic   while it sticks v_r = -(s / (s0 (1 + s d))) f; while it slips f = N mu(|v_r|)
//
// All are measured on the same samples, against the curve: nats of independent samples, of all takes and of each take as
// predicted from the others. What shows bristles is the sticking, not the slip: they settle within mu N / s0, tens of micrometres, of
// which a slip has hundreds. s0 is tried as one number and in proportion to the normal force.
//
#pragma once

#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/contact_bristles.hpp>
#include <rosin/diagnose/contact_slip_effects.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct law_verdict {
  contact_law law = contact_law::velocity_curve;
  double gain = 0, held_out_gain = 0;  ///< over the velocity curve, nats; held out: each take predicted from the others
  double needed = 0;                   ///< gains below it are what imperfect models gain
  bool possible = true;                ///< its parameters are determined by these takes
  std::vector<contact_parameter> parameters{};

  [[nodiscard]] bool counts() const noexcept { return possible && gain > needed && held_out_gain > needed / 2; }
};

struct law_choice {
  contact_law law = contact_law::velocity_curve;
  std::array<law_verdict, 3> laws{};  ///< in the order of contact_law
  /// held-out nats by which the next best predicts worse; below 0: it predicts better, but not by what counts
  double margin = 0;
  double friction_residual = 0;  ///< of the velocity curve, as a coefficient of friction
};

namespace detail {

/// Compliance of each take against that at the takes' mean normal force, if stiffness goes with the normal force.
[[nodiscard]] inline std::vector<double> softer_by_force(const std::vector<contact_take>& takes) {
  double mean = 0;
  for (const auto& t : takes) mean += t.normal_force_N / static_cast<double>(takes.size());
  std::vector<double> out;
  for (const auto& t : takes) out.push_back(mean / t.normal_force_N);
  return out;
}

/// Bristles with stiffness in common, or in proportion to the normal force where that is likelier: then stated per newton.
template <class = void>
[[nodiscard]] law_verdict bristle_verdict(stick_bench& sticks, const std::vector<contact_take>& takes) {
  law_verdict v{.law = contact_law::elasto_plastic, .needed = std::max(40.0, 0.035 * sticks.independent()), .possible = false};
  if (!sticks.usable()) return v;
  auto alike = bristle_hypothesis(sticks);
  const auto softer = softer_by_force(takes);
  auto with_force = bristle_hypothesis(sticks, softer);
  const bool proportional = with_force.gain > alike.gain;
  auto& best = proportional ? with_force : alike;
  if (proportional && !best.parameters.empty()) {
    const double mean = softer.front() * takes.front().normal_force_N;
    auto& s0 = best.parameters.front();
    s0.name = "bristle_stiffness_1_m", s0.value /= mean, s0.sd /= mean;
  }
  v.gain = best.gain, v.held_out_gain = best.held_out_gain, v.possible = best.decided, v.parameters = std::move(best.parameters);
  return v;
}

template <class = void>
[[nodiscard]] law_verdict thermal_verdict(const slip_bench& slips, double needed) {
  auto h = law_hypothesis(slips);
  return {contact_law::thermal, h.gain, h.held_out_gain, needed, h.decided, std::move(h.parameters)};
}

}  // namespace detail

/// Sets the three laws against each other. `model.law` does not matter. Fails where too little slips.
template <class = void>
[[nodiscard]] outcome<law_choice> choose_friction_law(const std::vector<contact_take>& takes, contact_model model) {
  for (const auto& t : takes)
    if (t.rod_speed_m_s == 0 || !(t.normal_force_N > 0))
      return failure{t.name + ": law of friction: the rod's speed and the normal force have to be known"};
  model.law = contact_law::velocity_curve;
  stick_bench sticks(takes, model);
  if (sticks.records().size() != takes.size() || takes.empty())
    return failure{"law of friction: there is no stroke, or one of fewer than 500 known samples"};
  const slip_bench slips(sticks, takes);
  if (!slips.usable()) return failure{"law of friction: fewer than 100 samples of a stroke slip clear of sticking"};
  law_choice out;
  out.friction_residual = slips.declared().residual();
  out.laws[1] = detail::thermal_verdict(slips, std::max(30.0, 0.01 * sticks.independent()));
  out.laws[2] = detail::bristle_verdict(sticks, takes);
  const auto score = [](const law_verdict& v) {
    return v.law == contact_law::velocity_curve ? 0.0 : v.counts() ? v.held_out_gain : std::min(0.0, v.held_out_gain);
  };
  std::array<double, 3> scores{};
  for (std::size_t i = 0; i < 3; ++i) scores[i] = score(out.laws[i]);
  const auto best = static_cast<std::size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
  out.law = out.laws[best].law;
  double next = -1e300;
  for (std::size_t i = 0; i < 3; ++i)
    if (i != best) next = std::max(next, i == 0 ? 0.0 : out.laws[i].held_out_gain);
  out.margin = scores[best] - next;
  return out;
}
ROSIN_INSTANTIATE(outcome<law_choice> choose_friction_law(const std::vector<contact_take>&, contact_model))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
