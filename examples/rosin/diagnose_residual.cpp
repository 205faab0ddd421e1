// SPDX-License-Identifier: MIT
//
// What the declared model and the corrected one leave of a fitted pluck, for the pictures of a report.
//
#include "diagnose_rig.hpp"

#include <rosin/diagnose/pluck_diagnosis.hpp>

namespace tool {

namespace {

constexpr double shown_periods = 40;

struct left_over {
  residual_series series;
  rosin::band limits;
};

left_over left_by(const rosin::scene_data& data, const rosin::scene_fit& fit, std::size_t take) {
  const double periods = std::min(shown_periods, fit.horizon_periods > 0 ? fit.horizon_periods : shown_periods);
  const auto problem = data.problem(fit.effects, fit.value, {1000, periods, true, rosin::freedom::all}, {1, 1});
  left_over out{{problem.part(take, 1).begin_s, {}}, problem.limits()};
  const auto residual = rosin::detail::residual_of(problem, fit.value, take);
  for (std::size_t c = 0; c < 2; ++c) out.series.force_N[c].assign(residual[c].begin(), residual[c].end());
  return out;
}

}  // namespace

std::optional<residual_picture> residuals_of(const rosin::pluck_diagnosis& p) {
  if (p.base.value.size() == 0 || p.best.value.size() == 0) return std::nullopt;
  const auto before = left_by(p.data, p.base, p.mismatch.take);
  residual_picture out;
  out.take = p.data.takes[p.mismatch.take].name, out.rate_Hz = p.data.takes[p.mismatch.take].rate_Hz;
  out.fundamental_Hz = p.base.value[rosin::pluck_layout::fundamental];
  out.limits = before.limits, out.before = before.series;
  out.after = p.best.effects.empty() ? before.series : left_by(p.data, p.best, p.mismatch.take).series;
  for (std::size_t c = 0; c < 2; ++c) {
    const double noise = p.best.quality.noise[c];
    out.noise_N_per_root_Hz[c] = noise / std::sqrt(0.5 * out.rate_Hz);
    out.noise_N[c] = noise * std::sqrt((before.limits.pass_Hz + before.limits.stop_Hz) / out.rate_Hz);
  }
  return out;
}

}  // namespace tool
