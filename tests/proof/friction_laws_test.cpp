// SPDX-License-Identifier: MIT
// Which law of friction do strokes follow? 60 random rigs, 20 a law, three strokes each, as a laboratory would have them: the
// right law has to win 57 times. Prints who won against whom, by how much, and how far the parameters are off in standard
// deviations.
#include "law_rigs.hpp"

#include <rosin/diagnose/law_choice.hpp>

#include <doctest/doctest.h>

#include <cstdio>

namespace {

constexpr std::array<const char*, 3> names{"velocity curve", "thermal", "elasto-plastic"};

struct judged_rig {
  std::uint64_t seed = 0;
  double presliding_s = 0, stiffness_1_m = 0, normal_N = 0;
  std::optional<rosin::law_choice> choice{};
  std::string failure{};
};

/// The first rig of this law from the seed on whose three strokes all stick and slip.
judged_rig judge_rig(rosin::contact_law kind, std::uint64_t& seed) {
  for (;; ++seed) {
    const proof::law_rig r = proof::draw_law_rig(kind, seed);
    const auto strokes = proof::play_rig(r);
    if (strokes && strokes->empty()) continue;
    judged_rig out{.seed = seed++, .presliding_s = r.presliding_s, .stiffness_1_m = r.stiffness_1_m};
    if (!strokes) {
      out.failure = strokes.error();
      return out;
    }
    std::vector<rosin::contact_take> takes;
    for (const auto& s : *strokes) takes.push_back(s.take), out.normal_N += s.take.normal_force_N / 3;
    rosin::contact_model model;
    model.torsion = r.declared_torsion;
    auto choice = rosin::choose_friction_law(takes, model);
    if (choice) out.choice = *std::move(choice);
    else out.failure = choice.error();
    return out;
  }
}

std::vector<judged_rig> judge_rigs(rosin::contact_law kind, int rigs) {
  std::vector<judged_rig> out;
  std::uint64_t seed = 1;
  for (int i = 0; i < rigs; ++i) out.push_back(judge_rig(kind, seed));
  return out;
}

/// Estimated less true stiffness per newton, in standard deviations.
double sigmas_off(const judged_rig& r) {
  const auto& s0 = r.choice->laws[2].parameters.front();
  const double per_newton = s0.name == "bristle_stiffness_1_m" ? 1 : r.normal_N;
  return (s0.value / per_newton - r.stiffness_1_m) / (s0.sd / per_newton);
}

void print_rig(std::size_t kind, const judged_rig& r) {
  if (!r.choice) return (void)std::printf("%-14s %2d: %s\n", names[kind], static_cast<int>(r.seed), r.failure.c_str());
  const auto& c = *r.choice;
  std::printf("%-14s %2d: %-14s by %5.0f nats; gain/held out thermal %5.0f/%5.0f, bristles %5.0f/%5.0f; residual %.4f",
              names[kind], static_cast<int>(r.seed), names[static_cast<std::size_t>(c.law)], c.margin, c.laws[1].gain,
              c.laws[1].held_out_gain, c.laws[2].gain, c.laws[2].held_out_gain, c.friction_residual);
  if (kind == 2 && !c.laws[2].parameters.empty()) {
    const auto& s0 = c.laws[2].parameters.front();
    std::printf("; presliding %3.0f us, %s %.4g +- %.2g, true %.4g /m, %+.1f sd", 1e6 * r.presliding_s, s0.name.c_str(), s0.value,
                s0.sd, r.stiffness_1_m, sigmas_off(r));
  }
  std::printf("\n");
}

}  // namespace

TEST_CASE("friction laws on 60 random rigs: the right one wins in at least 57") {
  std::array<std::vector<judged_rig>, 3> judged;
  auto bristles = std::async(std::launch::async, judge_rigs, rosin::contact_law::elasto_plastic, 20);
  judged[0] = judge_rigs(rosin::contact_law::velocity_curve, 20);
  judged[1] = judge_rigs(rosin::contact_law::thermal, 20);
  judged[2] = bristles.get();
  int right = 0;
  std::array<std::array<int, 4>, 3> table{};
  std::vector<double> off;
  for (std::size_t kind = 0; kind < 3; ++kind)
    for (const auto& r : judged[kind]) {
      print_rig(kind, r);
      const std::size_t said = r.choice ? static_cast<std::size_t>(r.choice->law) : 3;
      ++table[kind][said];
      right += said == kind ? 1 : 0;
      if (kind == 2 && said == 2) off.push_back(std::abs(sigmas_off(r)));
    }
  std::printf("%-16s %14s %14s %14s %8s\n", "true law", names[0], names[1], names[2], "none");
  for (std::size_t kind = 0; kind < 3; ++kind)
    std::printf("%-16s %14d %14d %14d %8d\n", names[kind], table[kind][0], table[kind][1], table[kind][2], table[kind][3]);
  const auto within = std::count_if(off.begin(), off.end(), [](double x) { return x < 2; });
  std::printf("right: %d of 60; stiffness of the bristles within 2 sd in %d of %d\n", right, static_cast<int>(within),
              static_cast<int>(off.size()));
  CHECK(right >= 57);
}
