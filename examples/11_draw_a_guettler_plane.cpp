// SPDX-License-Identifier: MIT
//
// Which accelerations and normal forces of the bow make a string speak at once? Each stroke of a plane (Guettler 2002) is
// simulated with travelling waves, its regime named and its transient counted; H: Helmholtz motion within 12 periods, h: later,
// 2: double or multiple slip, r: raucous, l: anomalous low frequency, dot: no oscillation. One design serves all strokes.
//
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include <rosin/friction/velocity_curve.hpp>
#include <rosin/simulate/profiled_rod.hpp>
#include <rosin/simulate/regime.hpp>
#include <rosin/simulate/wave_stroke.hpp>

namespace {

const rosin::modal_rig rig{
    .string = {.length_m = 0.33, .tension_N = 45, .fundamental_Hz = 196, .bending_stiffness_Nm2 = 1e-5, .loss = {.quality = 300}},
    .torsion = {.speed_ratio = 5.2, .impedance_ratio = 2.6, .quality = 30}};
const rosin::wave_settings settings{.sample_rate_Hz = 32000, .oversampling = 4, .band_Hz = 20e3};

char letter(const rosin::regime_finding& found) {
  constexpr std::array letters{'.', 'H', '2', 'l', 'r'};
  const bool late = found.regime == rosin::bowed_regime::helmholtz && found.transient_periods > 12;
  return late ? 'h' : letters[static_cast<std::size_t>(found.regime)];
}

char bow(const rosin::wave_design& design, double acceleration_m_s2, double normal_N) {
  const rosin::profiled_rod rod{{}, {{0, 0}, {0.3 / acceleration_m_s2, 0.3}}, {{0, normal_N}}};
  const auto take =
      rosin::simulate_wave_stroke(design, rig, rosin::velocity_curve{rosin::two_exponential_curve<>{}}, rod, 0.16, settings);
  if (!take) return '?';
  std::vector<double> slip(take->size());
  for (std::size_t n = 0; n < slip.size(); ++n)
    slip[n] = take->centre_velocity_m_s[n] + take->torsion_velocity_m_s[n] - take->rod_velocity_m_s[n];
  return letter(rosin::classify(slip, take->rod_velocity_m_s, take->sample_rate_Hz, rig.string.fundamental_Hz));
}

}  // namespace

int main() {
  const auto design = rosin::design_wave(rig, 0.1, settings);
  if (!design) {
    std::puts(design.error().c_str());
    return 1;
  }
  for (int row = 5; row >= 0; --row) {
    const double normal_N = 0.05 * std::pow(40.0, row / 5.0);
    std::printf("%5.2f N  ", normal_N);
    for (int column = 0; column < 11; ++column) std::printf(" %c", bow(*design, 0.3 * std::pow(60.0, column / 10.0), normal_N));
    std::puts("");
  }
  std::puts("          0.3 ... 18 m/s2");
}
