// SPDX-License-Identifier: MIT
//
// A string that is bowed on a measured bridge, running free. The table of admittance is completed, given modes that reflect as it
// does, and the travelling waves meet them at the near end. The body has one strong resonance, and the string is tuned across it:
// where both meet, a wolf sits, and the note beats. Printed for each pitch: its beating, by least and greatest size of the
// fundamental at the bridge.
//
#include <rosin/friction/velocity_curve.hpp>
#include <rosin/propagate/termination_modes.hpp>
#include <rosin/propagate/termination_table.hpp>
#include <rosin/simulate/profiled_rod.hpp>
#include <rosin/simulate/wave_stroke.hpp>

#include <iostream>

namespace {

constexpr double rate_Hz = 32000;
const rosin::wave_settings settings{.sample_rate_Hz = rate_Hz, .oversampling = 4, .band_Hz = 12e3};

rosin::modal_rig tuned_to(double pitch_Hz) {
  const double speed_m_s = 2 * 0.69 * pitch_Hz, density_kg_m = 8e-3;  // a cello's G string, stopped or not
  return {.string = {.length_m = 0.69,
                     .tension_N = density_kg_m * speed_m_s * speed_m_s,
                     .fundamental_Hz = pitch_Hz,
                     .bending_stiffness_Nm2 = 2e-4,
                     .loss = {.quality = 500}}};
}

/// As a hammer and a laser would write it down, m/s per N.
std::vector<rosin::measured_admittance> table() {
  const rosin::modal_termination per_newton{{{110, 25, 1 / 0.4}, {185, 40, 1 / 0.3}, {420, 30, 1 / 0.6}, {1100, 12, 1 / 0.3}}};
  std::vector<rosin::measured_admittance> out;
  for (double f = 0.5; f < 4e3; f += 0.5) out.push_back({f, per_newton.relative_admittance(f)});
  return out;
}

/// Least over greatest size of a frequency in windows of eight periods, in the last third.
double beating(const std::vector<double>& x, double frequency_Hz) {
  const auto size = static_cast<std::size_t>(8 * rate_Hz / frequency_Hz);
  double least = 1e300, most = 0;
  for (std::size_t begin = 2 * x.size() / 3; begin + size <= x.size(); begin += size / 2) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const double turn = 2 * std::numbers::pi * static_cast<double>(i);
      sum += x[begin + i] * (1 - std::cos(turn / static_cast<double>(size))) * std::polar(1.0, -turn * frequency_Hz / rate_Hz);
    }
    least = std::min(least, std::abs(sum)), most = std::max(most, std::abs(sum));
  }
  return least / most;
}

}  // namespace

int main() {
  const rosin::profiled_rod rod{{}, {{0, 0}, {0.1, 0.15}}, {{0, 0.8}}};
  const rosin::velocity_curve law{rosin::two_exponential_curve<>{}};
  std::cout << "pitch    on rigid ends   on the bridge\n";
  for (const double pitch_Hz : {156.0, 185.0, 220.0}) {
    const rosin::modal_rig rig = tuned_to(pitch_Hz);
    const auto bridge = rosin::complete_admittance(table(), rig.string.impedance_Ns_m());
    if (!bridge) return std::cerr << bridge.error() << '\n', 1;

    const auto like = rosin::as_modes(*bridge, {.from_Hz = 20, .to_Hz = 6e3});
    if (!like) return std::cerr << like.error() << '\n', 1;
    std::cout << pitch_Hz << " Hz  ";
    const rosin::modal_termination rigid;
    for (const auto& end : {rigid, like->end}) {
      const auto design = rosin::design_wave(rig, 0.1, settings, {end, rigid});
      if (!design) return std::cerr << design.error() << '\n', 1;
      const auto take = rosin::simulate_wave_stroke(*design, rig, law, rod, 0.8, settings);
      if (!take) return std::cerr << take.error() << '\n', 1;
      std::cout << "        " << std::round(100 * beating(take->force_near_N, pitch_Hz)) / 100;
    }
    std::cout << "     (" << like->end.modes.size() << " modes, off by " << like->mismatch << ")\n";
  }
}
