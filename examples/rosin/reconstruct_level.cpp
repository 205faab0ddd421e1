// SPDX-License-Identifier: MIT
//
// The mean force that AC-coupled sensors lost.
//
#include "reconstruct_take.hpp"

#include <rosin/diagnose/lost_level.hpp>

namespace tool {

namespace {

/// By the law of friction that the slips of this take follow; nothing where too little slips or they do not tell zero.
std::optional<rosin::dc_estimate> level_by_law(const rosin::rig& rig, const take_reconstruction& r, double rod_m_s) {
  const auto& at = r.result.used.at;
  rosin::contact_take t;
  t.name = r.take, t.force_N = r.force_N, t.velocity_m_s = r.velocity_m_s, t.rate_Hz = r.rate_Hz, t.rod_speed_m_s = rod_m_s,
  t.normal_force_N = *r.normal_force_N;
  t.velocity_near_m_s = r.velocity_near_m_s, t.velocity_far_m_s = r.velocity_far_m_s;
  t.delay_s = at.delay_s, t.stiffness_s2 = at.stiffness_s2, t.impedance_Ns_m = at.impedance_Ns_m, t.edge_Hz = r.limits.stop_Hz;
  const auto middle = (r.known.begin + r.known.end) / 2;
  t.force_sd_N = r.force_sd_N[middle], t.velocity_sd_m_s = r.velocity_sd_m_s[middle];
  t.loss = at.loss;
  rosin::contact_model model;
  if (rig.torsion) model.torsion = rosin::torsion_values{rig.torsion->speed_ratio, rig.torsion->impedance_ratio, rig.torsion->q};
  rosin::follow_start(t, model.torsion);
  if (r.known.end < r.known.begin + 2000 || !(rod_m_s != 0)) return std::nullopt;
  rosin::stick_bench sticks({t}, model);
  if (sticks.records().size() != 1 || !sticks.usable()) return std::nullopt;
  const auto slips = rosin::slip_records(sticks, {t});
  if (slips.front().slips.sample.size() < 400) return std::nullopt;
  const auto found = rosin::find_lost_levels(slips);
  if (found.law != rosin::contact_law::thermal) return std::nullopt;
  return rosin::dc_estimate{found.takes.front().level_N, found.takes.front().sd_N, true};
}

}  // namespace

void estimate_level(const rosin::rig& rig, take_reconstruction& r) {
  if (!r.ac_coupled || r.rod_m_s.empty() || !r.normal_force_N) return;
  const double rod = r.rod_m_s[(r.known.begin + r.known.end) / 2];
  r.dc = rosin::estimate_dc_level(r.force_N, r.velocity_m_s, rod, *r.normal_force_N);
  r.dc_from = "usual-friction";
  if (!r.dc.available) return;
  if (const auto better = level_by_law(rig, r, rod); better && better->sd_N < r.dc.sd_N)
    r.dc = *better, r.dc_from = "thermal-law";
}

}  // namespace tool
