// tier: hosted
// SPDX-License-Identifier: MIT
//
// Two channels whose converters have clocks of their own: the far one, started with the near one, runs faster by a small part.
// What it recorded as sample i belongs to the instant i / (1 + drift); a windowed sinc reads the record there.
//
#pragma once

#include <rosin/condition/fractional_delay_design.hpp>
#include <rosin/diagnose/pluck_effect.hpp>

namespace rosin {

/// A record at the instants i (1 + stretch), by windowed sincs of 48 samples; what lies outside is taken to be like the nearest
/// sample. Good to 1e-5 up to 0.85 of half the sampling rate.
[[nodiscard]] inline std::vector<double> resampled(const std::vector<double>& x, double stretch) {
  constexpr int taps = 48, fractions = 512;
  using window = Eigen::Vector<double, taps>;
  static const std::vector<window> table = [] {  // an instant at `fraction` behind a sample, the oldest of its neighbours first
    std::vector<window> out(fractions + 1);
    const double beta = kaiser_beta(kaiser_attenuation_dB(taps, 0.85));
    std::array<double, taps> weights;
    for (std::size_t f = 0; f <= fractions; ++f) {
      kaiser_weights(1 - static_cast<double>(f) / fractions, beta, weights);
      out[f] = Eigen::Map<const window>(weights.data()).reverse();
    }
    return out;
  }();
  std::vector<double> out(x.size());
  const auto count = static_cast<std::ptrdiff_t>(x.size());
  window at_edge;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const double at = static_cast<double>(i) * (1 + stretch), whole = std::floor(at), fine = (at - whole) * fractions;
    const auto f = std::min<std::size_t>(fractions - 1, static_cast<std::size_t>(fine));
    const double mix = fine - static_cast<double>(f);
    const std::ptrdiff_t oldest = static_cast<std::ptrdiff_t>(whole) - taps / 2 + 1;
    const bool inside = oldest >= 0 && oldest + taps <= count;
    for (int j = 0; j < taps && !inside; ++j)
      at_edge[j] = x[static_cast<std::size_t>(std::clamp(oldest + j, std::ptrdiff_t{0}, count - 1))];
    const Eigen::Map<const window> seen(inside ? &x[static_cast<std::size_t>(oldest)] : at_edge.data());
    out[static_cast<std::size_t>(i)] = (1 - mix) * table[f].dot(seen) + mix * table[f + 1].dot(seen);
  }
  return out;
}

/// The far channel's clock runs faster than the near one's by `relative`, each take begun together.
inline pluck_effect clock_drift_effect(const string_facts&) {
  pluck_effect e{
      .name = "clock-drift", .parameters = {by_score_steps("relative", -1e-3, 1e-3, 1e-7)}, .starts = {{0}}, .strength = -3};
  e.undo = [](std::vector<pluck_take>& takes, const pluck_scene&, const pluck_layout&, const Eigen::VectorXd&, double relative) {
    for (pluck_take& take : takes) take.force_N[1] = resampled(take.force_N[1], relative);
  };
  return e;
}

}  // namespace rosin
