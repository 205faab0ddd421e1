// SPDX-License-Identifier: MIT
//
// What is hidden on request only: what a seed has always drawn it still draws.
//
#include "challenge_rig.hpp"

#include <algorithm>
#include <functional>

namespace tool {

namespace {

/// Under an end, a string of another pitch: weights as behind a stiff support.
hidden_effect another_string(challenge_rig& r, rosin::gaussian_source& s, double k) {
  constexpr double highest_Hz = 60e3;
  const std::size_t e = side(s);
  const double pitch = evenly_in_log(s, 0.35, 0.9) * r.base.rig.string.fundamental_Hz, q = evenly_in_log(s, 500, 1500),
               stiff = evenly_in_log(s, 1e-5, 6e-5), per_mass = k * evenly_in_log(s, 0.02, 0.06);
  for (int n = 1; n * pitch < highest_Hz; ++n)
    r.burden.ends[e].modes.push_back({n * pitch * std::sqrt((1 + stiff * n * n) / (1 + stiff)), q, per_mass * n * n});
  return {{}, name_of_side(e), "", {{"frequency_Hz", pitch}, {"q", q}}};
}

/// Beside the string, where it swings over to: only the strongest pluck gets there.
hidden_effect beside_the_string(challenge_rig& r, rosin::gaussian_source& s, double k) {
  const double x = place(s, r), p = r.base.position,
               per_newton =
                   std::min(p, 1 - x) * (1 - std::max(p, 1 - x)) * r.base.rig.string.length_m / r.base.rig.string.tension_N;
  std::array<double, 3> force{};
  for (std::size_t i = 0; i < force.size(); ++i) force[i] = r.base.plucks[i].force_N;
  std::sort(force.begin(), force.end());
  const double gap = -per_newton * (force[2] - k * s.uniform(0.1, 0.4) * (force[2] - force[1]));
  r.burden.stop = {x, gap, 3e5};
  return {{}, "", "", {{"position", x}, {"gap_m", -gap}}};
}

/// One end that does not let the string turn, or both alike.
hidden_effect held_against_turning(challenge_rig& r, rosin::gaussian_source& s, double k) {
  const std::size_t e = side(s);
  const bool both = s.uniform() < 0.5;
  const double clamping = std::min(1.0, k * s.uniform(0.4, 1.2));
  r.burden.clamping[e] = clamping;
  if (both) r.burden.clamping[1 - e] = clamping;
  return {{}, both ? "both" : name_of_side(e), "", {{"clamping", clamping}}};
}

/// An end on something soft that swallows what comes: rubber under the bridge.
hidden_effect damped_end(challenge_rig& r, rosin::gaussian_source& s, double k) {
  const std::size_t e = side(s);
  const double z = r.base.rig.string.impedance_Ns_m(), conductance = k * evenly_in_log(s, 3e-4, 1e-2),
               corner = evenly_in_log(s, 5, 60);
  r.burden.ends[e].modes.push_back(rosin::overdamped_mode(conductance, corner, 1e6));
  return {{}, name_of_side(e), "", {{"resistance_Ns_m", z / conductance}, {"corner_Hz", corner}}};
}

/// An end that is heavy and softly held: it moves as a mass does at all of the string's partials.
hidden_effect heavy_end(challenge_rig& r, rosin::gaussian_source& s, double k) {
  const std::size_t e = side(s);
  r.burden.supports[e] = {evenly_in_log(s, 0.02, 0.2) / k, evenly_in_log(s, 40, 0.5 * r.base.rig.string.fundamental_Hz),
                          s.uniform(8, 35)};
  return {"support-resonance",
          name_of_side(e),
          "",
          {{"frequency_Hz", r.burden.supports[e].frequency_Hz},
           {"q", r.burden.supports[e].quality},
           {"mass_kg", r.burden.supports[e].mass_kg}}};
}

/// Of the air's boundary layer.
hidden_effect in_air(challenge_rig& r, rosin::gaussian_source& s, double k) {
  const double loss = k * evenly_in_log(s, 2e-3, 1e-2);
  r.base.rig.string.loss.air_sqrt_Hz = r.bowed.string.loss.air_sqrt_Hz = loss;
  return {{}, "", "", {{"loss_air_sqrt_Hz", loss}}};
}

hidden_effect wide_wire(challenge_rig& r, rosin::gaussian_source& s, double k) {
  r.pluck_width_m = std::sqrt(k) * evenly_in_log(s, 1e-3, 5e-3);
  return {{}, "", "", {{"width_m", r.pluck_width_m}}};
}

/// One pluck is made where nobody meant it to be.
hidden_effect plucked_elsewhere(challenge_rig& r, rosin::gaussian_source& s, double k) {
  auto& pluck = r.base.plucks[std::min<std::size_t>(2, static_cast<std::size_t>(3 * s.uniform()))];
  const double by = k * s.uniform(0.03, 0.07);
  pluck.position += pluck.position > 0.25 ? -by : by;
  return {{}, "", "", {{"position", pluck.position}}};
}

/// A transducer that is not square to the string reads a share of its tension.
hidden_effect felt_tension(challenge_rig& r, rosin::gaussian_source& s, double k) {
  const std::size_t c = side(s);
  r.burden.sensed_stiffness_N[c] = k * with_sign(s, evenly_in_log(s, 300, 3000));
  return {{}, "", name_of_side(c), {{"sensed_axial_stiffness_N", r.burden.sensed_stiffness_N[c]}}};
}

hidden_effect two_clocks(challenge_rig& r, rosin::gaussian_source& s, double k) {
  r.faults.clock_drift = k * with_sign(s, evenly_in_log(s, 5e-6, 1e-4));
  return {{}, "", "", {{"relative", r.faults.clock_drift}}};
}

hidden_effect cut_out(challenge_rig& r, rosin::gaussian_source& s, double) {
  r.lost = {std::min<std::size_t>(2, static_cast<std::size_t>(3 * s.uniform())),
            static_cast<std::size_t>(128000 * s.uniform(0.03, 0.08)), static_cast<std::size_t>(evenly_in_log(s, 3, 60))};
  return {{}, "", "", {{"samples", static_cast<double>(r.lost.count)}, {"time_s", static_cast<double>(r.lost.first) / 128000}}};
}

hidden_effect creeping(challenge_rig& r, rosin::gaussian_source& s, double k) {
  r.creeps = {k * evenly_in_log(s, 1e-2, 4e-2), s.uniform(0.15, 0.4)};
  const double a = r.creeps->sharpness, limit = r.base.steady_friction(0).value;
  return {{}, "", "", {{"speed_at_normal_force_m_s", r.creeps->limit_speed_m_s * std::exp((1 - limit) / a)}, {"sharpness", a}}};
}

const std::map<std::string, std::function<hidden_effect(challenge_rig&, rosin::gaussian_source&, double)>>& requests() {
  static const std::map<std::string, std::function<hidden_effect(challenge_rig&, rosin::gaussian_source&, double)>> all{
      {"air-loss", in_air},
      {"clamped-end", held_against_turning},
      {"clock-drift", two_clocks},
      {"creep", creeping},
      {"dropouts", cut_out},
      {"finite-pluck-width", wide_wire},
      {"massive-end", heavy_end},
      {"phantom-partials", felt_tension},
      {"pluck-position", plucked_elsewhere},
      {"rattle", beside_the_string},
      {"resistive-end", damped_end},
      {"sympathetic-string", another_string}};
  return all;
}

}  // namespace

const std::vector<std::string>& hideable_on_request() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const auto& [name, hide] : requests()) out.push_back(name);
    return out;
  }();
  return names;
}

std::optional<hidden_effect> hidden_on_request(const std::string& name, challenge_rig& rig, rosin::gaussian_source& from,
                                               double strength) {
  const auto found = requests().find(name);
  if (found == requests().end()) return std::nullopt;
  auto out = found->second(rig, from, strength);
  if (out.name.empty()) out.name = name;
  return out;
}

}  // namespace tool
