// SPDX-License-Identifier: MIT
//
// Slips made by hand, with no string behind them: speeds of many shapes and sizes, a force that a law gives.
//
#pragma once

#include <rosin/diagnose/friction_laws.hpp>

namespace rosin_test {

constexpr double slip_rate_Hz = 128e3;

/// A coefficient of friction by the speed alone.
struct curve_by_hand {
  double operator()(double speed_m_s, double /*normal_N*/) const { return 0.4 + 0.5 * std::exp(-speed_m_s / 0.15); }
};

inline void find_slips(rosin::slip_record& r) {
  r.phases = rosin::find_phases(r.relative_m_s, 0.2, {.least = 0.1});
  r.slips = rosin::slips_of(r.force_N, r.relative_m_s, r.phases, 0.2, r.normal_N, 0, 2);
}

/// A slip every 250 samples, faster and under more normal force by `strength`; `law` is asked for the coefficient of friction at
/// every sample in turn, at speed 0 while it sticks.
template <class Law>
[[nodiscard]] rosin::slip_record slips_by_hand(double strength, std::size_t samples, double mean_size, Law law) {
  rosin::slip_record r;
  r.rate_Hz = slip_rate_Hz, r.normal_N = 0.3 * strength;
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t at = i % 250, slip = i / 250;
    const double size = mean_size + 0.3 * std::sin(1.7 * static_cast<double>(slip)), u = static_cast<double>(at) / 100;
    const double v = at < 100 ? strength * size * std::sin(std::numbers::pi * u) * (1 + 0.4 * std::sin(11 * u)) + 0.05 : 0;
    const double mu = law(v, r.normal_N);
    r.force_N.push_back(r.normal_N * (v > 0 ? mu : 0.2));
    r.relative_m_s.push_back(-v);
  }
  find_slips(r);
  return r;
}

}  // namespace rosin_test
