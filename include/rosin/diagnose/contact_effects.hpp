// tier: hosted
// SPDX-License-Identifier: MIT
//
// Which effect of the contact do bowed takes show that the model does not own up to? All that the catalogue knows of the contact
// is tried on the reconstructed force and motion: what shows while the string sticks (contact_stick_effects.hpp), what shows
// while it slips (contact_slip_effects.hpp), what shows in that both ends disagree about the point of contact
// (contact_width.hpp). Effects of one kind are measured on the same samples, counted as the best among them shows how many are
// independent. The contact is as declared where nothing gains clearly, on all takes and on takes predicted from the others. For a
// second effect: include() the first in the model, and ask again.
//
// If sensors or string are not as the calibration holds, the reconstruction is wrong and its two versions disagree. That
// disagreement is taken as a floor of what can be told here; set right first what is wrong there.
//
#pragma once

#include <rosin/core/finite_math.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/contact_as_one.hpp>
#include <rosin/diagnose/contact_bristles.hpp>
#include <rosin/diagnose/contact_slip_effects.hpp>
#include <rosin/diagnose/contact_stick_effects.hpp>
#include <rosin/diagnose/contact_width.hpp>
#include <rosin/diagnose/rod_beside_bristles.hpp>

#include <rosin/core/macros_aside.ipp>

namespace rosin {

struct contact_findings {
  static constexpr double least_needed = 40;       ///< to gain, in nats, where noise is all that speaks against an effect
  static constexpr double of_independent = 0.035;  ///< of the samples, what imperfect models of a contact as declared gain
  /// of what there was, by what is an answer: on rigs of another simulator at most 0.4 where all was named right, 0.8 where not
  static constexpr double most_left = 0.5;
  /// best first: those that stand, then by gain, those without determined parameters last
  std::vector<contact_hypothesis> hypotheses;
  double stick_fluctuation = 0,
         stick_floor = 0;  ///< of the model as declared, and what the reconstruction leaves uncertain; of the rod's speed
  double friction_residual = 0, friction_floor = 0;  ///< the same of the law, as a coefficient of friction
  double independent = 0;                            ///< independent samples that stick
  double threshold = 0;                              ///< gains below it are what imperfect models of a contact as declared gain
  /// the same for tones in time, which a string does not make by itself, and for laws of equal freedom
  double tone_threshold = 0;
  bool as_declared = true;
  bool slips_resolved = true;  ///< slips last long enough in the band for the law's residual to be judged
  std::vector<std::string> warnings;
  std::vector<contact_trace> sticking, slipping;  ///< what the model as declared leaves, of each take

  /// What an effect has to gain, in nats, so that it counts.
  [[nodiscard]] double needed(const contact_hypothesis& h) const {
    if (h.of_samples > 0) return std::max(least_needed, of_independent * h.of_samples);
    if (h.peculiar) return std::min(threshold, least_needed);
    return h.effect.find("ripple") != std::string::npos || h.statistic == "friction-residual" ? tone_threshold : threshold;
  }
  /// The string sticks as well as the reconstruction lets it: torsion is as declared, as far as it shows.
  [[nodiscard]] bool sticks_as_known() const noexcept {
    return stick_floor > 0 && stick_fluctuation <= 1.001 * stick_bench::least_share * stick_floor;
  }
  /// Clearly there, in all takes and in takes predicted from the others.
  [[nodiscard]] bool stands(const contact_hypothesis& h) const {
    return h.decided && h.gain > needed(h) && h.held_out_gain > needed(h) / 2 && !(h.effect == "torsion" && sticks_as_known());
  }
};

/// The statistic that shows several times what noise and imperfect models leave, whether any effect gains or not; empty: none
/// does. `allowance`: so many times more.
[[nodiscard]] inline std::string beyond_doubt(const contact_findings& f, double allowance = 1) {
  constexpr double much_sticking = 1.8, much_slipping = 5;
  if (f.stick_fluctuation > allowance * much_sticking * f.stick_floor) return "stick-fluctuation";
  return f.slips_resolved && f.friction_residual > allowance * much_slipping * f.friction_floor ? "friction-residual" : "";
}

/// What moves while the string sticks, beyond what the reconstruction leaves uncertain.
[[nodiscard]] inline double stick_excess(const contact_findings& f) noexcept {
  return std::sqrt(std::max(0.0, f.stick_fluctuation * f.stick_fluctuation - f.stick_floor * f.stick_floor));
}

/// Whether effects account for what stuck, from what each left in turn: half of what there was (since a width, if one was found:
/// both places are seen much better than one between them), or no more than is uncertain, or a fifth of all that moved at first,
/// which parts of a wide bow do by themselves while they slide.
[[nodiscard]] inline bool accounts_for_sticking(const contact_findings& at_first, const contact_findings& since,
                                                const contact_findings& now) noexcept {
  constexpr double little_left = 0.2;
  return stick_excess(now) < std::max(now.stick_floor, contact_findings::most_left * stick_excess(since)) ||
         now.stick_fluctuation < little_left * at_first.stick_fluctuation;
}

namespace detail {

/// The same independence for all hypotheses on the same samples: that of the likeliest.
inline void common_share(std::vector<contact_hypothesis>& hypotheses, const std::string& statistic) {
  const contact_hypothesis* best = nullptr;
  for (const auto& h : hypotheses)
    if (h.statistic == statistic && (best == nullptr || h.density > best->density)) best = &h;
  if (best == nullptr) return;
  const double share = best->share;
  for (auto& h : hypotheses)
    if (h.statistic == statistic) h.gain = share * h.density, h.held_out_gain = share * h.held_out_density, h.share = share;
}

template <class = void>
[[nodiscard]] contact_hypothesis stick_hypothesis(stick_bench& bench, const std::vector<contact_take>& takes,
                                                  const std::string& effect) {
  if (effect == "torsion") return torsion_hypothesis(bench);
  if (effect == "rod-resonance")
    return bench.model().bristle_stiffness_N_m ? rod_beside_bristles(bench, takes) : rod_hypothesis(bench);
  if (effect == "elasto-plastic-friction") return bristle_hypothesis(bench, takes);
  if (effect == "creep") return creep_hypothesis(bench, takes);
  return speed_ripple_hypothesis(bench);
}

/// The likeliest effect once more with other conventions of torsional damping, which the effect itself may have hidden.
template <class = void>
void reconsider_damping(stick_bench& bench, const std::vector<contact_take>& takes, std::vector<contact_hypothesis>& hypotheses) {
  const auto best =
      std::max_element(hypotheses.begin(), hypotheses.end(), [](const auto& a, const auto& b) { return a.density < b.density; });
  if (best == hypotheses.end() || best->gain < 100 || best->effect == "torsion" || !bench.model().torsion) return;
  if (best->of_samples > 0) return;  // on a bench of its own, with a damping of its own
  const double before = bench.fit().density, held_out = bench.fit().held_out;
  torsion_damping likeliest = bench.damping();
  for (const auto another : {otherwise_shared, otherwise_dispersed}) {
    bench.use_damping(another(likeliest));
    auto other = stick_hypothesis(bench, takes, best->effect);
    other.density += bench.fit().density - before;
    other.held_out_density += bench.fit().held_out - held_out;
    if (other.density > best->density) *best = other, likeliest = bench.damping();
  }
}

template <class = void>
void add_stick_hypotheses(stick_bench& bench, const std::vector<contact_take>& takes, contact_findings& out) {
  if (!bench.usable()) {
    out.warnings.emplace_back(
        "the string hardly sticks to the rod, or is not known to: torsion, rod and steadiness of speed cannot be told");
    return;
  }
  const auto& known = bench.model().included;
  for (const char* effect : {"torsion", "rod-resonance", "elasto-plastic-friction", "creep", "speed-ripple"})
    if (std::find(known.begin(), known.end(), effect) == known.end())
      out.hypotheses.push_back(stick_hypothesis(bench, takes, effect));
  out.stick_fluctuation = bench.fit().solution.scale / bench.speed_m_s();
  out.stick_floor = bench.doubt_m_s() / bench.speed_m_s();
  for (std::size_t t = 0; t < takes.size(); ++t)
    out.sticking.push_back(sticking_trace(bench, bench.declared().rows[t], bench.fit().solution.residual[t], t, takes[t].name));
  out.independent = bench.independent();
  reconsider_damping(bench, takes, out.hypotheses);
  common_share(out.hypotheses, "stick-fluctuation");
}

/// A rod that shakes as a whole ripples speed and normal force at once; of the two the one is meant that takes more of what its own
/// statistic had.
inline void keep_one_ripple(contact_findings& f) {
  const auto find = [&](const char* effect) {
    return std::find_if(f.hypotheses.begin(), f.hypotheses.end(),
                        [&](const auto& h) { return h.effect == effect && f.stands(h) && !h.parameters.empty(); });
  };
  const auto speed = find("speed-ripple"), force = find("normal-force-ripple");
  if (speed == f.hypotheses.end() || force == f.hypotheses.end()) return;
  const auto &a = speed->parameters[0], &b = force->parameters[0];
  if (std::abs(a.value - b.value) > std::max(3 * std::hypot(a.sd, b.sd), 1e-3 * a.value)) return;
  const bool is_speed = speed->fluctuation * f.friction_residual < force->fluctuation * f.stick_fluctuation;
  contact_hypothesis& other = is_speed ? *force : *speed;
  other.decided = false, other.gain = other.held_out_gain = 0;
}

/// Whether slips last nine periods of the band's edge on the average of their samples, in every take: in less, a band-limited
/// force is off any law.
[[nodiscard]] inline bool slips_are_resolved(const slip_bench& bench, const std::vector<contact_take>& takes) {
  for (std::size_t t = 0; t < bench.records().size(); ++t) {
    double sum = 0, squares = 0;
    for (const auto& s : bench.records()[t].phases.slips) {
      const auto length = static_cast<double>(s.end - s.begin);
      sum += length, squares += length * length;
    }
    const double edge_Hz = takes[t].edge_Hz > 0 ? takes[t].edge_Hz : 0.45 * takes[t].rate_Hz;
    if (squares / std::max(1.0, sum) * edge_Hz < 9 * takes[t].rate_Hz) return false;
  }
  return true;
}

/// Where the string slips with hardly any friction although the law has some, the rod has left it: the share of such samples, and
/// the rms of what the law leaves of all.
struct lost_touch {
  double share = 0, left = 0;
};

template <class = void>
[[nodiscard]] lost_touch loses_touch(const stick_rows& rows, const Eigen::VectorXd& residual) {
  constexpr double hardly_any = 0.05, some = 0.15;  // coefficients of friction
  const Eigen::Index n = rows.target.size() - (rows.shared.cols() - 2);
  if (n < 1) return {};
  const auto friction = rows.target.head(n).array(), left = residual.head(n).array();
  const auto gone = friction.abs() < hardly_any && friction - left > some;
  return {static_cast<double>(gone.count()) / static_cast<double>(n), std::sqrt(left.square().mean())};
}
ROSIN_INSTANTIATE(lost_touch loses_touch(const stick_rows&, const Eigen::VectorXd&))

template <class = void>
void add_slip_hypotheses(stick_bench& sticks, const std::vector<contact_take>& takes, contact_findings& out) {
  const slip_bench bench(sticks, takes);
  if (!bench.usable()) {
    out.warnings.emplace_back("too few samples slip, or the normal force is unknown: the law of friction cannot be told");
    return;
  }
  const auto& known = sticks.model().included;
  const auto is_known = [&](const char* effect) { return std::find(known.begin(), known.end(), effect) != known.end(); };
  if (!is_known("normal-force-ripple")) out.hypotheses.push_back(normal_ripple_hypothesis(bench));
  // A contact has one law of friction: that of bristles remembers as well, while they bend.
  if (!is_known("thermal-friction") && !sticks.model().bristle_stiffness_N_m) out.hypotheses.push_back(law_hypothesis(bench));
  out.friction_residual = bench.declared().residual();
  out.friction_floor = bench.floor();
  out.slips_resolved = slips_are_resolved(bench, takes);
  for (std::size_t t = 0; t < takes.size(); ++t) {
    constexpr double seldom = 0.005;
    const lost_touch lost = loses_touch(bench.declared().design.rows[t], bench.declared().fit.solution.residual[t]);
    if (lost.share < seldom) continue;
    out.warnings.push_back(takes[t].name +
                           ": now and then friction is all but gone while the string slips: the rod seems to leave it");
    out.friction_residual = std::max(out.friction_residual, lost.left);  // a robust measure would not see it
  }
  for (std::size_t t = 0; t < takes.size(); ++t)
    out.slipping.push_back(trace_of(bench.declared().design.rows[t].sample, bench.declared().fit.solution.residual[t],
                                    sticks.records()[t].origin(), takes[t].rate_Hz, 1, takes[t].name));
  common_share(out.hypotheses, "friction-residual");
}

}  // namespace detail

/// All hypotheses about the contact, best first. Takes without a rod speed, or of fewer than 500 known samples, are left out.
template <class = void>
[[nodiscard]] contact_findings contact_hypotheses(const std::vector<contact_take>& all, const contact_model& model) {
  contact_findings out;
  std::vector<contact_take> takes;
  for (const auto& t : all) {
    std::size_t known = 0;
    for (std::size_t i = 0; i < std::min(t.force_N.size(), t.velocity_m_s.size()); ++i)
      known += std::isfinite(t.force_N[i]) && std::isfinite(t.velocity_m_s[i]) ? 1U : 0U;
    if (known >= 500 && t.rod_speed_m_s != 0 && t.rate_Hz > 0 && t.impedance_Ns_m > 0) takes.push_back(t);
    else out.warnings.push_back(t.name + ": left out: too short, or its rod's speed or the string's impedance is unknown");
  }
  if (takes.empty()) return out;
  for (auto& t : takes)
    if (model.edge_Hz > 0) t.edge_Hz = std::min(model.edge_Hz, t.edge_Hz > 0 ? t.edge_Hz : model.edge_Hz);
  const auto one = as_one_contact(takes, model);
  if (one) takes = one->takes;
  stick_bench sticks(takes, model);
  const auto& known = model.included;
  if (std::find(known.begin(), known.end(), "finite-contact-width") == known.end())
    if (auto width = width_hypothesis(sticks, takes)) out.hypotheses.push_back(*std::move(width));
  detail::add_stick_hypotheses(sticks, takes, out);
  detail::add_slip_hypotheses(sticks, takes, out);
  out.threshold = std::max(contact_findings::least_needed, contact_findings::of_independent * out.independent);
  out.tone_threshold = std::max(30.0, 0.01 * out.independent);
  detail::keep_one_ripple(out);
  std::stable_sort(out.hypotheses.begin(), out.hypotheses.end(),
                   [](const auto& a, const auto& b) { return a.decided != b.decided ? a.decided : a.gain > b.gain; });
  std::stable_partition(out.hypotheses.begin(), out.hypotheses.end(), [&](const auto& h) { return out.stands(h); });
  out.as_declared = std::none_of(out.hypotheses.begin(), out.hypotheses.end(), [&](const auto& h) { return out.stands(h); });
  return out;
}
ROSIN_INSTANTIATE(contact_findings contact_hypotheses(const std::vector<contact_take>&, const contact_model&))

}  // namespace rosin

#include <rosin/core/macros_back.ipp>
