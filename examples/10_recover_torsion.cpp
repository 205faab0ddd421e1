// SPDX-License-Identifier: MIT
//
// The string rolls under the bow, and no transducer sees it. While it sticks, though, its surface moves with the rod: what
// the centre's velocity lacks is torsion. Two strokes recorded at both ends give back how fast torsion travels,
// its impedance and its Q, and then say whether anything else is amiss under the bow.
//
#include <cstdio>
#include <vector>

#include <rosin/diagnose/contact_effects.hpp>
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/reconstruct/reconstructor.hpp>
#include <rosin/simulate/converter.hpp>
#include <rosin/simulate/modal_stroke.hpp>

namespace {

constexpr double position = 0.27;
const rosin::modal_rig rig{.string = {.length_m = 0.314,
                                      .tension_N = 72.5,
                                      .fundamental_Hz = 660,
                                      .bending_stiffness_Nm2 = 4.7e-5,
                                      .loss = {.quality = 1000}},
                           .torsion = {.speed_ratio = 7, .impedance_ratio = 3.5, .quality = 15}};

struct stroke {
  std::vector<double> force, velocity;
};

/// Bows the string, records its ends with 16 bits and 0.4 mN of noise, and goes back from there to the bow.
stroke bow(double speed, double normal, std::uint64_t seed) {
  stroke s;
  const auto take = rosin::simulate_stroke(rig, rosin::velocity_curve{rosin::two_exponential_curve<>{}},
                                           rosin::steady_rod{.speed_m_s = speed, .normal_force_N = normal, .rise_s = 0.005},
                                           {.position = position, .duration_s = 0.1}, {.oversampling = 4});
  if (!take) return s;
  const rosin::converter sensor{.gain = 1, .newtons_per_full_scale = 2, .noise_N = 0.4e-3, .bits = 16};
  rosin::reconstructor<double> reconstruct(rosin::contact_at(rig.string, position), {38400, 57600}, 128e3);
  const auto motion = reconstruct(rosin::convert(take->force_near_N, 128e3, sensor, seed).newtons(),
                                  rosin::convert(take->force_far_N, 128e3, sensor, seed + 1).newtons());
  for (std::size_t i = 0; i < take->size(); ++i)
    s.force.push_back(motion.force_N(i)), s.velocity.push_back(motion.velocity_m_s(i));
  return s;
}

rosin::contact_take take_of(const stroke& s, double speed, double normal) {
  const auto at = rosin::contact_at(rig.string, position);
  rosin::contact_take t;
  t.name = "bow", t.force_N = s.force, t.velocity_m_s = s.velocity, t.rate_Hz = 128e3;
  t.rod_speed_m_s = speed, t.normal_force_N = normal, t.delay_s = at.delay_s, t.impedance_Ns_m = at.impedance_Ns_m;
  t.force_sd_N = 4e-4, t.velocity_sd_m_s = 1.5e-3, t.edge_Hz = 57600;
  return t;
}

}  // namespace

int main() {
  const auto slow = bow(0.16, 0.3, 1), fast = bow(0.22, 0.4, 3);
  const std::vector<rosin::contact_take> takes{take_of(slow, 0.16, 0.3), take_of(fast, 0.22, 0.4)};

  const auto found = rosin::contact_hypotheses(takes, {});  // nothing declared: a string that does not turn
  if (found.hypotheses.empty()) return 1;
  const auto& best = found.hypotheses.front();
  std::printf("most likely left out: %s\n", best.effect.c_str());
  for (const auto& p : best.parameters) std::printf("  %-16s %7.3f +- %.3f\n", p.name.c_str(), p.value, p.sd);
  std::printf("fluctuation while sticking: %.3f of the rod's speed before, %.3f after\n", found.stick_fluctuation,
              best.fluctuation);

  const auto then = rosin::contact_hypotheses(takes, rosin::include({}, best));
  std::printf("with it, the contact is %s\n", then.as_declared ? "as declared" : then.hypotheses.front().effect.c_str());
}
