// tier: hosted
// SPDX-License-Identifier: MIT
//
// Two channels whose converters have clocks of their own: the far one, started with the near one, runs faster by a small part.
// What it recorded as sample i belongs to the instant i / (1 + drift); a windowed sinc reads the record there.
//
#pragma once

#include <rosin/condition/record_at.hpp>
#include <rosin/core/instantiate.hpp>
#include <rosin/diagnose/pluck_effect.hpp>

namespace rosin {

/// A record at the instants i (1 + stretch).
[[nodiscard]] inline std::vector<double> resampled(const std::vector<double>& x, double stretch) {
  return record_at(x, [&](std::size_t i) { return static_cast<double>(i) * (1 + stretch); });
}

/// The far channel's clock runs faster than the near one's by `relative`, each take begun together.
template <class Real = double>
pluck_effect clock_drift_effect(const string_facts&) {
  pluck_effect e{
      .name = "clock-drift", .parameters = {by_score_steps("relative", -1e-3, 1e-3, 1e-7)}, .starts = {{0}}, .strength = -3};
  e.undo = [](std::vector<pluck_take>& takes, const pluck_scene&, const pluck_layout&, const Eigen::VectorX<Real>&,
              double relative) {
    for (pluck_take& take : takes) take.force_N[1] = resampled(take.force_N[1], relative);
  };
  return e;
}
ROSIN_INSTANTIATE(pluck_effect clock_drift_effect(const string_facts&))

}  // namespace rosin
