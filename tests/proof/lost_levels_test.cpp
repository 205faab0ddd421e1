// SPDX-License-Identifier: MIT
// The level of the force behind AC-coupled sensors, from the law of friction that the strokes follow: 30 random rigs, three
// strokes each, sensors with a corner at 2 Hz. Prints errors as friction coefficients and in standard deviations.
#include "law_rigs.hpp"

#include <rosin/diagnose/lost_level.hpp>

#include <doctest/doctest.h>

#include <cstdio>

namespace {

struct judged_level {
  std::uint64_t seed = 0;
  bool heat_told = false;
  double error = 0, sd = 0, apart = 0;  ///< mean of three strokes; largest difference between them; as friction coefficients
};

judged_level judge_level(rosin::contact_law kind, std::uint64_t& seed) {
  for (;; ++seed) {
    const proof::law_rig r = proof::draw_law_rig(kind, seed);
    auto strokes = proof::play_rig(r, 2.0);
    if (!strokes || strokes->empty()) continue;
    std::vector<rosin::contact_take> takes;
    for (const auto& s : *strokes) takes.push_back(s.take);
    rosin::contact_model model;
    model.torsion = r.declared_torsion;
    rosin::stick_bench sticks(takes, model);
    const auto found = rosin::find_lost_levels(rosin::slip_records(sticks, takes));
    judged_level out{.seed = seed++, .heat_told = found.law == rosin::contact_law::thermal, .sd = found.common_sd};
    std::array<double, 3> error{};
    for (std::size_t t = 0; t < 3; ++t) {
      double mean = 0, count = 0;
      for (const double f : (*strokes)[t].force)
        if (std::isfinite(f)) mean += f, ++count;
      error[t] = (found.takes[t].level_N + mean / count - (*strokes)[t].true_mean_N) / takes[t].normal_force_N;
      out.error += error[t] / 3;
    }
    out.apart = *std::max_element(error.begin(), error.end()) - *std::min_element(error.begin(), error.end());
    return out;
  }
}

}  // namespace

TEST_CASE("levels lost to AC coupling, on 30 random rigs: errors as large as stated") {
  int within = 0, told = 0;  // told: heat that is not there
  for (const auto kind : {rosin::contact_law::velocity_curve, rosin::contact_law::thermal, rosin::contact_law::elasto_plastic}) {
    std::uint64_t seed = 1;
    for (int i = 0; i < 10; ++i) {
      const auto r = judge_level(kind, seed);
      std::printf("law %d, rig %2d: %s; off by %+.3f +- %.3f (%+.1f sd), strokes apart by %.3f\n", static_cast<int>(kind),
                  static_cast<int>(r.seed), r.heat_told ? "heat knows zero" : "usual friction", r.error, r.sd, r.error / r.sd,
                  r.apart);
      within += std::abs(r.error) < 2 * r.sd ? 1 : 0;
      told += r.heat_told && kind != rosin::contact_law::thermal ? 1 : 0;
    }
  }
  std::printf("within 2 sd: %d of 30; heat where there is none: %d\n", within, told);
  CHECK(within >= 26);
  CHECK(told == 0);
}
