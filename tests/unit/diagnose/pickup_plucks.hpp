// SPDX-License-Identifier: MIT
//
// Plucks of a string as one end hears them, by the modal simulator: no closed form of the diagnosis is in it. 16 bit, white
// noise.
//
#pragma once

#include <rosin/diagnose/pickup_ringing.hpp>
#include <rosin/simulate/burdened_take.hpp>
#include <rosin/simulate/converter.hpp>

namespace rosin_test {

struct heard_string {
  double fundamental_Hz = 220, length_m = 0.65, tension_N = 70;
  double inharmonicity = 0, quality = 900, internal_s = 0, detuning = 0, coupling = 0;
  rosin::string_burden burden{};
  int steps_per_sample = 4;
  double limit_Hz = 6000, rate_Hz = 48000, duration_s = 1.2, noise = 1e-3;  ///< noise: of the loudest sample

  [[nodiscard]] rosin::modal_rig rig(double sharp = 0) const {
    rosin::modal_rig r;
    const double pi = 3.14159265358979323846;
    r.string = {length_m,
                tension_N * std::pow(1 + sharp, 2),
                fundamental_Hz * (1 + sharp),
                inharmonicity * tension_N * std::pow(length_m / pi, 2),
                {quality, internal_s, 0}};
    return r;
  }
  [[nodiscard]] double impedance_Ns_m() const { return tension_N / (2 * length_m * fundamental_Hz); }
  [[nodiscard]] double mass_kg() const { return impedance_Ns_m() / (2 * fundamental_Hz); }

  [[nodiscard]] rosin::pickup_signal pluck(const std::string& name, double position, double force_N, std::uint64_t seed) const {
    const double step = 1 / (rate_Hz * steps_per_sample);
    const auto ring = [&](double sharp) {
      return rosin::step_pluck(rig(sharp), burden, {position, force_N, 0.01, 0}, duration_s, limit_Hz, step).end_N[0];
    };
    std::vector<double> all = ring(0);
    if (coupling != 0) {
      const std::vector<double> other = ring(detuning);
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = (all[i] + coupling * other[i]) / (1 + coupling);
    }
    rosin::pickup_signal out{name, "end", rate_Hz, {}, rosin::pickup_kind::force};
    double most = 0;
    for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(steps_per_sample))
      out.values.push_back(all[i]), most = std::max(most, std::abs(all[i]));
    rosin::gaussian_source normal{seed};
    for (double& x : out.values) x = std::round((x / most * 0.5 + 0.5 * noise * normal()) * 32768) / 32768 * most / 0.5;
    return out;
  }
};

}  // namespace rosin_test
