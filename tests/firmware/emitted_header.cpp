// SPDX-License-Identifier: MIT
//
// Two emitted headers against the design they came from, all bits. at and gain (numbers.hpp) are the calibration file's.
//
#include "near.hpp"
#include "rig.hpp"

#include <rosin/reconstruct/passage_design.hpp>

#include <cstdio>
#include <cstring>

#include "numbers.hpp"

namespace {

template <class T, std::size_t Taps, std::size_t Line, std::size_t Short>
bool same(const char* name, const rosin::passage_reconstructor<T, Taps, Line, Short>&,
          const rosin::passage_coefficients<T, Taps, Short>& emitted, const rosin::passage_plan& plan) {
  const auto designed = rosin::fixed_size<T, Taps, Line, Short>(plan);
  if (!designed) return std::printf("%s: %s\n", name, designed.error().c_str()), false;
  const auto differ = [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) != 0; };
  int wrong = differ(designed->admittance, emitted.admittance) + differ(designed->near_field, emitted.near_field);
  wrong += (designed->latency != emitted.latency) + (designed->reach != emitted.reach) + (designed->version != emitted.version);
  for (std::size_t p = 0; p < 4; ++p) {
    const auto &a = designed->passage[p], &b = emitted.passage[p];
    wrong += differ(a.taps, b.taps) + (a.count != b.count) + (a.newest_age != b.newest_age);
  }
  std::printf("%s: %zu + %zu + %zu + %zu taps, %d parts differ\n", name, emitted.passage[0].count, emitted.passage[1].count,
              emitted.passage[2].count, emitted.passage[3].count, wrong);
  return wrong == 0;
}

rosin::passage_plan plan(double rate_Hz, double error, rosin::bow_version version) {
  rosin::bow_point string = at;
  string.stiffness_s2 = std::max(string.stiffness_s2, 0.0);
  return rosin::plan_passages(string, gain, {0.30 * rate_Hz, 0.45 * rate_Hz}, rate_Hz, error, version);
}

}  // namespace

int main() {
  static_assert(rig::sample_rate_Hz == 48000 && near::sample_rate_Hz == 96000);
  const bool float_same =
      same("rig.hpp", rig::reconstructor{rig::coefficients}, rig::coefficients, plan(48000, 1e-3, rosin::bow_version::both));
  const bool double_same =
      same("near.hpp", near::reconstructor{near::coefficients}, near::coefficients, plan(96000, 0.01, rosin::bow_version::near));
  return float_same && double_same ? 0 : 1;
}
